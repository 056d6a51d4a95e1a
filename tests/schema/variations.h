// tests/schema/variations.h -- files with one thing changed in each mapping, so that their readers
// show more of what they take.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "tests/schema/key_facts.h"

namespace cordis::test {

/// Variations of files: each key left out, each key that is missing added, each value in another form.
class Variations {
 public:
  using Json = nlohmann::ordered_json;

  explicit Variations(const FileFacts& facts) : facts_(facts) {}

  /// Remembers the values of a file for the keys that are added to others.
  void learn(const Json& document);

  /// Calls `take` with each variation of a document as a text. The mappings of one section at a time
  /// change, so that what they refer to stays.
  void of(
      const Json& document,
      const std::function<void(const std::string& text, const std::string& section)>& take) const;

 private:
  using Samples = std::map<std::pair<KeyPath, std::string>, Json>;
  using Change = std::function<bool(Json& mapping, const KeyPath& path, const VariantFacts& facts)>;

  void walk(const Json& value, const KeyPath& path, Samples& samples) const;
  bool change(Json& value, const KeyPath& path, const Change& change_one) const;
  std::vector<Change> changes(std::size_t number, const Samples& own) const;

  const FileFacts& facts_;
  Samples samples_;
};

}  // namespace cordis::test
