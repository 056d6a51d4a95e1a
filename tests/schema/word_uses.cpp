// tests/schema/word_uses.cpp
#include "tests/schema/word_uses.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <map>
#include <regex>
#include <sstream>
#include <stdexcept>

#include "node/config/yaml_reader.h"
#include "sim_node/scene/language/expression.h"
#include "sim_node/scene/language/quantity.h"
#include "sim_node/scene/sections/quantity_words.h"
#include "tests/schema/corpus.h"
#include "tests/schema/key_facts.h"
#include "tests/schema/key_tables.h"

namespace cordis::test {

namespace {

using config::Value;

constexpr const char* kFarFromAll = "qqqqqqqqqq";
const std::filesystem::path kConfigs = CORDIS_SOURCE_DIR "/launch_configs";

const FileFacts& facts_once(const std::string& sort) {
  static std::map<std::string, FileFacts> facts;
  const auto found = facts.find(sort);
  return found != facts.end() ? found->second : facts.emplace(sort, facts_of(sort)).first->second;
}

/// "matter.NAME.driven".
std::string heading_of(const KeyPath& path) {
  std::string heading;
  for (const std::string& name : path) {
    heading += heading.empty() ? "" : ".";
    heading += name == "*" ? "NAME" : name == "[]" ? "ITEM" : name;
  }
  return heading;
}

std::string key_word(const std::string& sort, const KeyPath& path, const std::string& key) {
  return sort + " " + (path.empty() ? "" : heading_of(path) + ".") + key;
}

/// Names that files give to states: no words of the language.
bool is_name_of_a_state(const std::string& key) {
  return key == "to" || key == "start";
}

/// A link gives values to parameters of its liaison by the names of their file.
bool is_parameter_alone(const FileFacts& facts, const KeyPath& path, const VariantFacts& variant,
                        const std::string& key) {
  static const KeyTables kTables(CORDIS_SOURCE_DIR "/docs/scene_keys.md");
  return variant.keys.contains("liaison") && facts.parameter_names().contains(key) &&
         kTables.meaning(heading_of(path), key).empty();
}

/// The section of a device_node takes the keys of a device file: they count as those.
bool is_of_a_device(const std::string& sort, const KeyPath& path, const std::string& key) {
  if (sort != "launch" || path.empty() || path[0] != "nodes") return false;
  return path.size() > 2 || facts_once("device").paths().at({}).at("").keys.contains(key);
}

void add_keys(const std::string& sort, std::set<std::string>& words) {
  const FileFacts& facts = facts_once(sort);
  for (const auto& [path, variants] : facts.paths()) {
    for (const auto& [name, variant] : variants) {
      for (const auto& [key, of_key] : variant.keys) {
        if (is_of_a_device(sort, path, key) || is_parameter_alone(facts, path, variant, key))
          continue;
        const std::string word = key_word(sort, path, key);
        words.insert(word);
        if (is_name_of_a_state(key)) continue;
        for (const std::string& choice : of_key.choices) {
          if (!of_key.fallbacks.contains(choice)) words.insert(word + ": " + choice);
        }
      }
    }
  }
}

/// The functions of the language, as a message lists them.
std::set<std::string> function_words() {
  config::Problems problems;
  const Value unknown = Value::scalar(std::string(kFarFromAll) + "(1)", {});
  static_cast<void>(scene::parse_expression(unknown, "a test", problems));
  const std::string& hint = problems.all().front().hint;
  const std::string beginning = "functions: ";
  if (!hint.starts_with(beginning)) throw std::runtime_error("no list of functions: " + hint);
  std::set<std::string> words;
  std::istringstream list(hint.substr(beginning.size()));
  for (std::string word; std::getline(list >> std::ws, word, ',');) words.insert(word);
  return words;
}

void add_expression_words(std::set<std::string>& words) {
  for (const std::string& function : function_words()) words.insert("expression " + function);
  for (const scene::QuantityName& quantity : scene::kQuantityNames)
    words.insert("expression " + std::string(quantity.word));
  words.insert("expression " + std::string(scene::kNormalForceWord));
  words.insert("expression " + std::string(scene::kTimeWord));
}

/// Every word of a file, by its keys and the texts that stand as values.
class Uses {
 public:
  explicit Uses(std::set<std::string>& words) : words_(words) {}

  void add(const std::string& sort, const Value& value, const KeyPath& path) {
    for (const Value& item : value.items()) add(sort, item, below(path, "[]"));
    if (sort == "scene") add_tokens(value.text());
    const KeyPath described = canonical(path);
    const bool is_read = facts_once(sort).has(described);
    for (const Value::Entry& entry : value.entries()) {
      if (is_read) add_entry(sort, described, entry);
      add(sort, entry.value, below(path, is_read ? entry.key : "*"));
    }
    const bool is_device = sort == "launch" && value.find("node").text() == "device_node";
    if (is_device) add("device", value, {});
  }

 private:
  void add_entry(const std::string& sort, const KeyPath& path, const Value::Entry& entry) {
    const std::string word = key_word(sort, path, entry.key);
    words_.insert(word);
    const std::string& text = entry.value.text();
    if (!text.empty()) words_.insert(word + ": " + text);
    if (word == "scene signals.NAME.quantity") words_.insert("signal " + text);
  }

  void add_tokens(const std::string& text) {
    static const std::regex kToken("[A-Za-z_][A-Za-z_0-9]*");
    for (std::sregex_iterator token(text.begin(), text.end(), kToken), end; token != end; ++token)
      words_.insert("expression " + token->str());
  }

  std::set<std::string>& words_;
};

std::string sort_of(const std::filesystem::path& file) {
  const std::filesystem::path folder = file.parent_path();
  if (folder == kConfigs) return "launch";
  return folder.filename() == "devices" ? "device" : "scene";
}

}  // namespace

std::set<std::string> known_words() {
  std::set<std::string> words;
  for (const char* sort : {"scene", "launch", "device"}) add_keys(sort, words);
  for (const scene::QuantityWord& quantity : scene::quantity_words())
    words.insert("signal " + std::string(quantity.word));
  add_expression_words(words);
  return words;
}

std::set<std::string> used_words() {
  std::set<std::string> seen;
  Uses uses(seen);
  for (const auto& entry : std::filesystem::recursive_directory_iterator(kConfigs)) {
    if (entry.path().extension() != ".yaml") continue;
    config::Problems problems;
    uses.add(sort_of(entry.path()), config::load_file(entry.path(), problems), {});
  }
  std::set<std::string> used;
  std::ranges::set_intersection(seen, known_words(), std::inserter(used, used.end()));
  return used;
}

}  // namespace cordis::test
