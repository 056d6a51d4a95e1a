// tests/schema/schemas.cpp
#include "tests/schema/schemas.h"

#include <stdexcept>

#include "tests/schema/corpus.h"
#include "tests/schema/key_tables.h"

namespace cordis::test {

namespace {

/// The heading of a path: "matter.NAME.ball".
std::string heading_of(const KeyPath& path, const char* of_item) {
  std::string heading;
  for (const std::string& name : path) {
    const std::string word = name == "*" ? "NAME" : name == "[]" ? of_item : name;
    if (!word.empty()) heading += (heading.empty() ? "" : ".") + word;
  }
  return heading;
}

std::string first_of(const KeyTables& tables, const std::vector<std::string>& headings,
                     const std::string& key) {
  for (const std::string& heading : headings) {
    std::string meaning = tables.meaning(heading, key);
    if (!meaning.empty()) return meaning;
  }
  return {};
}

SchemaNotes notes_of_scene() {
  const KeyTables tables(CORDIS_SOURCE_DIR "/docs/scene_keys.md");
  return {"A scene of Cordis",
          [tables](const KeyPath& path, const std::string& /*variant*/, const std::string& key) {
            return tables.meaning(path.empty() ? "Scene" : heading_of(path, "ITEM"), key);
          }};
}

SchemaNotes notes_of_device() {
  const KeyTables tables(CORDIS_SOURCE_DIR "/docs/launch.md");
  return {"A device of Cordis",
          [tables](const KeyPath& path, const std::string& variant, const std::string& key) {
            if (path.empty()) return first_of(tables, {"Device file", "device_node"}, key);
            if (path.back() == "coupling") return tables.meaning("coupling", key);
            const std::string heading = heading_of(path, "");
            return first_of(tables, {"Kind " + variant, heading, "Every kind but hold"}, key);
          }};
}

SchemaNotes notes_of_launch() {
  const KeyTables tables(CORDIS_SOURCE_DIR "/docs/launch.md");
  return {"A launch file of Cordis",
          [tables](const KeyPath& path, const std::string& variant, const std::string& key) {
            if (path.empty() && key == "record") {
              return std::string("A record_node named record: its keys, or the path of its take.");
            }
            if (path.empty()) return tables.meaning("Session", key);
            if (path[0] == "network") return tables.meaning("network", key);
            const std::string program = path[0] == "record" ? "record_node" : variant;
            return first_of(tables, {program, "Every node"}, key);
          }};
}

/// A device_node takes every key of a device file beside its own, and needs none of them.
void add_device_keys(Json& launch, SchemaBuilder& device) {
  const Json keys = device.properties({}, "");
  for (Json& one : launch["properties"]["nodes"]["additionalProperties"]["allOf"]) {
    if (one["if"]["properties"]["node"]["const"] != "device_node") continue;
    Json& properties = one["then"]["properties"];
    for (const auto& [key, schema] : keys.items()) {
      if (!properties.contains(key)) properties[key] = schema;
    }
    one["then"]["required"] = {"node"};
  }
  launch["definitions"] = device.schema()["definitions"];
}

/// `record:` is a node whose program is known.
void leave_program_out(Json& launch) {
  for (Json& one : launch["properties"]["record"]["anyOf"]) {
    if (one.contains("properties")) one["properties"].erase("node");
    one.erase("required");
  }
}

}  // namespace

BuiltSchema build_schema(const std::string& sort) {
  FileFacts facts = facts_of(sort);
  if (sort == "scene") add_variations(sort, facts);
  SchemaBuilder builder(facts, sort == "scene"    ? notes_of_scene()
                               : sort == "device" ? notes_of_device()
                                                  : notes_of_launch());
  BuiltSchema built{builder.schema(), builder.without_meaning()};
  if (sort != "launch") return built;
  const FileFacts device_facts = facts_of("device");
  SchemaBuilder device(device_facts, notes_of_device());
  add_device_keys(built.schema, device);
  leave_program_out(built.schema);
  return built;
}

}  // namespace cordis::test
