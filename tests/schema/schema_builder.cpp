// tests/schema/schema_builder.cpp
#include "tests/schema/schema_builder.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "tests/schema/key_tables.h"

namespace cordis::test {

using config::KeyKind;

namespace {

constexpr const char* kParameterOfAPart = "^\\$";
constexpr const char* kColour = "^([a-z]+|#[0-9A-Fa-f]{6})$";

/// Mappings that the schema describes once and refers to.
const std::map<KeyPath, std::string>& definitions() {
  static const std::map<KeyPath, std::string> kDefinitions{
      {{"matter", "*"}, "matter"},
      {{"matter", "*", "driven"}, "driven"},
      {{"matter", "*", "driven", "position_m"}, "table_of_time"},
      {{"links", "[]"}, "link"},
      {{"ports", "*"}, "port"},
      {{"liaisons", "*"}, "liaison"},
      {{"liaisons", "*", "elasticity"}, "elasticity"},
      {{"liaisons", "*", "dissipation"}, "dissipation"},
      {{"mock", "key"}, "key"},
      {{"mock", "hand"}, "hand"},
      {{"mock", "sensor"}, "sensor"},
  };
  return kDefinitions;
}

/// Keys whose words are names of the same file.
bool is_name_of_the_file(const std::string& key) {
  return key == "to" || key == "start";
}

/// A `$name` may stand for a value of a part.
bool may_be_parameter(const KeyPath& path) {
  return !path.empty() && (path[0] == "matter" || path[0] == "links" || path[0] == "ports");
}

/// True if what a mapping lacks may stand in the liaison that it is laid on.
bool may_be_like_another(const KeyPath& path) {
  return !path.empty() && path[0] == "liaisons" && std::ranges::find(path, "[]") == path.end();
}

std::string text_of(const KeyPath& path) {
  std::string text;
  for (const std::string& name : path) text += (text.empty() ? "" : ".") + name;
  return text;
}

Json number_json(double value) {
  const bool whole = value == std::round(value) && std::abs(value) < 1e15;
  return whole ? Json(static_cast<long>(value)) : Json(value);
}

void add_range(const KeyFacts& facts, Json& schema) {
  if (std::isfinite(facts.lowest))
    schema[facts.lowest_excluded ? "exclusiveMinimum" : "minimum"] = number_json(facts.lowest);
  if (std::isfinite(facts.highest)) schema["maximum"] = number_json(facts.highest);
}

/// The types of JSON that a reader of this kind takes.
std::set<std::string> types_of(const KeyFacts& facts) {
  static const std::map<KeyKind, std::set<std::string>> kTypes{
      {KeyKind::kNumber, {"number"}},
      {KeyKind::kInteger, {"integer"}},
      {KeyKind::kTruth, {"boolean"}},
      {KeyKind::kText, {"string", "number", "boolean"}},
      {KeyKind::kChoice, {"string"}},
      {KeyKind::kColour, {"string"}},
      {KeyKind::kNumbers, {"array", "number"}},
      {KeyKind::kIntegers, {"array", "integer"}},
      {KeyKind::kMapping, {"object"}},
      {KeyKind::kSequence, {"array"}},
      {KeyKind::kFormula, {"number", "string"}},
      {KeyKind::kVector, {"array", "number"}},
      {KeyKind::kVectors, {"array", "number"}},
      {KeyKind::kFormulaVector, {"array", "number", "string"}},
      {KeyKind::kFormulaVectors, {"array", "number", "string"}},
      {KeyKind::kMappingOrWord, {"object", "string"}},
      {KeyKind::kIntegerOrWord, {"integer", "string"}},
  };
  std::set<std::string> types;
  for (const KeyKind kind : facts.kinds) {
    if (kind == KeyKind::kAny) continue;
    const std::set<std::string>& some = kTypes.at(kind);
    types.insert(some.begin(), some.end());
  }
  if (types.contains("number")) types.erase("integer");
  return types;
}

Json type_json(const std::set<std::string>& types) {
  return types.size() == 1 ? Json(*types.begin()) : Json(types);
}

void add_default(const KeyFacts& facts, Json& schema) {
  if (facts.fallbacks.size() != 1 || facts.fallbacks.begin()->empty()) return;
  const std::string& word = *facts.fallbacks.begin();
  const bool is_text =
      facts.kinds.contains(KeyKind::kText) || facts.kinds.contains(KeyKind::kChoice);
  if (is_text || Json::accept(word)) schema["default"] = is_text ? Json(word) : Json::parse(word);
}

Json parameter_of_a_part() {
  return {{"type", "string"}, {"pattern", kParameterOfAPart}};
}

/// True if a value is a vector of the scene's dimensions, or a sequence of such.
bool is_vector(const KeyFacts& facts) {
  return std::ranges::any_of(facts.kinds, [](KeyKind kind) {
    return kind == KeyKind::kVector || kind == KeyKind::kVectors ||
           kind == KeyKind::kFormulaVector || kind == KeyKind::kFormulaVectors;
  });
}

/// Adds what the items of a vector are: numbers, as many as the scene has dimensions.
void add_vector_items(const KeyFacts& facts, bool may_be_parameter, Json& schema) {
  constexpr int kMaxDimensions = 3;
  const auto& kinds = facts.kinds;
  const bool has_formulas =
      kinds.contains(KeyKind::kFormulaVector) || kinds.contains(KeyKind::kFormulaVectors);
  const bool is_list =
      kinds.contains(KeyKind::kVectors) || kinds.contains(KeyKind::kFormulaVectors);
  std::set<std::string> number{"number"};
  if (has_formulas || may_be_parameter) number.insert("string");
  Json items{{"type", type_json(number)}};
  if (is_list) {
    std::set<std::string> item = number;
    item.insert("array");
    const Json of_number = items;
    items = {{"type", type_json(item)},
             {"items", of_number},
             {"minItems", 1},
             {"maxItems", kMaxDimensions}};
  }
  schema["items"] = std::move(items);
  schema["minItems"] = 1;
  if (!is_list) schema["maxItems"] = kMaxDimensions;
}

/// The schema of a value that is no mapping.
Json scalar(const KeyFacts& facts, const std::string& key, bool may_be_parameter) {
  Json schema = Json::object();
  std::set<KeyKind> kinds = facts.kinds;
  kinds.erase(KeyKind::kAny);
  if (kinds.empty() || facts.of_any_kind) return schema;
  const bool is_choice = kinds == std::set{KeyKind::kChoice};
  if (is_choice && !is_name_of_the_file(key)) {
    if (may_be_parameter) {
      schema["anyOf"] = Json::array({{{"enum", facts.choices}}, parameter_of_a_part()});
    } else {
      schema["enum"] = facts.choices;
    }
    add_default(facts, schema);
    return schema;
  }
  if (kinds == std::set{KeyKind::kColour}) {
    const Json colour{{"type", "string"}, {"pattern", kColour}};
    return may_be_parameter ? Json{{"anyOf", {colour, parameter_of_a_part()}}} : colour;
  }
  if (kinds == std::set{KeyKind::kIntegerOrWord}) {
    Json integer{{"type", "integer"}};
    add_range(facts, integer);
    schema["anyOf"] = Json::array({{{"enum", facts.choices}}, integer});
    schema["default"] = *facts.fallbacks.begin();
    return schema;
  }
  std::set<std::string> types = types_of(facts);
  if (is_choice) types = {"string", "number", "boolean"};
  const bool parameter_only = may_be_parameter && !types.contains("string");
  std::set<std::string> with_parameter = types;
  if (may_be_parameter) with_parameter.insert("string");
  schema["type"] = type_json(with_parameter);
  if (parameter_only) schema["pattern"] = kParameterOfAPart;
  if (types.contains("number") || types.contains("integer")) add_range(facts, schema);
  if (is_vector(facts)) {
    add_vector_items(facts, may_be_parameter, schema);
  } else if (kinds.contains(KeyKind::kNumbers) || kinds.contains(KeyKind::kIntegers)) {
    std::set<std::string> item{kinds.contains(KeyKind::kIntegers) ? "integer" : "number"};
    if (may_be_parameter) item.insert("string");
    Json items{{"type", type_json(item)}};
    if (kinds.contains(KeyKind::kIntegers)) add_range(facts, items);
    schema["items"] = std::move(items);
    schema["minItems"] = std::max<std::size_t>(facts.min_length, 1);
    if (facts.min_length > 0) schema["maxItems"] = facts.max_length;
  }
  if (facts.kinds.contains(KeyKind::kText) || !kinds.contains(KeyKind::kFormula))
    add_default(facts, schema);
  return schema;
}

}  // namespace

bool SchemaBuilder::is_left_out(const KeyPath& path, const std::string& variant,
                                const std::string& key) const {
  // What a link gives to parameters of its liaison has the names of that file.
  return facts_.parameter_names().contains(key) &&
         facts_.paths().at(path).at(variant).keys.contains("liaison") &&
         notes_.meaning(path, variant, key).empty();
}

Json SchemaBuilder::value(const KeyPath& path, const std::string& key, const KeyFacts& facts) {
  const KeyPath inner = below(path, key);
  const KeyPath each = below(inner, "*");
  const KeyPath item = below(inner, "[]");
  if (facts_.has(canonical(each))) {
    Json map{{"type", "object"}, {"additionalProperties", object_or_reference(canonical(each))}};
    if (key == "liaisons" || key == "parts") {
      map["properties"]["include"] = {
          {"type", {"string", "array"}},
          {"items", {{"type", "string"}}},
          {"description", "Files of more of them, relative to this one."}};
    }
    return map;
  }
  const bool has_object = facts_.has(canonical(inner));
  const bool has_items = facts_.has(canonical(item));
  if (!has_object && !has_items) return scalar(facts, key, may_be_parameter(path));
  Json array{{"type", "array"}};
  if (has_items) {
    Json one = object_or_reference(canonical(item));
    if (facts_.has_words(item)) one = {{"anyOf", Json::array({one, {{"type", "string"}}})}};
    array["items"] = std::move(one);
  }
  if (facts.kinds.contains(KeyKind::kMappingOrWord)) {
    return {{"anyOf",
             Json::array({object_or_reference(canonical(inner)), Json{{"enum", facts.choices}}})}};
  }
  const bool is_of_any_kind = facts.of_any_kind || facts.kinds == std::set{KeyKind::kAny};
  const bool is_plain = !is_of_any_kind || facts.kinds.contains(KeyKind::kMapping) ||
                        facts.kinds.contains(KeyKind::kSequence);
  if (is_plain && !has_object) return array;
  if (is_plain && !may_be_parameter(path)) return object_or_reference(canonical(inner));
  if (is_plain) {
    return {{"anyOf", Json::array({object_or_reference(canonical(inner)), parameter_of_a_part()})}};
  }
  Json words{{"type", {"string", "number", "boolean"}}};
  Json any = Json::array();
  if (has_object) any.push_back(object_or_reference(canonical(inner)));
  any.push_back(std::move(array));
  any.push_back(std::move(words));
  return {{"anyOf", std::move(any)}};
}

Json SchemaBuilder::properties(const KeyPath& path, const std::string& variant) {
  Json properties = Json::object();
  for (const auto& [key, facts] : facts_.paths().at(path).at(variant).keys) {
    if (is_left_out(path, variant, key)) continue;
    std::string meaning = notes_.meaning(path, variant, key);
    if (meaning.empty()) without_meaning_.insert(text_of(path) + ": " + key);
    const std::string unit = unit_of(key);
    if (!unit.empty()) meaning.insert(0, unit + " ");
    Json schema{{"description", meaning}};
    Json of_value = value(path, key, facts);
    if (of_value.contains("$ref")) of_value = {{"allOf", Json::array({of_value})}};
    schema.update(of_value);
    properties[key] = std::move(schema);
  }
  return properties;
}

Json SchemaBuilder::variant_object(const KeyPath& path, const std::string& variant,
                                   const VariantFacts& facts) {
  Json schema{{"properties", properties(path, variant)}};
  Json required = Json::array();
  for (const auto& [key, of_key] : facts.keys) {
    const bool always = of_key.required && of_key.mapping_count == facts.mapping_count;
    if (!always || may_be_like_another(path)) continue;
    if (of_key.alternatives.empty()) {
      required.push_back(key);
      continue;
    }
    Json one_of_them = Json::array({{{"required", {key}}}});
    for (const std::string& other : of_key.alternatives)
      one_of_them.push_back({{"required", {other}}});
    schema["allOf"].push_back({{"anyOf", std::move(one_of_them)}});
  }
  if (!required.empty()) schema["required"] = std::move(required);
  if (!facts.keys.contains("liaison")) {
    schema["additionalProperties"] = false;
    return schema;
  }
  schema["additionalProperties"] = {{"type", {"number", "string"}},
                                    {"description", "Value of a parameter of the liaison."}};
  Json names = Json::array();
  for (const auto& [key, property] : schema["properties"].items()) names.push_back(key);
  schema["if"] = {{"not", {{"required", {"liaison"}}}}};
  schema["then"] = {{"propertyNames", {{"enum", std::move(names)}}}};
  return schema;
}

Json SchemaBuilder::with_variants(const KeyPath& path,
                                  const std::map<std::string, VariantFacts>& variants) {
  const char* const word = path[0] == "nodes" ? "node" : "kind";
  Json kinds = Json::array();
  Json cases = Json::array();
  for (const auto& [variant, facts] : variants) {
    Json test;
    if (variant.empty()) {
      test = {{"not", {{"required", {word}}}}};
    } else if (variant == "part") {
      test = {{"required", {"part"}}};
    } else {
      kinds.push_back(variant);
      test = {{"properties", {{word, {{"const", variant}}}}}, {"required", {word}}};
    }
    cases.push_back({{"if", std::move(test)}, {"then", variant_object(path, variant, facts)}});
  }
  Json schema{{"type", "object"}};
  schema["properties"][word] = {{"description", notes_.meaning(path, "", word)}, {"enum", kinds}};
  if (variants.contains("part")) {
    schema["anyOf"] = {{{"required", {word}}}, {{"required", {"part"}}}};
  } else if (!variants.contains("") && !may_be_like_another(path)) {
    schema["required"] = {word};
  } else if (!variants.contains("")) {
    std::set<std::string> names;
    for (const auto& [variant, facts] : variants) {
      for (const auto& [key, of_key] : facts.keys) names.insert(key);
    }
    schema["propertyNames"] = {{"enum", names}};
  }
  schema["allOf"] = std::move(cases);
  return schema;
}

Json SchemaBuilder::object(const KeyPath& path) {
  const std::map<std::string, VariantFacts>& variants = facts_.paths().at(path);
  if (variants.size() > 1 || !variants.contains("")) return with_variants(path, variants);
  Json schema{{"type", "object"}};
  schema.update(variant_object(path, "", variants.at("")));
  return schema;
}

Json SchemaBuilder::object_or_reference(const KeyPath& path) {
  const auto definition = definitions().find(path);
  if (definition == definitions().end()) return object(path);
  return {{"$ref", "#/definitions/" + definition->second}};
}

Json SchemaBuilder::schema() {
  Json schema{{"$schema", "http://json-schema.org/draft-07/schema#"}, {"title", notes_.title}};
  schema.update(object({}));
  for (const auto& [path, name] : definitions()) {
    if (facts_.has(path)) schema["definitions"][name] = object(path);
  }
  return schema;
}

}  // namespace cordis::test
