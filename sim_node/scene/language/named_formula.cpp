// sim_node/scene/language/named_formula.cpp
#include "sim_node/scene/language/named_formula.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "node/config/nearest_word.h"

namespace cordis::scene {

namespace {

using config::Problems;
using config::Value;

const FormulaName* name_called(std::span<const FormulaName> names, const std::string& word) {
  const auto found =
      std::ranges::find_if(names, [&word](const FormulaName& name) { return word == name.word; });
  return found == names.end() ? nullptr : &*found;
}

/// The word that a program of links has for a quantity.
const char* word_of(engine::Quantity quantity) {
  const auto* const found = std::ranges::find(kQuantityNames, quantity, &QuantityName::quantity);
  return found->word;
}

std::string list_of(std::span<const FormulaName> names) {
  std::string text;
  for (const FormulaName& name : names) text += std::string(name.word) + ", ";
  return text;
}

/// Puts the names of a formula to what they stand for. @return whether all are known
bool put_names(Expression& formula, const std::string& what, std::span<const FormulaName> names,
               const ParameterValues& parameters, const AskedOutside* outside, Problems& problems) {
  // A signal that is called as a quantity of links would be taken for what stands for another name.
  const auto is_signal = [outside](const std::string& word) {
    return outside != nullptr && outside->signals.contains(word) && find_quantity(word) == nullptr;
  };
  bool known = true;
  for (ExpressionWord& word : formula.words) {
    if (word.kind == ExpressionWord::Kind::kOperation) {
      if (!engine::is_edge(word.operation)) continue;
      problems.error(formula.place_of(word), what + " cannot ask for 'rising' or 'falling'");
      known = false;
    } else if (word.kind == ExpressionWord::Kind::kName) {
      if (const FormulaName* name = name_called(names, word.name)) {
        word.name = word_of(name->place);
      } else if (parameters.find(word.name)) {
        continue;
      } else if (word.name == kPiWord) {
        word.kind = ExpressionWord::Kind::kNumber;
        word.number = std::numbers::pi;
      } else if (!is_signal(word.name)) {
        std::vector<std::string> words = parameters.names();
        for (const FormulaName& other : names) words.emplace_back(other.word);
        words.emplace_back(kPiWord);
        if (outside != nullptr)
          words.insert(words.end(), outside->signals.begin(), outside->signals.end());
        const std::string hint = config::did_you_mean(word.name, words);
        problems.error(formula.place_of(word), what + " cannot ask for '" + word.name + "'",
                       hint.empty() ? "it may ask for " + list_of(names) + kPiWord +
                                          (outside == nullptr ? " and its parameters"
                                                              : ", its parameters and signals")
                                    : hint);
        known = false;
      }
    }
  }
  return known;
}

std::string axes_text(int space) {
  return space == 1 ? "one formula" : std::to_string(space) + " formulas, one for each axis";
}

}  // namespace

engine::Program read_named_formula(const Value& text, const std::string& what,
                                   std::span<const FormulaName> names,
                                   const ParameterValues& parameters, Problems& problems,
                                   AskedOutside* outside) {
  std::optional<Expression> formula = parse_expression(text, what, problems);
  if (!formula) return {};
  if (formula->is_truth) {
    problems.error(text.place(), what + " must be a number, got a comparison",
                   "write if(..., 1, 0)");
    return {};
  }
  if (!put_names(*formula, what, names, parameters, outside, problems)) return {};
  std::uint32_t slots = 0;
  std::optional<CompiledExpression> compiled =
      compile(*formula, what, parameters, slots, problems, outside);
  return compiled ? std::move(compiled->program) : engine::Program{};
}

bool has_formula(const Value& value) {
  const auto is_formula = [](const Value& item) {
    return item.kind() == Value::Kind::kScalar && !is_plain_number(item);
  };
  if (value.kind() == Value::Kind::kSequence) {
    return std::ranges::any_of(value.items(), is_formula);
  }
  return is_formula(value);
}

AxisFormulas read_axis_formulas(const Value& value, const std::string& what, int space,
                                std::span<const FormulaName> names,
                                const ParameterValues& parameters, const std::string& or_else,
                                Problems& problems, AskedOutside* outside) {
  AxisFormulas formulas;
  const bool is_list = value.kind() == Value::Kind::kSequence;
  const std::vector<Value> texts = is_list ? value.items() : std::vector<Value>{value};
  if (texts.size() != static_cast<std::size_t>(space)) {
    problems.error(value.place(),
                   what + " must be " + axes_text(space) + or_else + ", got " +
                       (is_list ? std::to_string(texts.size()) : value.described()),
                   hint_for_commas(texts));
    return formulas;
  }
  for (std::size_t axis = 0; axis < texts.size(); ++axis) {
    formulas[axis] = read_named_formula(texts[axis], what, names, parameters, problems, outside);
  }
  return formulas;
}

ParameterValues read_formula_parameters(config::MappingReader& reader,
                                        std::span<const FormulaName> names,
                                        const std::string& formulas, Problems& problems) {
  ParameterValues parameters(reader.optional_mapping("parameters"), {}, nullptr, reader.what(),
                             problems);
  std::vector<std::string> taken{kPiWord};
  for (const FormulaName& name : names) taken.emplace_back(name.word);
  for (const std::string& word : taken) {
    if (!parameters.find(word)) continue;
    reader.error_at("parameters", "'" + word + "' has its meaning in " + formulas,
                    "give the parameter another name");
  }
  return parameters;
}

}  // namespace cordis::scene
