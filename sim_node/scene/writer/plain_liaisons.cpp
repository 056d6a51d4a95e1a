#include "sim_node/scene/writer/plain_liaisons.h"

#include <algorithm>
#include <vector>

namespace cordis::scene {

namespace {

using config::Value;

bool is_plain(const std::string& text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '.' || c == '+' || c == '-';
  });
}

std::string in_quotes(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c == '\n' ? ' ' : c;
  }
  return quoted + '"';
}

/// A part of a parallel liaison: its name, and what it is by itself.
struct PlainPart {
  std::string name;
  Value definition;
};

/// The definition with those parameters under its own that it uses.
Value with_parameters(const Value& definition, const std::vector<Value::Entry>& outer) {
  std::vector<Value::Entry> all = definition.find("parameters").entries();
  std::string used = text_of(definition);
  const auto is_wanted = [&](const Value::Entry& entry) {
    const auto is_it = [&](const Value::Entry& other) { return other.key == entry.key; };
    return used.find(entry.key) != std::string::npos &&
           std::find_if(all.begin(), all.end(), is_it) == all.end();
  };
  for (auto next = outer.begin(); next != outer.end();) {
    next = std::find_if(outer.begin(), outer.end(), is_wanted);
    if (next == outer.end()) break;
    all.push_back(*next);
    used += text_of(next->value);  // a parameter may be made of others
  }
  if (all.empty()) return definition;
  return config::with_value_at(definition, {"parameters"}, Value::mapping(all, definition.place()));
}

/// The parts of a parallel liaison as read_liaison() names them.
std::vector<PlainPart> parts_of(const Value& definition, const Liaisons& liaisons) {
  std::vector<PlainPart> parts;
  const std::vector<Value::Entry>& outer = definition.find("parameters").entries();
  for (const Value& item : definition.find("parallel").items()) {
    const bool is_name = item.kind() == Value::Kind::kScalar;
    config::Problems none;
    const Value one = is_name ? liaisons.find(item.text())->definition
                              : with_parameters(liaisons.completed(item, none), outer);
    if (one.find("parallel").exists()) {
      for (PlainPart& inner : parts_of(one, liaisons)) parts.push_back(std::move(inner));
      continue;
    }
    const Value like = item.find("like");
    const std::string name = is_name         ? item.text()
                             : like.exists() ? like.text()
                                             : item.find("kind").text();
    parts.push_back({name, one});
  }
  return parts;
}

}  // namespace

std::string text_of(const Value& value) {
  std::string text;
  switch (value.kind()) {
    case Value::Kind::kNothing:
      return "~";
    case Value::Kind::kScalar:
      return value.quoted() || !is_plain(value.text()) ? in_quotes(value.text()) : value.text();
    case Value::Kind::kSequence:
      for (const Value& item : value.items()) text += (text.empty() ? "" : ", ") + text_of(item);
      return "[" + text + "]";
    case Value::Kind::kMapping:
      for (const Value::Entry& entry : value.entries()) {
        text += (text.empty() ? "" : ", ") + entry.key + ": " + text_of(entry.value);
      }
      return "{" + text + "}";
  }
  return text;
}

std::string PlainLiaisons::name_of(const std::string& liaison, const std::string& part) {
  const auto [known, is_new] = names_.try_emplace({liaison, part});
  if (!is_new) return known->second;
  Value definition = liaisons_.find(liaison)->definition;
  std::string name = liaison;
  if (definition.find("parallel").exists()) {
    std::map<std::string, int> uses;
    for (const PlainPart& one : parts_of(definition, liaisons_)) {
      const int use = ++uses[one.name];
      if (one.name + (use > 1 ? std::to_string(use) : "") == part) {
        definition = one.definition;
        break;
      }
    }
    name += "_" + part;
    while (liaisons_.find(name) != nullptr || definitions_.count(name) > 0) name += "_";
  }
  definitions_.emplace(name, definition);
  known->second = name;
  return name;
}

GivenParameters PlainLiaisons::given_to(const std::string& name,
                                        const GivenParameters& given) const {
  GivenParameters taken;
  for (const std::string& word : parameters_of(definitions_.at(name))) {
    if (const auto value = given.find(word); value != given.end()) taken.insert(*value);
  }
  return taken;
}

std::string PlainLiaisons::text() const {
  std::string text;
  for (const auto& [name, definition] : definitions_) {
    text += "  " + name + ": " + text_of(definition) + "\n";
  }
  return text;
}

}  // namespace cordis::scene
