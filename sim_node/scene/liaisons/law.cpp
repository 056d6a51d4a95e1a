// sim_node/scene/liaisons/law.cpp
#include "sim_node/scene/liaisons/law.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>
#include <variant>

namespace cordis::scene {

namespace {

using config::Problems;
using config::Range;
using config::Value;
using engine::Law;
using engine::LawField;

/// Reads the fields of a law, as the law itself declares them.
class FieldReader {
 public:
  /// @param argument  key of what the law is a function of
  /// @param formulas  those of its fields are added
  FieldReader(config::MappingReader& reader, const char* argument, ExpressionOwner owner,
              const ParameterValues& parameters, AskedOutside& outside, Problems& problems,
              std::vector<engine::ParameterFormula>& formulas)
      : reader_(reader),
        argument_(argument),
        owner_(owner),
        parameters_(parameters),
        outside_(outside),
        problems_(problems),
        formulas_(formulas) {}

  void operator()(const LawField& field, double& value) {
    const Range range{field.lowest, field.highest, field.lowest_excluded, hint_of(field)};
    if (field.follows) {
      reader_.required_value(field.key);
      const ChangingNumber changing =
          optional_changing(reader_, field.key, 0.0, range, parameters_, outside_, problems_);
      value = changing.number;
      if (changing.changes()) formulas_.push_back({engine::Parameter::kDepth, changing.program});
      return;
    }
    value = field.is_optional
                ? optional_formula(reader_, field.key, 0.0, range, parameters_, problems_)
                : required_formula(reader_, field.key, range, parameters_, problems_);
    if (field.multiple_of == 0.0 || std::fmod(value, field.multiple_of) == 0.0) return;
    reader_.error_at(field.key,
                     quoted(field.key) + " must be a multiple of " +
                         config::number_text(field.multiple_of) + ", got " +
                         config::number_text(value),
                     hint_of(field));
  }

  void operator()(const LawField& field, std::vector<double>& list) {
    const bool has_other = owner_ == ExpressionOwner::kBend && field.bend_key != nullptr;
    const char* named = has_other ? field.bend_key : field.key;
    const char* key = named == nullptr ? argument_ : named;
    const std::size_t errors_before = problems_.error_count();
    for (const Value& item : reader_.required_sequence(key).items())
      list.push_back(read_formula(item, quoted(key), 0.0, {}, parameters_, problems_));
    if (!field.as_many_as_first) first_count_ = list.size();
    is_whole_ = is_whole_ && problems_.error_count() == errors_before;
    if (is_whole_) check_list(field, key, list);
  }

  /// A list of mappings with fields of their own.
  template <class Item>
  void operator()(const LawField& field, std::vector<Item>& list) {
    const Value items = reader_.required_sequence(field.key);
    if (items.exists() && items.items().empty())
      reader_.error_at(field.key, quoted(field.key) + " must not be empty");
    for (const Value& item : items.items()) {
      config::MappingReader reader(item, std::string(Item::kName) + " of " + reader_.what(),
                                   problems_);
      Item::visit_fields(list.emplace_back(), FieldReader(reader, argument_, owner_, parameters_,
                                                          outside_, problems_, formulas_));
      reader.finish();
    }
  }

 private:
  const char* hint_of(const LawField& field) const {
    const bool has_other = owner_ == ExpressionOwner::kBend && field.bend_hint != nullptr;
    return has_other ? field.bend_hint : field.hint;
  }

  std::string quoted(const char* key) const {
    return std::string("'") + key + "' in " + reader_.what();
  }

  void check_list(const LawField& field, const char* key, const std::vector<double>& list) {
    if (list.empty() && !field.as_many_as_first)
      reader_.error_at(key, quoted(key) + " must not be empty");
    if (field.as_many_as_first && list.size() != first_count_) {
      reader_.error_at(key, quoted(key) + " must have one number for each of '" + argument_ +
                                "', " + std::to_string(first_count_) + ", got " +
                                std::to_string(list.size()));
    }
    const auto turn = std::adjacent_find(list.begin(), list.end(), std::greater_equal<>());
    if (!field.ascends || turn == list.end()) return;
    const auto points = reader_.optional_value(key).items();
    problems_.error(points[static_cast<std::size_t>(turn - list.begin()) + 1].place(),
                    quoted(key) + " must ascend, got " + config::number_text(turn[1]) + " after " +
                        config::number_text(turn[0]));
  }

  config::MappingReader& reader_;
  const char* argument_;
  ExpressionOwner owner_;
  const ParameterValues& parameters_;
  AskedOutside& outside_;
  Problems& problems_;
  std::vector<engine::ParameterFormula>& formulas_;
  std::size_t first_count_ = 0;
  bool is_whole_ = true;  // all lists so far could be read
};

/// Calls a function with each type of law that has a name, in the order of their table.
template <class Function>
void for_each_law(const Function& function) {
  const auto call = [&]<class Type>(Type law) {
    if constexpr (Type::kName != nullptr) function(std::move(law));
  };
  [&]<std::size_t... kTypes>(std::index_sequence<kTypes...>) {
    (call(std::variant_alternative_t<kTypes, Law>{}), ...);
  }
  (std::make_index_sequence<std::variant_size_v<Law>>{});
}

/// Reads the key of a law. @param argument  key of the points of a table
Law read_law(config::MappingReader& reader, const char* key, const char* argument, bool of_speed,
             ExpressionOwner owner, const ParameterValues& parameters, AskedOutside& outside,
             Problems& problems, std::vector<engine::ParameterFormula>& formulas) {
  reader.describe({.key = key, .kind = config::KeyKind::kAny});
  const Value value = reader.optional_value(key);
  const std::string what = std::string(key) + " of " + reader.what();
  if (!value.exists()) return {};
  if (value.kind() == Value::Kind::kScalar) {
    std::optional<engine::Program> program =
        compile_law(value, what, parameters, outside, problems, owner);
    return program ? Law(engine::Expression{std::move(*program)}) : Law();
  }
  std::vector<std::string> kinds;
  for_each_law([&]<class Type>(const Type& /*law*/) {
    const bool has_distance = !of_speed && owner == ExpressionOwner::kLink;
    if (has_distance || Type::kArgument != engine::LawArgument::kDistance)
      kinds.emplace_back(Type::kName);
  });
  config::MappingReader fields(value, what, problems);
  const std::string kind = fields.required_choice("kind", kinds);
  Law law;
  if (!fields.ok()) return law;
  for_each_law([&]<class Type>(Type read) {
    if (kind != Type::kName) return;
    Type::visit_fields(
        read, FieldReader(fields, argument, owner, parameters, outside, problems, formulas));
    if constexpr (requires { read.find_slopes(); }) read.find_slopes();
    law = std::move(read);
  });
  fields.finish();
  return law;
}

}  // namespace

engine::Law read_elasticity(config::MappingReader& reader, const ParameterValues& parameters,
                            AskedOutside& outside, Problems& problems,
                            std::vector<engine::ParameterFormula>& formulas,
                            ExpressionOwner owner) {
  const char* const argument = owner == ExpressionOwner::kBend ? "at_rad" : "at_m";
  return read_law(reader, "elasticity", argument, /*of_speed=*/false, owner, parameters, outside,
                  problems, formulas);
}

engine::Law read_dissipation(config::MappingReader& reader, const ParameterValues& parameters,
                             AskedOutside& outside, Problems& problems, ExpressionOwner owner) {
  std::vector<engine::ParameterFormula> none;  // no law over the speed has such a field
  const char* const argument = owner == ExpressionOwner::kBend ? "at_rad_per_s" : "at_m_per_s";
  return read_law(reader, "dissipation", argument, /*of_speed=*/true, owner, parameters, outside,
                  problems, none);
}

}  // namespace cordis::scene
