// node/config/launch.cpp
#include "node/config/launch.h"

#include <algorithm>
#include <map>
#include <utility>

#include "node/config/file_kind.h"
#include "node/config/mapping_reader.h"
#include "node/config/name_hash.h"
#include "node/config/nearest_word.h"
#include "node/config/regular_file.h"
#include "node/config/yaml_reader.h"

namespace cordis::config {

namespace {

constexpr std::size_t kLongestName = 64;
constexpr const char* kRecordKey = "record";
constexpr const char* kNetworkKey = "network";
constexpr const char* kSecurityKey = "security";

const std::vector<std::string>& programs() {
  static const std::vector<std::string> kPrograms{"sim_node", "device_node", "viz_node",
                                                  "record_node"};
  return kPrograms;
}

bool is_name(const std::string& name) {
  const auto fits = [](char c) {
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-';
  };
  return !name.empty() && name.size() <= kLongestName &&
         std::all_of(name.begin(), name.end(), fits);
}

std::vector<std::string> split_at_dots(const std::string& text) {
  std::vector<std::string> parts;
  for (std::size_t start = 0; start <= text.size();) {
    const std::size_t end = std::min(text.find('.', start), text.size());
    parts.push_back(text.substr(start, end - start));
    start = end + 1;
  }
  return parts;
}

/// Where in the launch file a word of the command line belongs; empty after a problem.
std::vector<std::string> path_of_override(const Value& root, const std::string& target,
                                          const Place& place, Problems& problems) {
  std::vector<std::string> path = split_at_dots(target);
  const std::string& first = path.front();
  if (std::find(path.begin(), path.end(), std::string{}) != path.end()) {
    problems.error(place, "expected name.key=value, got '" + target + "=...'");
    return {};
  }
  const std::vector<std::string> of_session{"clock", "domain", "session", kSecurityKey};
  if (path.size() == 1 && std::ranges::find(of_session, first) != of_session.end()) return path;

  std::vector<std::string> names;
  for (const Value::Entry& node : root.find("nodes").entries()) names.push_back(node.key);
  const bool is_node = std::find(names.begin(), names.end(), first) != names.end();
  if ((first == kRecordKey || first == kNetworkKey) && !is_node) return path;
  if (std::find(names.begin(), names.end(), first) == names.end()) {
    if (path.size() == 1) names.insert(names.end(), of_session.begin(), of_session.end());
    if (path.size() > 1) names.insert(names.end(), {kNetworkKey, kRecordKey});
    problems.error(place, "no node is named '" + first + "'", did_you_mean(first, names));
    return {};
  }
  if (path.size() == 1) {
    problems.error(place, "expected a key of node '" + first + "'",
                   "write " + first + ".key=value");
    return {};
  }
  path.insert(path.begin(), "nodes");
  return path;
}

Value with_overrides(Value root, const std::vector<std::string>& overrides, Problems& problems) {
  for (const std::string& word : overrides) {
    const Place place{"'" + word + "' on the command line", 0, 0};
    const std::size_t equals = word.find('=');
    if (equals == std::string::npos) {
      problems.error(place, "expected name.key=value");
      continue;
    }
    const std::vector<std::string> path =
        path_of_override(root, word.substr(0, equals), place, problems);
    const Value value = load_word(word.substr(equals + 1), place.file, problems);
    if (!path.empty() && value.exists()) root = with_value_at(root, path, value);
  }
  return root;
}

std::string read_session(MappingReader& reader, const std::filesystem::path& path) {
  const std::string session = reader.optional_text("session", path.stem().string());
  if (!is_name(session)) {
    reader.error_at(
        "session",
        "the name of a session is 1 to 64 letters, digits, '_' and '-', got '" + session + "'",
        reader.has("session") ? "" : "without 'session:' it is the name of the file");
  }
  return session;
}

Clock read_clock(MappingReader& reader) {
  const std::string clock =
      reader.optional_choice("clock", "realtime", {"realtime", "lockstep", "asap"});
  if (clock == clock_word(Clock::kLockstep)) return Clock::kLockstep;
  return clock == clock_word(Clock::kAsap) ? Clock::kAsap : Clock::kRealtime;
}

bool is_of_launcher(const std::string& key) {
  const std::vector<std::string>& keys = launcher_keys();
  return std::find(keys.begin(), keys.end(), key) != keys.end();
}

LaunchNode read_node(const Value::Entry& entry, Clock clock, Problems& problems) {
  LaunchNode node;
  node.name = entry.key;
  node.place = entry.key_place;
  MappingReader reader(entry.value, "node '" + entry.key + "'", problems);
  if (!is_name(node.name)) {
    problems.error(node.place, "the name of a node is 1 to 64 letters, digits, '_' and '-', got '" +
                                   node.name + "'");
  }
  const bool sound = reader.ok();
  node.program = reader.required_choice("node", programs());
  if (!reader.ok()) node.program.clear();
  // What it does changes no result.
  const bool only_shows = node.program == "viz_node" || node.program == "record_node";
  node.required = reader.optional_truth("required", !only_shows);
  node.respawn = reader.optional_truth("respawn", only_shows || clock == Clock::kRealtime);
  node.belongs = !reader.has("clock") || read_clock(reader) == clock;

  std::vector<Value::Entry> rest;
  for (const Value::Entry& key : entry.value.entries()) {
    if (!is_of_launcher(key.key)) rest.push_back(key);
  }
  if (sound) node.section = Value::mapping(std::move(rest), entry.value.place());
  return node;
}

/// `record:` at the top of a file: a record_node named `record`, as its mapping or the name of its
/// file alone.
Value::Entry recorder_entry(const Value& record) {
  std::vector<Value::Entry> keys;
  keys.push_back({"node", record.place(), Value::scalar("record_node", record.place())});
  if (record.kind() == Value::Kind::kScalar) keys.push_back({"out", record.place(), record});
  for (const Value::Entry& key : record.entries()) keys.push_back(key);
  return {kRecordKey, record.place(), Value::mapping(std::move(keys), record.place())};
}

/// What only shows when all nodes are seen together.
void check_nodes(const std::vector<LaunchNode>& nodes, Problems& problems) {
  const LaunchNode* sim = nullptr;
  std::map<std::uint32_t, const LaunchNode*> by_hash;
  for (const LaunchNode& node : nodes) {
    if (node.program == "sim_node" && sim != nullptr) {
      problems.error(node.place,
                     "a session has one sim_node, and '" + sim->name + "' is one already",
                     "'" + sim->name + "' is at line " + std::to_string(sim->place.line));
    }
    if (node.program == "sim_node" && sim == nullptr) sim = &node;
    const auto [other, is_new] = by_hash.emplace(name_hash(node.name), &node);
    if (!is_new) {
      problems.error(node.place,
                     "'" + node.name + "' and '" + other->second->name + "' have the same hash",
                     "rename one of them");
    }
  }
}

Launch read_launch(Value root, const std::string& path, const std::vector<std::string>& overrides,
                   Problems& problems) {
  Launch launch;
  launch.file = path;
  launch.directory = std::filesystem::path(path).parent_path();
  if (!root.exists() || !is_file_of(FileKind::kLaunch, root, problems)) return launch;

  if (root.kind() == Value::Kind::kMapping) root = with_overrides(root, overrides, problems);
  MappingReader reader(root, "launch file", problems);
  reader.required_integer("cordis", 1, 1);
  launch.session = read_session(reader, path);
  if (reader.has("domain"))
    launch.domain = static_cast<int>(reader.optional_integer("domain", 0, 0, kHighestDomain));
  static_cast<void>(reader.optional_value(kNetworkKey));  // known, for the hint of a slip
  if (reader.has(kNetworkKey)) {
    const Value network = reader.required_mapping(kNetworkKey);
    if (network.exists()) launch.network = read_network(network, problems);
  }
  launch.security = reader.optional_text(kSecurityKey, "");
  if (reader.has(kSecurityKey) && reader.ok() && launch.security.empty())
    reader.error_at(kSecurityKey, "security must name a folder of keys",
                    "`cordis keys new FOLDER` makes one");
  if (!launch.security.empty() && launch.network && launch.network->server)
    reader.error_at(kSecurityKey, "a secured session has no discovery server",
                    "name the hosts with 'peers', or set 'multicast: true'");
  launch.clock = read_clock(reader);
  const Value nodes = reader.required_mapping("nodes");
  for (const Value::Entry& entry : nodes.entries()) {
    LaunchNode node = read_node(entry, launch.clock, problems);
    if (node.belongs) launch.nodes.push_back(std::move(node));
  }
  if (nodes.exists() && nodes.entries().empty())
    reader.error_at("nodes", "a launch file needs at least one node");
  if (reader.has(kRecordKey)) {
    const Value record = reader.optional_value(kRecordKey);
    if (record.kind() == Value::Kind::kSequence) {
      reader.error_at(kRecordKey, "record must be the name of a file or a mapping, got a sequence",
                      "record: {out: takes/{session}-{time}.mcap}");
    } else if (nodes.find(kRecordKey).exists()) {
      reader.error_at(kRecordKey, "'record' is a node of this file already",
                      "say what it records there");
    } else {
      launch.nodes.push_back(read_node(recorder_entry(record), launch.clock, problems));
    }
  }
  check_nodes(launch.nodes, problems);
  reader.finish();
  return launch;
}

}  // namespace

const char* clock_word(Clock clock) noexcept {
  switch (clock) {
    case Clock::kRealtime:
      return "realtime";
    case Clock::kLockstep:
      return "lockstep";
    case Clock::kAsap:
      return "asap";
  }
  return "";
}

const std::vector<std::string>& launcher_keys() {
  static const std::vector<std::string> kKeys{"node", "required", "respawn", "clock"};
  return kKeys;
}

bool Launch::has_standbys() const noexcept {
  return std::any_of(nodes.begin(), nodes.end(), [](const LaunchNode& node) {
    return node.section.find("standby_for").exists();
  });
}

const LaunchNode* Launch::find(const std::string& name) const noexcept {
  const auto found = std::find_if(nodes.begin(), nodes.end(),
                                  [&](const LaunchNode& node) { return node.name == name; });
  return found == nodes.end() ? nullptr : &*found;
}

std::filesystem::path Launch::resolve(const std::string& path) const {
  return directory / path;
}

std::filesystem::path Launch::real_folder() const {
  std::error_code failure;
  return std::filesystem::canonical(directory.empty() ? "." : directory, failure);
}

std::filesystem::path Launch::find_below(const std::string& path) const {
  const std::filesystem::path folder = real_folder();
  return path_below(folder, folder / path);
}

void check_domain(const Launch& launch, Problems& problems) {
  if (launch.network && !launch.domain)
    problems.error(launch.network->place,
                   "a session on several hosts needs 'domain', the same one on each", "domain: 7");
}

Launch load_launch(const std::string& path, const std::vector<std::string>& overrides,
                   Problems& problems) {
  return read_launch(load_file(path, problems), path, overrides, problems);
}

Launch load_launch_text(const std::string& text, const std::string& name,
                        const std::vector<std::string>& overrides, Problems& problems) {
  return read_launch(load_text(text, name, problems), name, overrides, problems);
}

}  // namespace cordis::config
