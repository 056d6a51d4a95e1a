// tests/schema/variations.cpp
#include "tests/schema/variations.h"

#include <algorithm>
#include <set>

namespace cordis::test {

namespace {

using Json = Variations::Json;

/// Keys that say what a mapping is.
bool is_fixed_key(const std::string& key) {
  static const std::set<std::string> kFixed{"kind", "node", "part", "like", "parameters"};
  return kFixed.contains(key);
}

std::string variant_of_json(const Json& mapping) {
  for (const char* word : {"part", "node", "kind"}) {
    const auto found = mapping.find(word);
    if (found == mapping.end()) continue;
    return word == std::string("part") ? word : found->is_string() ? found->get<std::string>() : "";
  }
  return {};
}

/// The n-th of the keys that may change; empty where there are fewer.
std::string changing_key(const Json& mapping, std::size_t number) {
  for (const auto& [key, value] : mapping.items()) {
    if (!is_fixed_key(key) && number-- == 0) return key;
  }
  return {};
}

/// The n-th of the known keys that a mapping lacks; empty where there are fewer.
std::string missing_key(const Json& mapping, const VariantFacts& facts, std::size_t number) {
  for (const auto& [key, of_key] : facts.keys) {
    if (!is_fixed_key(key) && !mapping.contains(key) && number-- == 0) return key;
  }
  return {};
}

}  // namespace

void Variations::learn(const Json& document) {
  walk(document, {}, samples_);
}

void Variations::walk(const Json& value, const KeyPath& path, Samples& samples) const {
  if (value.is_array()) {
    for (const Json& item : value) walk(item, below(path, "[]"), samples);
  }
  if (!value.is_object()) return;
  const KeyPath described = canonical(path);
  const bool is_read = facts_.has(described);
  for (const auto& [key, inner] : value.items()) {
    if (is_read) samples.try_emplace({described, key}, inner);
    if (key != "parameters") walk(inner, below(path, is_read ? key : "*"), samples);
  }
}

bool Variations::change(Json& value, const KeyPath& path, const Change& change_one) const {
  bool changed = false;
  if (value.is_array()) {
    for (Json& item : value) changed = change(item, below(path, "[]"), change_one) || changed;
  }
  if (!value.is_object()) return changed;
  const KeyPath described = canonical(path);
  const bool is_read = facts_.has(described);
  for (auto& [key, inner] : value.items()) {
    if (key == "parameters" || key == "include") continue;
    changed = change(inner, below(path, is_read ? key : "*"), change_one) || changed;
  }
  if (!is_read) return changed;
  const auto& variants = facts_.paths().at(described);
  auto variant = variants.find(variant_of_json(value));
  if (variant == variants.end()) variant = variants.find("");
  if (variant == variants.end()) return changed;
  return change_one(value, described, variant->second) || changed;
}

std::vector<Variations::Change> Variations::changes(std::size_t number, const Samples& own) const {
  std::vector<Change> all;
  all.emplace_back([number](Json& mapping, const KeyPath& /*path*/, const VariantFacts& /*facts*/) {
    const std::string key = changing_key(mapping, number);
    return !key.empty() && mapping.erase(key) > 0;
  });
  all.emplace_back(
      [this, number, &own](Json& mapping, const KeyPath& path, const VariantFacts& facts) {
        const std::string key = missing_key(mapping, facts, number);
        if (key.empty()) return false;
        auto sample = own.find({path, key});
        if (sample == own.end()) sample = samples_.find({path, key});
        if (sample != samples_.end()) mapping[key] = sample->second;
        return true;
      });
  for (const Json& form : {Json("1 + 1"), Json(1)}) {
    all.emplace_back(
        [number, form](Json& mapping, const KeyPath& /*path*/, const VariantFacts& /*facts*/) {
          const std::string key = changing_key(mapping, number);
          if (!key.empty()) mapping[key] = form;
          return !key.empty();
        });
  }
  return all;
}

void Variations::of(
    const Json& document,
    const std::function<void(const std::string& text, const std::string& section)>& take) const {
  Samples own;
  walk(document, {}, own);
  for (const auto& [section, unchanged] : document.items()) {
    bool changed = true;
    for (std::size_t number = 0; changed; ++number) {
      changed = false;
      for (const Change& change_one : changes(number, own)) {
        Json varied = document;
        if (!change(varied[section], {section}, change_one)) continue;
        changed = true;
        take(varied.dump(), section);
      }
    }
  }
}

}  // namespace cordis::test
