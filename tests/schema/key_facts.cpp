// tests/schema/key_facts.cpp
#include "tests/schema/key_facts.h"

#include <algorithm>
#include <functional>
#include <tuple>

namespace cordis::test {

using config::KeyKind;
using config::KeyRequest;
using config::Value;

namespace {

using PlaceKey = std::tuple<std::string, int, int>;

PlaceKey key_of(const config::Place& place) {
  return {place.file, place.line, place.column};
}

bool is_map_of_names(const KeyPath& path) {
  return path == KeyPath{"liaisons"} || path == KeyPath{"parts"};
}

}  // namespace

KeyPath below(KeyPath path, const std::string& name) {
  path.push_back(name);
  return path;
}

void KeyFacts::add(const KeyRequest& request) {
  const bool first = kinds.empty() || kinds == std::set{KeyKind::kAny};
  kinds.insert(request.kind);
  if (request.kind == KeyKind::kAny) return;
  if (first || request.range.lowest < lowest) {
    lowest = request.range.lowest;
    lowest_excluded = request.range.lowest_excluded;
  } else if (request.range.lowest == lowest) {
    lowest_excluded = lowest_excluded && request.range.lowest_excluded;
  }
  highest = first ? request.range.highest : std::max(highest, request.range.highest);
  min_length = first ? request.length : std::min(min_length, request.length);
  max_length = first ? request.length : std::max(max_length, request.length);
  for (const std::string& choice : request.choices) {
    if (std::ranges::find(choices, choice) == choices.end()) choices.push_back(choice);
  }
  fallbacks.insert(request.fallback);
  if (!request.alternatives.empty()) alternatives = request.alternatives;
}

struct FileFacts::Reading {
  std::map<PlaceKey, Requests> requests;  // by the place of their mapping
  bool is_variation = false;
  std::set<PlaceKey> errors;

  Reading(const Value& root, const config::KeyLog& log) {
    for (const KeyRequest& request : log.requests()) {
      if (request.mapping.file == root.place().file)
        requests[key_of(request.mapping)].push_back(&request);
    }
  }
};

namespace {

using RequestsByKey = std::map<std::string, std::vector<const KeyRequest*>>;

/// The requests of a mapping by their key. Where one says all of a key, the others are left out.
RequestsByKey by_key(const std::vector<const KeyRequest*>& requests) {
  RequestsByKey all;
  for (const KeyRequest* request : requests) all[request->key].push_back(request);
  for (auto& [key, of_key] : all) {
    const auto is_whole = [](const KeyRequest* request) { return request->is_whole; };
    if (std::ranges::any_of(of_key, is_whole)) std::erase_if(of_key, std::not_fn(is_whole));
  }
  return all;
}

/// True if a reader took the value of a key without a request for its kind.
bool is_of_any_kind(const Value& mapping, const std::string& key,
                    const std::vector<const KeyRequest*>& requests) {
  return mapping.find(key).exists() && std::ranges::all_of(requests, [](const KeyRequest* request) {
           return request->kind == KeyKind::kAny;
         });
}

bool has_error(const Value& value, const std::set<PlaceKey>& errors) {
  if (errors.contains(key_of(value.place()))) return true;
  const auto inside = [&](const Value& item) { return has_error(item, errors); };
  return std::ranges::any_of(value.items(), inside) ||
         std::ranges::any_of(value.entries(), [&](const Value::Entry& entry) {
           return errors.contains(key_of(entry.key_place)) || inside(entry.value);
         });
}

/// A mapping that is read in several places as it is in one.
struct SameMapping {
  KeyPath found;
  KeyPath described;
};

const std::vector<SameMapping>& same_mappings() {
  static const std::vector<SameMapping> kSame{
      {{"parts", "*", "matter"}, {"matter"}},
      {{"parts", "*", "links"}, {"links"}},
      {{"parts", "*", "ports"}, {"ports"}},
      {{"matter", "*", "driven", "displacement_m"}, {"matter", "*", "driven", "position_m"}},
      {{"matter", "*", "driven", "force_n"}, {"matter", "*", "driven", "position_m"}},
      {{"matter", "*", "core", "ball"}, {"matter", "*", "ball"}},
      {{"matter", "*", "repeat", "rotate"}, {"matter", "*", "rotate"}},
      {{"liaisons", "*", "parallel", "[]"}, {"liaisons", "*"}},
      {{"liaisons", "*", "states", "*", "elasticity"}, {"liaisons", "*", "elasticity"}},
      {{"liaisons", "*", "states", "*", "dissipation"}, {"liaisons", "*", "dissipation"}},
      {{"pointer", "key"}, {"mock", "key"}},
      {{"pointer", "hand"}, {"mock", "hand"}},
      {{"pointer", "sensor"}, {"mock", "sensor"}},
  };
  return kSame;
}

}  // namespace

KeyPath canonical(const KeyPath& path) {
  for (const auto& [found, described] : same_mappings()) {
    if (path.size() < found.size() || !std::equal(found.begin(), found.end(), path.begin()))
      continue;
    KeyPath same = described;
    same.insert(same.end(), path.begin() + static_cast<std::ptrdiff_t>(found.size()), path.end());
    return canonical(same);
  }
  return path;
}

std::string variant_of(const Value& mapping) {
  if (mapping.find("part").exists()) return "part";
  const Value node = mapping.find("node");
  return node.exists() ? node.text() : mapping.find("kind").text();
}

void FileFacts::add(const Value& root, const config::KeyLog& log) {
  walk(root, {}, Reading(root, log));
  add_parameter_names(root);
}

void FileFacts::add_variation(const Value& root, const std::string& section,
                              const config::KeyLog& log, const config::Problems& problems) {
  Reading reading(root, log);
  reading.is_variation = true;
  for (const config::Problem& problem : problems.all()) {
    if (problem.severity == config::Problem::Severity::kError)
      reading.errors.insert(key_of(problem.place));
  }
  walk(root.find(section), {section}, reading);
}

void FileFacts::add_parameter_names(const Value& root) {
  for (const Value& item : root.items()) add_parameter_names(item);
  for (const Value::Entry& entry : root.entries()) {
    if (entry.key == "parameters") {
      for (const Value::Entry& parameter : entry.value.entries())
        parameter_names_.insert(parameter.key);
    }
    add_parameter_names(entry.value);
  }
}

void FileFacts::walk(const Value& value, const KeyPath& path, const Reading& reading) {
  if (value.kind() == Value::Kind::kSequence) {
    for (const Value& item : value.items()) {
      if (item.kind() == Value::Kind::kScalar && !reading.is_variation)
        words_.insert(below(path, "[]"));
      walk(item, below(path, "[]"), reading);
    }
    return;
  }
  if (value.kind() != Value::Kind::kMapping) return;
  const auto asked = reading.requests.find(key_of(value.place()));
  const bool is_read = asked != reading.requests.end() && !is_map_of_names(path);
  if (is_read && !reading.is_variation) {
    add_mapping(value, canonical(path), asked->second);
  } else if (is_read && !has_error(value, reading.errors)) {
    relax_mapping(value, canonical(path), asked->second);
  }
  for (const Value::Entry& entry : value.entries()) {
    if (is_map_of_names(path) && entry.key == "include") continue;
    if (entry.key == "parameters") continue;  // names of the file, with values of any kind
    walk(entry.value, below(path, is_read ? entry.key : "*"), reading);
  }
}

void FileFacts::add_mapping(const Value& value, const KeyPath& path, const Requests& requests) {
  const RequestsByKey asked = by_key(requests);
  const bool has_variants =
      asked.contains("kind") || asked.contains("node") || asked.contains("part");
  VariantFacts& variant = paths_[path][has_variants ? variant_of(value) : ""];
  ++variant.mapping_count;
  for (const auto& [key, of_key] : asked) {
    KeyFacts& facts = variant.keys[key];
    ++facts.mapping_count;
    facts.required = facts.required && of_key.front()->required;
    for (const KeyRequest* request : of_key) facts.add(*request);
    facts.of_any_kind = facts.of_any_kind || is_of_any_kind(value, key, of_key);
  }
}

void FileFacts::relax_mapping(const Value& value, const KeyPath& path, const Requests& requests) {
  const RequestsByKey asked = by_key(requests);
  const bool is_whole = std::ranges::all_of(
      value.entries(), [&](const Value::Entry& entry) { return asked.contains(entry.key); });
  const auto variants = paths_.find(path);
  if (!is_whole || variants == paths_.end()) return;
  const bool has_variants =
      asked.contains("kind") || asked.contains("node") || asked.contains("part");
  const auto variant = variants->second.find(has_variants ? variant_of(value) : "");
  if (variant == variants->second.end()) return;
  for (auto& [key, facts] : variant->second.keys) {
    const auto of_key = asked.find(key);
    facts.required = facts.required && of_key != asked.end() && of_key->second.front()->required;
    if (of_key == asked.end()) continue;
    const std::set<std::string> fallbacks = facts.fallbacks;
    for (const KeyRequest* request : of_key->second) facts.add(*request);
    facts.fallbacks = fallbacks;
    facts.of_any_kind = facts.of_any_kind || is_of_any_kind(value, key, of_key->second);
  }
}

}  // namespace cordis::test
