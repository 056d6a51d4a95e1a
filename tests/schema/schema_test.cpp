// tests/schema/schema_test.cpp -- the schemas of scenes, launch files and device files are what the
// readers take.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <random>
#include <regex>
#include <sstream>
#include <string>
#include <tuple>

#include <gtest/gtest.h>

#include "node/config/yaml_reader.h"
#include "tests/schema/cases.h"
#include "tests/schema/corpus.h"
#include "tests/schema/document_json.h"
#include "tests/schema/schemas.h"
#include "tests/support/rounds.h"
#include "tests/support/test_seed.h"

namespace cordis::test {
namespace {

using config::Value;

constexpr const char* kFolder = CORDIS_SOURCE_DIR "/launch_configs/schemas/";
constexpr const char* kUnknown = "qqqqqqqq";
const std::vector<std::string> kSorts{"scene", "launch", "device"};

std::string line_of(const std::string& text, std::size_t line) {
  std::istringstream lines(text);
  std::string found;
  for (std::size_t i = 0; i < line; ++i) std::getline(lines, found);
  return found;
}

/// A text with something put, or put in the place of `length` bytes, at a place.
std::string with_text_at(const std::string& text, const config::Place& place, std::size_t length,
                         const std::string& words) {
  std::size_t start = 0;
  for (int line = 1; line < place.line; ++line) start = text.find('\n', start) + 1;
  std::string changed = text;
  changed.replace(start + static_cast<std::size_t>(place.column) - 1, length, words);
  return changed;
}

/// A text with one more key in a mapping.
std::string with_key(const std::string& text, const Value& mapping, const std::string& entry) {
  const config::Place& place = mapping.place();
  const std::string line = line_of(text, static_cast<std::size_t>(place.line));
  const std::size_t column = static_cast<std::size_t>(place.column) - 1;
  if (line[column] == '{') {
    config::Place inside = place;
    ++inside.column;
    return with_text_at(text, inside, 0, entry + (mapping.entries().empty() ? "" : ", "));
  }
  return with_text_at(text, place, 0, entry + "\n" + std::string(column, ' '));
}

/// A mapping of a document whose keys a reader knows.
struct ReadMapping {
  const Document* document = nullptr;
  KeyPath path;
  std::string variant;
  Value value;
};

void collect(const Document& document, const FileFacts& facts, const Value& value,
             const KeyPath& path, std::vector<ReadMapping>& found) {
  for (const Value& item : value.items()) {
    collect(document, facts, item, below(path, "[]"), found);
  }
  if (value.kind() != Value::Kind::kMapping) return;
  const KeyPath described = canonical(path);
  const bool is_read = facts.has(described);
  if (is_read) {
    const auto& variants = facts.paths().at(described);
    const std::string variant = variants.contains(variant_of(value)) ? variant_of(value) : "";
    if (variants.contains(variant)) found.push_back({&document, described, variant, value});
  }
  for (const Value::Entry& entry : value.entries())
    collect(document, facts, entry.value, below(path, is_read ? entry.key : "*"), found);
}

std::vector<ReadMapping> mappings_of(const Document& document, const FileFacts& facts) {
  config::Problems problems;
  std::vector<ReadMapping> found;
  const Value root = config::load_text(document.text, document.name, problems);
  EXPECT_FALSE(problems.has_errors()) << problems.text();
  collect(document, facts, root, {}, found);
  return found;
}

bool says_unknown(const config::Problems& problems, const std::string& key) {
  return std::ranges::any_of(problems.all(), [&](const config::Problem& problem) {
    return problem.message.starts_with("unknown key '" + key + "'");
  });
}

config::Problems problems_of(const Document& document, const std::string& text) {
  Document changed = document;
  changed.text = text;
  config::Problems problems;
  read(changed, problems);
  return problems;
}

/// One word with a slip of the hand.
std::string misspelt(std::string word, std::mt19937& random) {
  const std::size_t place = random() % word.size();
  const char letter = static_cast<char>('a' + random() % 26);
  switch (random() % 3) {
    case 0:
      word.insert(place, 1, letter);
      break;
    case 1:
      word[place] = letter;
      break;
    default:
      if (word.size() > 2) word.erase(place, 1);
  }
  return word;
}

/// Keys beside those that are known have a meaning: they are parameters of a liaison.
bool takes_other_keys(const ReadMapping& mapping) {
  return mapping.value.find("liaison").exists();
}

TEST(Schema, IsWhatTheReadersAsk) {
  for (const std::string& sort : kSorts) {
    const BuiltSchema built = build_schema(sort);
    const std::string file = kFolder + sort + ".schema.json";
    const std::string expected = built.schema.dump(1) + "\n";
    if (std::getenv("CORDIS_WRITE_SCHEMAS") != nullptr) std::ofstream(file) << expected;

    std::ifstream stream(file);
    const std::string written(std::istreambuf_iterator<char>(stream), {});
    EXPECT_TRUE(written == expected)
        << file << " is not what the readers ask: write it again with\n"
        << "  CORDIS_WRITE_SCHEMAS=1 build/release/bin/schema_test --gtest_filter=Schema.Is*";
    for (const std::string& key : built.without_meaning)
      ADD_FAILURE() << sort << ": no table of "
                    << (sort == "scene" ? "docs/scene_keys.md" : "docs/launch.md")
                    << " says what a key means, " << key;
  }
}

TEST(Schema, HasNoMeaningOfAKeyThatNoReaderTakes) {
  const FileFacts facts = facts_of("scene");
  std::set<std::string> rows;
  std::ifstream document(CORDIS_SOURCE_DIR "/docs/scene_keys.md");
  std::string heading;
  for (std::string line; std::getline(document, line);) {
    std::smatch found;
    if (std::regex_match(line, found, std::regex("## `?([^`]*)`?"))) heading = found[1];
    if (!std::regex_search(line, found, std::regex("^\\| `(\\w+)` \\|"))) continue;
    KeyPath path;
    std::istringstream names(heading == "Scene" ? "" : heading);
    for (std::string name; std::getline(names, name, '.');)
      path.push_back(name == "NAME" ? "*" : name == "ITEM" ? "[]" : name);
    ASSERT_TRUE(facts.has(path)) << heading;
    const auto& variants = facts.paths().at(path);
    EXPECT_TRUE(std::ranges::any_of(
        variants, [&](const auto& variant) { return variant.second.keys.contains(found[1]); }))
        << heading << ": " << found[1];
  }
}

TEST(Schema, KnowsEveryKindThatAReaderKnows) {
  for (const std::string& sort : kSorts) {
    const FileFacts facts = facts_of(sort);
    for (const auto& [path, variants] : facts.paths()) {
      for (const auto& [name, variant] : variants) {
        for (const char* word : {"kind", "node"}) {
          const auto kind = variant.keys.find(word);
          if (kind == variant.keys.end()) continue;
          for (const std::string& choice : kind->second.choices) {
            if (path == KeyPath{"record"}) continue;
            EXPECT_TRUE(variants.contains(choice))
                << sort << ": no document of the test shows the kind " << choice;
          }
        }
      }
    }
  }
}

TEST(Schema, HasEveryKeyThatTheCodeOfScenesNames) {
  const std::string schema = build_schema("scene").schema.dump();
  std::size_t names = 0;
  const std::filesystem::path folder = CORDIS_SOURCE_DIR "/sim_node/scene";
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.path().extension() != ".cpp") continue;
    std::ifstream file(entry.path());
    const std::string text(std::istreambuf_iterator<char>(file), {});
    const std::regex asks("(?:optional|required)_\\w+\\(\\s*(?:\\w+, )?\"(\\w+)\"");
    for (std::sregex_iterator key(text.begin(), text.end(), asks), end; key != end; ++key, ++names)
      EXPECT_NE(schema.find('"' + (*key)[1].str() + "\":"), std::string::npos)
          << entry.path() << ": no document of the test shows the key " << (*key)[1];
  }
  EXPECT_GT(names, 90u);
}

/// Documents that show the keys of a sort, those that show most first.
std::vector<Document> documents_of(const std::string& sort) {
  std::vector<Document> all = cover_documents();
  for (Document& document : shipped_documents()) all.push_back(std::move(document));
  std::erase_if(
      all, [&](const Document& document) { return document.sort != sort || document.is_part; });
  return all;
}

/// True if a key may be a value that a link gives to a parameter: the file decides about it.
bool is_parameter(const FileFacts& facts, const VariantFacts& variant, const std::string& key) {
  return variant.keys.contains("liaison") && facts.parameter_names().contains(key);
}

TEST(Schema, HasOnlyKeysThatAReaderTakes) {
  for (const std::string& sort : kSorts) {
    const FileFacts facts = facts_of(sort);
    std::set<std::tuple<KeyPath, std::string, std::string>> left;
    for (const auto& [path, variants] : facts.paths()) {
      for (const auto& [variant, of_variant] : variants) {
        for (const auto& [key, of_key] : of_variant.keys) {
          if (!is_parameter(facts, of_variant, key)) left.insert({path, variant, key});
        }
      }
    }
    for (const Document& document : documents_of(sort)) {
      for (const ReadMapping& mapping : mappings_of(document, facts)) {
        for (const auto& [key, of_key] : facts.paths().at(mapping.path).at(mapping.variant).keys) {
          if (!left.contains({mapping.path, mapping.variant, key})) continue;
          const bool present = mapping.value.find(key).exists();
          const std::string text =
              present ? document.text : with_key(document.text, mapping.value, key + ": 0");
          if (!says_unknown(problems_of(document, text), key))
            left.erase({mapping.path, mapping.variant, key});
        }
      }
    }
    for (const auto& [path, variant, key] : left)
      ADD_FAILURE() << sort << ": no reader takes " << key << " of " << variant;
  }
}

TEST(Schema, RefusesWhatTheReadersRefuseAndTakesWhatShips) {
  // Documents for a validator (validator_test.py): {sort, name, document, part, refused key or ""}.
  Json cases = Json::array();
  for (const Document& document : shipped_documents()) {
    cases.push_back({{"sort", document.sort},
                     {"name", document.name},
                     {"part", document.is_part},
                     {"refused", ""},
                     {"document", json_of_text(document.text)}});
  }
  std::mt19937 random(test_seed());
  std::cout << "seed " << test_seed() << "\n";
  const auto refuse = [&](const Document& document, const std::string& text,
                          const std::string& key) {
    const config::Problems problems = problems_of(document, text);
    EXPECT_TRUE(problems.has_errors()) << document.name << ": " << key << "\n" << text;
    cases.push_back({{"sort", document.sort},
                     {"name", document.name + " with " + key},
                     {"part", document.is_part},
                     {"refused", key},
                     {"document", json_of_text(text)}});
    return problems;
  };
  for (const std::string& sort : kSorts) {
    const FileFacts facts = facts_of(sort);
    std::set<std::pair<KeyPath, std::string>> seen;
    for (const Document& document : documents_of(sort)) {
      for (const ReadMapping& mapping : mappings_of(document, facts)) {
        if (takes_other_keys(mapping)) continue;
        if (seen.insert({mapping.path, mapping.variant}).second) {
          const std::string text =
              with_key(document.text, mapping.value, std::string(kUnknown) + ": 0");
          EXPECT_TRUE(says_unknown(refuse(document, text, kUnknown), kUnknown))
              << document.name << ", line " << mapping.value.place().line;
        }
        const auto& entries = mapping.value.entries();
        if (entries.empty() || random() % 8 >= static_cast<unsigned>(rounds(8))) continue;
        const Value::Entry& entry = entries[random() % entries.size()];
        const std::string slip = misspelt(entry.key, random);
        const auto& variants = facts.paths().at(mapping.path);
        const bool known = std::ranges::any_of(
            variants, [&](const auto& variant) { return variant.second.keys.contains(slip); });
        if (known || mapping.value.find(slip).exists()) continue;
        refuse(document, with_text_at(document.text, entry.key_place, entry.key.size(), slip),
               slip);
      }
    }
  }
  EXPECT_GT(cases.size(), 300u);
  write_cases("keys", cases);
}

}  // namespace
}  // namespace cordis::test
