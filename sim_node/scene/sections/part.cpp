// sim_node/scene/sections/part.cpp
#include "sim_node/scene/sections/part.h"

#include <algorithm>
#include <cctype>
#include <set>
#include <utility>

#include "node/config/mapping_reader.h"
#include "node/config/nearest_word.h"
#include "sim_node/scene/language/expression.h"
#include "sim_node/scene/language/name.h"

namespace cordis::scene {

namespace {

using config::Value;

bool is_of_name(char letter) {
  return std::isalnum(static_cast<unsigned char>(letter)) != 0 || letter == '_';
}

/// Adds the names that a value asks for as `$name`, also where that cannot be computed with.
void add_asked(const Value& value, std::set<std::string>& asked) {
  for (const Value& item : value.items()) add_asked(item, asked);
  for (const Value::Entry& entry : value.entries()) add_asked(entry.value, asked);
  const std::string& text = value.text();
  for (std::size_t dollar = text.find('$'); dollar != std::string::npos;
       dollar = text.find('$', dollar + 1)) {
    const auto first = text.begin() + static_cast<std::ptrdiff_t>(dollar + 1);
    asked.emplace(first, std::find_if_not(first, text.end(), is_of_name));
  }
}

/// Warns of the parameters that nothing of a part asks for.
void warn_of_unused_parameters(const Part& part, config::Problems& problems) {
  std::set<std::string> asked;
  for (const Value* each : {&part.parameters, &part.matter, &part.ports, &part.links})
    add_asked(*each, asked);
  for (const Value::Entry& parameter : part.parameters.entries()) {
    if (asked.contains(parameter.key)) continue;
    problems.warning(parameter.key_place, "parameter '" + parameter.key + "' of part '" +
                                              part.name + "' is used nowhere");
  }
}

/// Puts values in the place of `$name`.
class Substitution {
 public:
  Substitution(const Part& part, config::Problems& problems) : part_(part), problems_(problems) {}

  void set(const std::string& name, const Value& value) { values_[name] = value; }

  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const auto& [name, value] : values_) names.push_back(name);
    return names;
  }

  /// How many values it has replaced or kept.
  std::size_t value_count() const noexcept { return value_count_; }

  /// The value with every `$name` in it replaced; an unknown one is a problem.
  Value operator()(const Value& value) {
    ++value_count_;
    if (value.kind() == Value::Kind::kSequence) {
      std::vector<Value> items;
      for (const Value& item : value.items()) items.push_back((*this)(item));
      return Value::sequence(std::move(items), value.place());
    }
    if (value.kind() == Value::Kind::kMapping) {
      std::vector<Value::Entry> entries;
      for (const Value::Entry& entry : value.entries())
        entries.push_back({entry.key, entry.key_place, (*this)(entry.value)});
      return Value::mapping(std::move(entries), value.place());
    }
    if (value.quoted() || !value.text().starts_with("$")) return value;
    const std::string name = value.text().substr(1);
    const auto known = values_.find(name);
    if (known != values_.end()) return known->second;
    if (name.find_first_of(" */+^()") != std::string::npos) {
      parse_expression(value, "a value in part '" + part_.name + "'", problems_);  // refuses the $
      return value;
    }
    problems_.error(value.place(), "part '" + part_.name + "' has no parameter '" + name + "'",
                    config::did_you_mean(name, names()));
    return value;
  }

 private:
  const Part& part_;
  config::Problems& problems_;
  std::map<std::string, Value> values_;
  std::size_t value_count_ = 0;
};

}  // namespace

void Parts::read_section(const Value& section, const std::string& file) {
  const Includes::Open open(includes_, file);
  for (const Value::Entry& entry : section.entries()) {
    if (entry.key != "include") {
      add(entry);
      continue;
    }
    for (const Includes::File& included : includes_.read(entry.value, file)) {
      config::MappingReader reader(included.root, "file of parts", problems_);
      reader.required_integer("cordis", 1, 1);
      const Value liaisons = reader.optional_mapping("liaisons");
      if (liaisons.exists()) liaisons_.push_back({liaisons, included.path});
      read_section(reader.required_mapping("parts"), included.path);
      reader.finish();
    }
  }
}

void Parts::add(const Value::Entry& entry) {
  const bool named = check_name(entry.key, entry.key_place, problems_);
  const auto [known, is_new] = parts_.try_emplace(entry.key);
  if (!is_new) {
    const config::Place& first = known->second.place;
    problems_.error(entry.key_place, "the part '" + entry.key + "' is defined twice",
                    "first defined at " + first.file + ":" + std::to_string(first.line));
    return;
  }
  Part& part = known->second;
  part.name = entry.key;
  part.place = entry.key_place;
  config::MappingReader reader(entry.value, "part '" + entry.key + "'", problems_);
  part.parameters = reader.optional_mapping("parameters");
  part.ports = reader.optional_mapping("ports");
  const bool has_port = part.ports.exists() && !part.ports.entries().empty();
  part.matter = has_port ? reader.optional_mapping("matter") : reader.required_mapping("matter");
  part.links = reader.optional_sequence("links");
  if (!has_port && part.matter.exists() && part.matter.entries().empty())
    reader.error_at("matter", "part '" + entry.key + "' has no matter");
  reader.finish();
  part.sound = named && reader.ok();
}

const Part* Parts::find(const Value& name) const {
  const auto found = parts_.find(name.text());
  if (name.kind() == Value::Kind::kScalar && found != parts_.end())
    return found->second.sound ? &found->second : nullptr;
  std::vector<std::string> words;
  for (const auto& [word, part] : parts_) words.push_back(word);
  if (name.kind() != Value::Kind::kScalar) {
    problems_.error(name.place(), "a part is called by its name, got " + name.described());
  } else {
    problems_.error(name.place(), "no part is named '" + name.text() + "'",
                    config::did_you_mean(name.text(), words));
  }
  return nullptr;
}

std::optional<PartBody> Parts::body(const Part& part, const Value& overrides,
                                    const config::Place& use_place) {
  const std::size_t errors_before = problems_.error_count();
  Substitution substitution(part, problems_);
  for (const Value::Entry& parameter : part.parameters.entries()) {
    const Value use = overrides.find(parameter.key);
    // a default may be made of the parameters before it
    const Value value = use.exists() ? use : substitution(parameter.value);
    if (value.kind() == Value::Kind::kNothing) {
      problems_.error(use_place, "part '" + part.name + "' needs a value for the parameter '" +
                                     parameter.key + "'");
    }
    substitution.set(parameter.key, value);
  }
  for (const Value::Entry& entry : overrides.entries()) {
    if (part.parameters.find(entry.key).exists()) continue;
    problems_.error(entry.key_place,
                    "part '" + part.name + "' has no parameter '" + entry.key + "'",
                    config::did_you_mean(entry.key, substitution.names()));
  }
  PartBody body{substitution(part.matter), substitution(part.ports), substitution(part.links)};
  value_count_ += substitution.value_count() + part.parameters.entries().size();
  if (problems_.error_count() != errors_before) return std::nullopt;
  if (used_.insert(&part).second) warn_of_unused_parameters(part, problems_);
  return body;
}

}  // namespace cordis::scene
