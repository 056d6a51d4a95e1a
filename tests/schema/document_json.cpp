// tests/schema/document_json.cpp
#include "tests/schema/document_json.h"

#include <charconv>
#include <system_error>

#include "node/config/yaml_reader.h"

namespace cordis::test {

using Json = nlohmann::ordered_json;
using config::Value;

Json json_of(const Value& value) {
  if (value.kind() == Value::Kind::kSequence) {
    Json list = Json::array();
    for (const Value& item : value.items()) list.push_back(json_of(item));
    return list;
  }
  if (value.kind() == Value::Kind::kMapping) {
    Json map = Json::object();
    for (const Value::Entry& entry : value.entries()) map[entry.key] = json_of(entry.value);
    return map;
  }
  if (value.kind() == Value::Kind::kNothing) return nullptr;
  const std::string& text = value.text();
  if (value.quoted()) return text;
  if (text == "true" || text == "false") return text == "true";
  double number = 0.0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (failure != std::errc{} || end != text.data() + text.size()) return text;
  const bool whole = text.find_first_of(".eE") == std::string::npos;
  return whole ? Json(static_cast<long>(number)) : Json(number);
}

Json json_of_text(const std::string& text) {
  config::Problems problems;
  return json_of(config::load_text(text, "document", problems));
}

}  // namespace cordis::test
