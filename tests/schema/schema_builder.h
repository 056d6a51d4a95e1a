// tests/schema/schema_builder.h -- a JSON Schema (draft 7) of what the readers were seen to ask.
#pragma once

#include <functional>
#include <set>
#include <string>

#include <nlohmann/json.hpp>

#include "tests/schema/key_facts.h"

namespace cordis::test {

using Json = nlohmann::ordered_json;

/// What the facts do not say of a sort of files.
struct SchemaNotes {
  std::string title;
  /// The meaning of a key; empty when no document says it, which makes the key a finding of
  /// without_meaning().
  std::function<std::string(const KeyPath& path, const std::string& variant,
                            const std::string& key)>
      meaning;
};

/// Builds the schema of one sort of files.
class SchemaBuilder {
 public:
  SchemaBuilder(const FileFacts& facts, SchemaNotes notes)
      : facts_(facts), notes_(std::move(notes)) {}

  /// The whole schema.
  Json schema();
  /// The properties of a path and a variant, for the schema of another file.
  Json properties(const KeyPath& path, const std::string& variant);
  /// "path: key" of all keys without a meaning.
  const std::set<std::string>& without_meaning() const { return without_meaning_; }

 private:
  Json object(const KeyPath& path);
  Json object_or_reference(const KeyPath& path);
  Json variant_object(const KeyPath& path, const std::string& variant, const VariantFacts& facts);
  Json with_variants(const KeyPath& path, const std::map<std::string, VariantFacts>& variants);
  Json value(const KeyPath& path, const std::string& key, const KeyFacts& facts);
  bool is_left_out(const KeyPath& path, const std::string& variant, const std::string& key) const;

  const FileFacts& facts_;
  SchemaNotes notes_;
  std::set<std::string> without_meaning_;
};

}  // namespace cordis::test
