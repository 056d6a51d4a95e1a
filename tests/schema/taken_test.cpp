// tests/schema/taken_test.cpp -- what a reader takes, the schema takes: scenes by chance, scenes of
// the tests, vectors of every dimension, and every word. A validator (validator_test.py) reads the
// cases that these tests write.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "node/config/yaml_reader.h"
#include "tests/random_scenes/random_scene.h"
#include "tests/schema/cases.h"
#include "tests/schema/corpus.h"
#include "tests/schema/document_json.h"
#include "tests/schema/variations.h"
#include "tests/support/rounds.h"
#include "tests/support/test_seed.h"

namespace cordis::test {
namespace {

using Json = nlohmann::ordered_json;
using config::KeyKind;
using config::Value;

constexpr const char* kUnknownWord = "qqqqqqqq";
constexpr std::size_t kMaxTries = 30;

/// Where something stands in a document: names of keys and numbers of items.
using Pointer = std::vector<Json>;

/// A mapping of a document whose keys are known.
struct Spot {
  const Json* document = nullptr;
  const std::string* sort = nullptr;
  const std::string* name = nullptr;
  Pointer pointer;
};

/// The mappings of some documents, by what they are.
using Spots = std::map<std::pair<KeyPath, std::string>, std::vector<Spot>>;

Pointer inside(Pointer pointer, Json step) {
  pointer.push_back(std::move(step));
  return pointer;
}

std::string kind_of(const Json& mapping) {
  for (const char* word : {"part", "node", "kind"}) {
    const auto found = mapping.find(word);
    if (found == mapping.end()) continue;
    return word == std::string("part") ? word : found->is_string() ? found->get<std::string>() : "";
  }
  return {};
}

void collect(const FileFacts& facts, const Json& value, const KeyPath& path, const Spot& spot,
             Spots& spots) {
  if (value.is_array()) {
    for (std::size_t i = 0; i < value.size(); ++i) {
      Spot inner = spot;
      inner.pointer = inside(spot.pointer, i);
      collect(facts, value[i], below(path, "[]"), inner, spots);
    }
  }
  if (!value.is_object()) return;
  const KeyPath described = canonical(path);
  const bool is_read = facts.has(described);
  if (is_read) {
    const auto& variants = facts.paths().at(described);
    const std::string kind = variants.contains(kind_of(value)) ? kind_of(value) : "";
    if (variants.contains(kind)) spots[{described, kind}].push_back(spot);
  }
  for (const auto& [key, inner] : value.items()) {
    if (key == "parameters") continue;
    Spot deeper = spot;
    deeper.pointer = inside(spot.pointer, key);
    collect(facts, inner, below(path, is_read ? key : "*"), deeper, spots);
  }
}

Json& at(Json& document, const Pointer& pointer) {
  Json* found = &document;
  for (const Json& step : pointer)
    found =
        step.is_string() ? &(*found)[step.get<std::string>()] : &(*found)[step.get<std::size_t>()];
  return *found;
}

Value value_at(Value value, const Pointer& pointer) {
  for (const Json& step : pointer)
    value = step.is_string() ? value.find(step.get<std::string>())
                             : value.items().at(step.get<std::size_t>());
  return value;
}

bool is_at(const Value& value, const config::Place& place) {
  const auto same = [&](const config::Place& other) {
    return other.line == place.line && other.column == place.column;
  };
  return same(value.place()) ||
         std::ranges::any_of(value.items(), [&](const Value& item) { return is_at(item, place); });
}

/// True if a reader finds something wrong with the value at a place of a document.
bool refuses(const Spot& spot, const Json& document, const Pointer& pointer) {
  const std::string text = document.dump();
  config::Problems problems;
  read({*spot.sort, *spot.name, text}, problems);
  config::Problems of_text;
  const Value value = value_at(config::load_text(text, *spot.name, of_text), pointer);
  return std::ranges::any_of(problems.all(), [&](const config::Problem& problem) {
    return problem.severity == config::Problem::Severity::kError && is_at(value, problem.place);
  });
}

/// The document without the sections and entries beside a place: enough for a schema.
Json around(const Json& document, const Pointer& pointer) {
  Json little = document;
  for (const auto& [section, value] : document.items()) {
    const bool is_other = value.is_structured() && section != pointer[0].get<std::string>();
    if (is_other) little[section] = value.is_array() ? Json::array() : Json::object();
    if (is_other && (section == "step" || section == "accuracy")) little.erase(section);
  }
  Json& section = little[pointer[0].get<std::string>()];
  if (pointer.size() < 3 || !pointer[1].is_string() || !section.is_object()) return little;
  const Json entry = section[pointer[1].get<std::string>()];
  section = Json::object();
  section[pointer[1].get<std::string>()] = entry;
  return little;
}

class Values : public testing::Test {
 protected:
  /// Documents of a sort, and what they show.
  void load(const std::string& sort) {
    sort_ = sort;
    facts_ = facts_of(sort);
    documents_.clear();
    spots_.clear();
    std::vector<Document> all = cover_documents();
    for (Document& document : shipped_documents()) all.push_back(std::move(document));
    for (const Document& document : all) {
      if (document.sort == sort && !document.is_part)
        documents_.emplace_back(document.name, json_of_text(document.text));
    }
    for (const auto& [name, document] : documents_)
      collect(facts_, document, {}, {&document, &sort_, &name, {}}, spots_);
  }

  /// Adds a case for the validator: the value at a place is right, or wrong.
  void add_case(const Spot& spot, const Json& document, const Pointer& pointer, bool taken) {
    cases_.push_back({{"sort", sort_},
                      {"name", *spot.name},
                      {"path", pointer},
                      {"taken", taken},
                      {"document", around(document, pointer)}});
  }

  /// The mappings of a path, of all kinds.
  std::vector<Spot> spots_of(const KeyPath& path) const {
    std::vector<Spot> all;
    for (const auto& [what, spots] : spots_) {
      if (what.first == path) all.insert(all.end(), spots.begin(), spots.end());
    }
    return all;
  }

  /// Expects that a mapping takes each of some words, and none takes another. @return how many
  std::size_t try_words(const std::vector<Spot>& spots, const std::string& key,
                        std::vector<std::string> left) {
    const std::size_t count = left.size();
    bool has_wrong = false;
    for (const Spot& spot : spots) {
      if (left.empty()) break;
      const Pointer pointer = inside(spot.pointer, key);
      Json changed = *spot.document;
      at(changed, spot.pointer)[key] = kUnknownWord;
      if (!refuses(spot, changed, pointer)) continue;  // it is not read: something else is wrong
      if (!has_wrong) add_case(spot, changed, pointer, false);
      has_wrong = true;
      std::erase_if(left, [&](const std::string& word) {
        at(changed, spot.pointer)[key] = word;
        if (refuses(spot, changed, pointer)) return false;
        add_case(spot, changed, pointer, true);
        return true;
      });
    }
    EXPECT_TRUE(has_wrong) << sort_ << " " << *spots.front().name << Json(spots.front().pointer)
                           << ": any word will do for " << key;
    for (const std::string& word : left)
      ADD_FAILURE() << sort_ << " " << *spots.front().name << Json(spots.front().pointer)
                    << ": no reader takes " << key << ": " << word;
    return count - left.size();
  }

  std::string sort_;
  FileFacts facts_;
  std::vector<std::pair<std::string, Json>> documents_;
  Spots spots_;
  Json cases_ = Json::array();
};

/// Vectors in the forms of a scene of `space` dimensions.
std::vector<Json> forms_of(int space) {
  const auto each = [space](const Json& value) {
    return Json(std::vector<Json>(static_cast<std::size_t>(space), value));
  };
  Json corner = each(0.1);
  corner[0] = 0.3;
  std::vector<Json> forms{0.1,
                          each(0),
                          each(0.1),
                          each("0.1 + 0.1"),
                          Json::array({each(0), each(0.1)}),
                          Json::array({each(0), each(0.1), corner})};
  if (space == 1) forms.insert(forms.end(), {0, "0.1 + 0.1", Json::array({0, 0.1})});
  return forms;
}

TEST_F(Values, ThatAreVectorsHaveEachFormThatTheReaderTakes) {
  load("scene");
  std::size_t keys = 0;
  for (const auto& [what, spots] : spots_) {
    for (const auto& [key, of_key] : facts_.paths().at(what.first).at(what.second).keys) {
      const auto is_vector = [](KeyKind kind) {
        return kind == KeyKind::kVector || kind == KeyKind::kVectors ||
               kind == KeyKind::kFormulaVector || kind == KeyKind::kFormulaVectors;
      };
      if (std::ranges::none_of(of_key.kinds, is_vector)) continue;
      ++keys;
      std::set<int> shown;  // spaces of which a scene was tried
      bool taken = false;
      for (const Spot& spot : spots) {
        const int space = spot.document->at("space").get<int>();
        if (shown.contains(space)) continue;
        const Pointer pointer = inside(spot.pointer, key);
        Json changed = *spot.document;
        at(changed, spot.pointer)[key] = Json::object({{kUnknownWord, 0}});
        if (!refuses(spot, changed, pointer)) continue;  // it is not read: something else is wrong
        shown.insert(space);
        for (const Json& form : forms_of(space)) {
          at(changed, spot.pointer)[key] = form;
          if (refuses(spot, changed, pointer)) continue;
          taken = true;
          add_case(spot, changed, pointer, true);
        }
      }
      EXPECT_TRUE(taken) << what.second << ": the reader takes no vector for " << key;
    }
  }
  EXPECT_GT(keys, 60u);
  write_cases("vectors", cases_);
}

/// True if no word of a key can be tried by itself.
bool is_no_choice(const std::string& sort, const KeyPath& path, const std::string& key) {
  const bool is_name = key == "to" || key == "start";
  // The tests read a launch file with each clock in turn; a recorder needs no `node`.
  const bool is_given = sort == "launch" && (path.empty() || path[0] == "record");
  return is_name || is_given;
}

TEST_F(Values, ThatAreWordsAreThoseOfTheReader) {
  std::size_t words = 0;
  for (const std::string sort : {"scene", "launch", "device"}) {
    load(sort);
    std::set<KeyPath> with_kinds;
    for (const auto& [what, spots] : spots_) {
      const auto& [path, variant] = what;
      for (const auto& [key, of_key] : facts_.paths().at(path).at(variant).keys) {
        if (of_key.choices.empty() || is_no_choice(sort, path, key)) continue;
        const bool is_kind = key == "kind" || key == "node";
        if (is_kind && !with_kinds.insert(path).second) continue;
        const std::vector<Spot> all = is_kind ? spots_of(path) : spots;
        words += try_words(all, key, of_key.choices);
      }
    }
  }
  EXPECT_GT(words, 150u);
  write_cases("words", cases_);
}

TEST_F(Values, ThatASignalOrALinkNeedsAreMissed) {
  load("scene");
  const auto miss = [&](const KeyPath& path, const std::vector<std::string>& keys) {
    std::vector<Spot> some = spots_.at({path, ""});
    some.resize(std::min<std::size_t>(some.size(), kMaxTries));
    for (const Spot& spot : some) {
      Json changed = *spot.document;
      for (const std::string& key : keys) at(changed, spot.pointer).erase(key);
      EXPECT_TRUE(refuses(spot, changed, spot.pointer)) << *spot.name << Json(spot.pointer);
      add_case(spot, changed, spot.pointer, false);
    }
  };
  miss({"signals", "*"}, {"quantity"});
  miss({"links", "[]"}, {"between", "within", "between_sets", "along"});
  EXPECT_GT(cases_.size(), kMaxTries);
  write_cases("missing", cases_);
}

/// Adds a scene that its reader takes. @return whether it does
bool add_if_taken(const std::string& text, const std::string& name, Json& cases) {
  config::Problems problems;
  read({"scene", CORDIS_SOURCE_DIR "/launch_configs/scenes/" + name, text}, problems);
  if (problems.has_errors()) return false;
  cases.push_back({{"sort", "scene"},
                   {"name", name},
                   {"part", false},
                   {"refused", ""},
                   {"document", json_of_text(text)}});
  return true;
}

TEST(Schema, TakesScenesByChanceThatTheReaderTakes) {
  const auto count = static_cast<std::uint32_t>(rounds(300));
  Json cases = Json::array();
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t seed = test_seed() + i;
    add_if_taken(random_scene_text(seed), "random scene " + std::to_string(seed), cases);
  }
  EXPECT_GT(cases.size(), count / 2);
  write_cases("random", cases);
}

TEST(Schema, TakesVariationsOfScenesThatTheReaderTakes) {
  const FileFacts facts = facts_of("scene");
  Variations variations(facts);
  constexpr std::uint32_t kScenes = 4;
  const auto seed_of = [](std::uint32_t i) { return test_seed() + 100000 + i; };
  for (std::uint32_t i = 0; i < kScenes; ++i)
    variations.learn(json_of_text(random_scene_text(seed_of(i))));
  Json cases = Json::array();
  for (std::uint32_t i = 0; i < kScenes; ++i) {
    const std::string name = "variation of scene " + std::to_string(seed_of(i));
    const auto take = [&](const std::string& text, const std::string& /*section*/) {
      add_if_taken(text, name, cases);
    };
    variations.of(json_of_text(random_scene_text(seed_of(i))), take);
  }
  EXPECT_GT(cases.size(), kScenes);
  write_cases("variations", cases);
}

TEST(Schema, TakesScenesOfTheTestsThatTheReaderTakes) {
  Json cases = Json::array();
  const std::regex raw("R\"(\\w*)\\((cordis: 1\n[^]*?)\\)\\1\"");
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(CORDIS_SOURCE_DIR "/tests")) {
    if (entry.path().extension() != ".cpp") continue;
    std::ifstream file(entry.path());
    const std::string text(std::istreambuf_iterator<char>(file), {});
    for (std::sregex_iterator scene(text.begin(), text.end(), raw), end; scene != end; ++scene)
      add_if_taken((*scene)[2], entry.path().filename().string(), cases);
  }
  EXPECT_GT(cases.size(), 40u);
  write_cases("tests", cases);
}

}  // namespace
}  // namespace cordis::test
