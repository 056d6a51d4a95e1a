// tests/docs/launch_document_test.cpp -- docs/launch.md lists exactly the keys that the readers of
// launch files and device files accept.
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "device_node/device_config.h"
#include "node/config/launch.h"
#include "node/config/yaml_reader.h"
#include "record_node/record_config.h"
#include "sim_node/sim_config.h"
#include "tests/support/filled.h"
#include "viz_node/viz_config.h"

namespace cordis {
namespace {

using Keys = std::set<std::string>;
using Tables = std::map<std::string, Keys>;  // the keys under each heading, or of each mapping

constexpr const char* kUnknown = "qqqqqqqq";  // like no key, so that the hint lists all known ones

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The keys of the tables in docs/launch.md by the heading above them.
Tables documented() {
  Tables tables;
  std::istringstream lines(text_of(CORDIS_SOURCE_DIR "/docs/launch.md"));
  std::string heading;
  for (std::string line; std::getline(lines, line);) {
    std::smatch found;
    if (std::regex_match(line, found, std::regex("#+ (.*)"))) {
      heading = std::regex_replace(found[1].str(), std::regex("`"), "");
    } else if (std::regex_search(line, found,
                                 std::regex("^\\| `([^`]+)` \\| [^|]+ \\| [^|]+ \\| "))) {
      EXPECT_TRUE(tables[heading].insert(found[1]).second) << heading << ": " << found[1];
    }
  }
  return tables;
}

/// The known keys that the problems about `kUnknown` list, by what the mapping is.
void collect(const config::Problems& problems, Tables& tables) {
  const std::regex about("unknown key 'q+' in (.*)");
  for (const config::Problem& problem : problems.all()) {
    std::smatch found;
    if (!std::regex_match(problem.message, found, about)) continue;
    const std::string prefix = "known keys: ";
    ASSERT_TRUE(problem.hint.starts_with(prefix)) << problem.text();
    std::istringstream words(problem.hint.substr(prefix.size()));
    for (std::string word; words >> word;) tables[found[1]].insert(word.substr(0, word.find(',')));
  }
}

/// What the readers accept in a device file, with `words` in its `mock.hand`.
void collect_device(const std::string& hand, Tables& tables) {
  const std::string wire = "port: /dev/null, coupling: {q: 1}, q: 1";
  std::string text =
      R"(axes: 4
q: 1
end_piece: {map: [[1, 0, 0, 0]], q: 1}
passivity: {q: 1}
trace: {file: /tmp/trace.csv, q: 1}
mock: {q: 1, key: {q: 1}, sensor: {q: 1}, hand: {q: 1, axes: [0, 1, 2, 3], finger: {q: 1}, )" +
      hand +
      R"(}}
script: {q: 1, positions: [{at_s: 0, m: 0, q: 1}]}
replay: {take: none.mcap, q: 1}
pointer: {q: 1}
kfb1: {)" +
      wire + "}\nfirefader: {" + wire + "}\nhaply: {" + wire + "}\n";
  text = std::regex_replace(text, std::regex("\\bq: 1"), kUnknown + std::string(": 1"));
  config::Problems problems;
  try {
    device::read_device(config::load_text(text, "device", problems), "key", problems);
    FAIL() << "an unknown key was accepted";
  } catch (const config::ConfigError&) {
    collect(problems, tables);
  }
}

/// What the readers accept in a launch file and in the section of each node.
Tables accepted() {
  Tables tables;
  const std::string unknown = kUnknown + std::string(": 1");
  config::Problems problems;
  const config::Launch launch = config::load_launch_text(test::filled(R"(cordis: 1
domain: 1
network: {peers: [h], <unknown>}
<unknown>
nodes:
  sim: {node: sim_node, scene: none, <unknown>}
  view: {node: viz_node, <unknown>}
  record: {node: record_node, <unknown>}
)",
                                                                      {{"unknown", unknown}}),
                                                         "launch", {}, problems);
  sim::read_sim_config(launch, launch.nodes.at(0), problems);
  viz::read_viz_config(launch.nodes.at(1), problems);
  record::read_record_section(launch.nodes.at(2), problems);
  collect(problems, tables);
  const std::vector<std::string>& of_launcher = config::launcher_keys();
  tables["every node"] = {of_launcher.begin(), of_launcher.end()};

  collect_device("moves: [{at_s: 0, in_s: 1, to_m: 0, q: 1}]", tables);
  for (const char* kind : {"hold", "reach_and_press", "pluck", "bow", "grasp_and_drag", "knead"}) {
    Tables of_kind;
    collect_device("gesture: {kind: " + std::string(kind) + ", q: 1}", of_kind);
    tables[kind] = of_kind["gesture"];
    tables["hand"].merge(of_kind["hand"]);
  }
  Tables of_forces;
  config::Problems of_script;
  const config::Value device = config::load_text(
      "axes: 1\nscript: {forces: [{at_s: 0, n: 0, " + unknown + "}]}\n", "device", of_script);
  EXPECT_THROW(device::read_device(device, "key", of_script), config::ConfigError);
  collect(of_script, of_forces);
  tables["force"] = of_forces["point"];
  return tables;
}

Keys together(std::initializer_list<Keys> all) {
  Keys keys;
  for (const Keys& some : all) keys.insert(some.begin(), some.end());
  return keys;
}

/// Headings of the document, and what the readers call the same mapping.
const std::map<std::string, std::string>& headings() {
  static const std::map<std::string, std::string> kHeadings{
      {"Session", "launch file"},
      {"network", "network"},
      {"Every node", "every node"},
      {"sim_node", "node 'sim'"},
      {"viz_node", "viz_node 'view'"},
      {"record_node", "record_node 'record'"},
      {"end_piece", "end_piece"},
      {"passivity", "passivity"},
      {"trace", "trace"},
      {"mock", "mock"},
      {"mock.key", "key"},
      {"mock.hand", "hand"},
      {"mock.hand.finger", "finger"},
      {"mock.hand.moves", "move"},
      {"mock.sensor", "sensor"},
      {"script", "script"},
      {"script.positions", "point"},
      {"script.forces", "force"},
      {"replay", "replay"},
      {"kfb1", "kfb1"},
      {"firefader", "firefader"},
      {"haply", "haply"},
      {"coupling", "coupling"},
      {"pointer", "pointer"},
  };
  return kHeadings;
}

}  // namespace

TEST(LaunchDocument, ListsTheKeysOfEveryMapping) {
  Tables written = documented();
  Tables read = accepted();

  for (const auto& [heading, mapping] : headings()) {
    EXPECT_EQ(written[heading], read[mapping]) << "docs/launch.md, heading " << heading;
    written.erase(heading);
    read.erase(mapping);
  }
  // `device` names the file, and is no key of it.
  EXPECT_EQ(together({written["device_node"], written["Device file"]}),
            together({read["device 'key'"], {"device"}}));
  for (const char* kind : {"hold", "reach_and_press", "pluck", "bow", "grasp_and_drag", "knead"}) {
    const std::string heading = "Kind " + std::string(kind);
    const Keys common = std::string(kind) == "hold" ? Keys{} : written["Every kind but hold"];
    EXPECT_EQ(together({written["mock.hand.gesture"], common, written[heading]}), read[kind])
        << kind;
    written.erase(heading);
    read.erase(kind);
  }
  for (const char* heading :
       {"device_node", "Device file", "mock.hand.gesture", "Every kind but hold"})
    written.erase(heading);
  for (const char* mapping : {"device 'key'", "gesture"}) read.erase(mapping);
  EXPECT_EQ(written, Tables{}) << "tables that belong to no mapping";
  EXPECT_EQ(read, Tables{}) << "mappings without a table in docs/launch.md";
}

TEST(LaunchDocument, ListsKeysThatAreReadOnlyWhenTheyArePresent) {
  Keys all;
  for (const auto& [heading, keys] : documented()) all.insert(keys.begin(), keys.end());
  const std::filesystem::path root = CORDIS_SOURCE_DIR;
  std::size_t files = 0;
  for (const char* folder : {"device_node", "node/config", "record_node", "viz_node", "sim_node"}) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root / folder)) {
      const std::string path = entry.path().string();
      const bool reads_scenes = path.find("/scene/") != std::string::npos;
      const bool reads_states =
          path.ends_with("/start_state.cpp");  // `cordis simulate` writes them
      if (entry.path().extension() != ".cpp" || reads_scenes || reads_states) continue;
      ++files;
      const std::string text = text_of(entry.path());
      const std::regex asks("\\.(?:has|optional_\\w+|required_\\w+)\\(\\s*\"(\\w+)\"");
      for (std::sregex_iterator key(text.begin(), text.end(), asks), end; key != end; ++key)
        EXPECT_TRUE(all.contains((*key)[1])) << path << ": " << (*key)[1];
    }
  }
  EXPECT_GT(files, 40u);
}

}  // namespace cordis
