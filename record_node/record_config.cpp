// record_node/record_config.cpp
#include "record_node/record_config.h"

#include <algorithm>
#include <chrono>
#include <fstream>
#include <stdexcept>

#include <unistd.h>

#include "idl/control.h"
#include "node/config/mapping_reader.h"
#include "node/config/regular_file.h"
#include "node/time.h"
#include "record_node/idl/idl_parser.h"

namespace cordis::record {
namespace {

constexpr const char* kUnnamedSeed = "1";  // of packs and of the noise of simulated devices
constexpr std::size_t kMaxIdl = std::size_t{4} << 20;

/// A text, or a sequence of texts.
std::vector<std::string> read_words(config::MappingReader& reader, const std::string& key) {
  std::vector<std::string> words;
  const config::Value value = reader.optional_value(key);
  if (!value.exists()) return words;
  if (value.kind() == config::Value::Kind::kScalar) return {value.text()};
  for (const config::Value& item : value.items()) words.push_back(item.text());
  const bool has_other = std::find(words.begin(), words.end(), std::string()) != words.end();
  if (words.empty() || has_other)
    reader.error_at(key, key + " must be a word or a list of words, got " + value.described());
  return words;
}

std::vector<std::string> own_words() {
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  std::vector<std::string> words;
  for (std::string word; std::getline(file, word, '\0');) words.push_back(word);
  return words;
}

/// The words of this process, with blanks between them.
std::string own_command_line() {
  std::string line;
  for (const std::string& word : own_words()) line += (line.empty() ? "" : " ") + word;
  return line;
}

}  // namespace

RecordSection read_record_section(const config::LaunchNode& node, config::Problems& problems) {
  RecordSection section;
  config::MappingReader reader(node.section, "record_node '" + node.name + "'", problems);
  section.out = reader.optional_text("out", section.out);
  const std::string fault = fault_of_pattern(section.out);
  if (!fault.empty()) reader.error_at("out", fault);
  section.topics = read_words(reader, "topics");
  section.excluded = read_words(reader, "exclude");
  section.idl_files = read_words(reader, "idl");
  const std::string packed = reader.optional_choice("compression", "zstd", {"zstd", "lz4", "none"});
  section.compression = mcap::compression_named(packed).value_or(section.compression);
  reader.finish();
  return section;
}

std::map<std::string, std::string> read_idl_files(const std::vector<std::string>& files,
                                                  const std::filesystem::path& base) {
  std::map<std::string, std::string> texts;
  for (const std::string& file : files) {
    const std::string path = (base / file).string();
    const config::FileBytes read = config::read_regular_file(path, kMaxIdl);
    if (!read.reason.empty()) throw std::runtime_error("cannot read " + path + ": " + read.reason);
    parse_idl(read.bytes, path);
    texts[path] = read.bytes;
  }
  return texts;
}

std::vector<std::string> own_overrides() {
  const std::vector<std::string> words = own_words();
  std::vector<std::string> overrides;
  for (std::size_t i = 2; i < words.size(); ++i) {  // the program and the launch file stand first
    if (words[i].find('=') != std::string::npos && words[i][0] != '-')
      overrides.push_back(words[i]);
  }
  return overrides;
}

std::map<std::string, std::string> about_session(const config::Launch& launch,
                                                 const std::vector<AttachedFile>& files) {
  char host[256] = "";
  gethostname(host, sizeof host - 1);
  const auto utc = std::chrono::duration_cast<std::chrono::nanoseconds>(
      std::chrono::system_clock::now().time_since_epoch());
  std::map<std::string, std::string> about{
      {"session", launch.session},
      {"launch_file", launch.file},
      {"clock", config::clock_word(launch.clock)},
      {"host", host},
      {"cordis_version", CORDIS_VERSION},
      {"wire_version", std::to_string(msg::WIRE_VERSION)},
      {"command_line", own_command_line()},
      {"utc_minus_monotonic_nsec", std::to_string(utc.count() - node::monotonic_nsec())},
      {"seed", kUnnamedSeed}};
  for (const auto& [key, seed] : seeds_of(launch, files)) about["seed " + key] = seed;
  return about;
}

}  // namespace cordis::record
