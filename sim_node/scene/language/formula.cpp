// sim_node/scene/language/formula.cpp
#include "sim_node/scene/language/formula.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "node/config/key_log.h"
#include "node/config/nearest_word.h"
#include "sim_node/engine/expressions/elementary_functions.h"
#include "sim_node/scene/language/quantity.h"

namespace cordis::scene {

namespace {

using config::Problems;
using config::Range;
using config::Value;
using engine::Instruction;
using engine::Operation;

constexpr std::size_t kMaxParameters = 1'000;  // of a liaison
constexpr std::size_t kMaxOpen = 64;           // parameters that wait for each other

/// Depth of the stack after and during a program that is well-formed.
std::size_t deepest_stack(const engine::Program& program) {
  std::size_t depth = 0;
  std::size_t deepest = 0;
  for (const Instruction& instruction : program.code) {
    depth += 1;
    depth -= engine::operand_count(instruction.operation);
    deepest = std::max(deepest, depth);
  }
  return deepest;
}

bool is_constant(const Instruction& instruction) {
  return instruction.operation == Operation::kConstant;
}

/// Makes `x ^ n` with a whole number n multiplications. @return whether it was that.
bool add_whole_power(std::vector<Instruction>& code) {
  const double exponent = code.back().constant;
  if (!is_constant(code.back()) || std::abs(exponent) > engine::kMaxWholePower ||
      exponent != std::floor(exponent)) {
    return false;
  }
  code.back() = {Operation::kWholePower, engine::Quantity::kDistance, exponent, 0};
  return true;
}

/// Adds an operation to a program, or its result when its operands are constants.
void add_operation(std::vector<Instruction>& code, Operation operation, std::uint32_t& next_slot) {
  const std::size_t operands = engine::operand_count(operation);
  const bool remembers = engine::is_edge(operation);
  const Instruction added{operation, engine::Quantity::kDistance, 0.0, remembers ? next_slot++ : 0};
  const auto first = code.end() - static_cast<std::ptrdiff_t>(operands);
  if (remembers || !std::all_of(first, code.end(), is_constant)) {
    if (operation != Operation::kPower || !add_whole_power(code)) code.push_back(added);
    return;
  }
  std::array<double, 3> values{};
  std::transform(first, code.end(), values.begin(),
                 [](const Instruction& each) { return each.constant; });
  code.erase(first + 1, code.end());
  code.back().constant = engine::apply(added, values.data());
}

const QuantityName* quantity_of(ExpressionOwner owner, const std::string& word) {
  return owner == ExpressionOwner::kBend ? find_bend_quantity(word) : find_quantity(word);
}

/// The words of the quantities of an owner.
std::vector<std::string> quantity_words_of(ExpressionOwner owner) {
  std::vector<std::string> words;
  if (owner == ExpressionOwner::kBend) {
    for (const QuantityName& known : kBendQuantityNames) words.emplace_back(known.word);
    return words;
  }
  for (const QuantityName& known : kQuantityNames) words.emplace_back(known.word);
  words.emplace_back(kNormalForceWord);
  return words;
}

/// The reference of a word that names something outside the link; nothing when it names none.
std::optional<VariableReference> reference_of(const Expression& expression,
                                              const ExpressionWord& word,
                                              const ParameterValues& parameters,
                                              const AskedOutside& outside, ExpressionOwner owner) {
  const config::Place place = expression.place_of(word);
  if (word.kind == ExpressionWord::Kind::kOfAnother) {
    const std::size_t dot = word.name.rfind('.');
    return VariableReference{word.name.substr(0, dot), word.name.substr(dot + 1), word.state,
                             place};
  }
  const bool is_known = word.name == kTimeWord || outside.signals.contains(word.name);
  if (word.kind != ExpressionWord::Kind::kName || !is_known) return {};
  if (quantity_of(owner, word.name) != nullptr || parameters.find(word.name)) return {};
  return VariableReference{{}, word.name, {}, place};
}

}  // namespace

std::optional<CompiledExpression> compile(const Expression& expression, const std::string& what,
                                          const ParameterValues& parameters,
                                          std::uint32_t& next_slot, Problems& problems,
                                          AskedOutside* outside, ExpressionOwner owner) {
  CompiledExpression compiled;
  std::vector<Instruction>& code = compiled.program.code;
  const std::size_t errors_before = problems.error_count();
  for (const ExpressionWord& word : expression.words) {
    if (word.kind == ExpressionWord::Kind::kOperation) {
      add_operation(code, word.operation, next_slot);
      if (is_constant(code.back()) && !std::isfinite(code.back().constant)) {
        problems.error(expression.place_of(word), what + " has a part that is no finite number");
        return std::nullopt;
      }
      continue;
    }
    std::optional<VariableReference> reference;
    if (outside != nullptr) reference = reference_of(expression, word, parameters, *outside, owner);
    if (reference) {
      const auto slot = static_cast<std::uint32_t>(outside->references.size());
      code.push_back({Operation::kVariable, engine::Quantity::kDistance, 0.0, slot});
      outside->references.push_back(std::move(*reference));
      continue;
    }
    double number = word.number;
    if (word.kind == ExpressionWord::Kind::kOfAnother) {
      problems.error(expression.place_of(word), what + " cannot ask for '" + word.name + "'",
                     "a condition or a law of a liaison asks for what is outside its link");
    } else if (word.kind == ExpressionWord::Kind::kName) {
      if (const QuantityName* const known = quantity_of(owner, word.name)) {
        code.push_back({Operation::kQuantity, known->quantity, 0.0, 0});
        if (word.name == kNormalForceWord) {
          code.push_back({Operation::kNegate, engine::Quantity::kDistance, 0.0, 0});
          code.push_back({Operation::kConstant, engine::Quantity::kDistance, 0.0, 0});
          code.push_back({Operation::kMax, engine::Quantity::kDistance, 0.0, 0});
        }
        if (compiled.first == engine::Quantity::kNone) compiled.first = known->quantity;
        continue;
      }
      std::optional<double> value = parameters.find(word.name);
      if (!value && word.name == kPiWord) value = std::numbers::pi;
      if (!value) {
        std::vector<std::string> words = parameters.names();
        for (std::string& known : quantity_words_of(owner)) words.push_back(std::move(known));
        words.emplace_back(kPiWord);
        if (outside != nullptr) {
          words.insert(words.end(), outside->signals.begin(), outside->signals.end());
          words.emplace_back(kTimeWord);
        }
        std::string hint = config::did_you_mean(word.name, words);
        if (hint.empty() && owner == ExpressionOwner::kBend)
          hint = "a bend has angle_rad, bend_rad, speed_rad_per_s, moment_n_m, rest_rad, age_s";
        problems.error(expression.place_of(word),
                       what + " names '" + word.name + "', which is no quantity and no parameter",
                       hint);
      }
      number = value.value_or(1.0);
    }
    code.push_back({Operation::kConstant, engine::Quantity::kDistance, number, 0});
  }
  if (problems.error_count() == errors_before &&
      deepest_stack(compiled.program) > engine::kMaxStack) {
    problems.error(expression.text.place(), what + " is nested too deeply",
                   "write what is nested first: (a + b) * c instead of c * (a + b)");
  }
  static_assert(engine::kMaxSlots == 16);
  if (next_slot > engine::kMaxSlots) {
    problems.error(expression.text.place(), what + " is one of too many with rising and falling",
                   "the exits of a state have room for 16 of them");
  }
  if (problems.error_count() != errors_before) return std::nullopt;
  return compiled;
}

namespace {

/// True if a law may ask for a quantity.
bool is_known_to_laws_of(ExpressionOwner owner, engine::Quantity quantity) {
  if (owner == ExpressionOwner::kLink) return engine::is_known_to_laws(quantity);
  return quantity == engine::Quantity::kBend || quantity == engine::Quantity::kAngularSpeed;
}

/// A quantity of either owner; nullptr where the word is none.
const QuantityName* any_quantity(ExpressionOwner owner, const std::string& word) {
  const QuantityName* const own = quantity_of(owner, word);
  return own != nullptr || owner == ExpressionOwner::kLink ? own : find_quantity(word);
}

/// Puts the quantities of a bend to those of laws.
void put_to_quantities_of_laws(engine::Program& program) {
  for (Instruction& instruction : program.code) {
    if (instruction.operation != Operation::kQuantity) continue;
    instruction.quantity = instruction.quantity == engine::Quantity::kBend
                               ? engine::Quantity::kElongation
                               : engine::Quantity::kSpeed;
  }
  // A factor times a quantity would be read as a stiffness or a viscosity of a bend, which is not linear in it. What
  // is negated twice has the same bits.
  const engine::Expression law{program};
  if (law.factor_size(engine::Quantity::kElongation) + law.factor_size(engine::Quantity::kSpeed) >
      0)
    program.code.insert(program.code.end(), 2, {Operation::kNegate, {}, 0.0, 0});
}

}  // namespace

std::optional<engine::Program> compile_law(const Value& text, const std::string& what,
                                           const ParameterValues& parameters, AskedOutside& outside,
                                           Problems& problems, ExpressionOwner owner) {
  const std::optional<Expression> expression = parse_expression(text, what, problems);
  if (!expression) return std::nullopt;
  if (expression->is_truth) {
    problems.error(text.place(), what + " must be a number, got a comparison",
                   "write if(..., 1, 0)");
    return std::nullopt;
  }
  bool is_law = true;
  for (const ExpressionWord& word : expression->words) {
    const QuantityName* const known =
        word.kind == ExpressionWord::Kind::kName ? any_quantity(owner, word.name) : nullptr;
    const bool has_edge =
        word.kind == ExpressionWord::Kind::kOperation && engine::is_edge(word.operation);
    if (!has_edge && (known == nullptr || is_known_to_laws_of(owner, known->quantity))) continue;
    problems.error(
        expression->place_of(word),
        what + " cannot ask for '" + (has_edge ? "rising' or 'falling" : word.name) + "'",
        owner == ExpressionOwner::kBend
            ? "it may ask for bend_rad, the angle beyond the rest angle, and speed_rad_per_s"
            : "it may ask for distance_m, elongation_m, speed_m_per_s, mass_a_kg, mass_b_kg");
    is_law = false;
  }
  if (!is_law && owner == ExpressionOwner::kBend) return std::nullopt;
  std::uint32_t slots = 0;
  std::optional<CompiledExpression> compiled =
      compile(*expression, what, parameters, slots, problems, &outside, owner);
  if (!compiled || !is_law) return std::nullopt;
  if (owner == ExpressionOwner::kBend) put_to_quantities_of_laws(compiled->program);
  return std::move(compiled->program);
}

namespace {

/// The value of a formula of parameters and of what is outside the link.
/// @param outside  nullptr: nothing there may be asked for, and the formula is a number
std::optional<ChangingNumber> evaluate_changing(const Value& value, const std::string& what,
                                                const ParameterValues& parameters,
                                                AskedOutside* outside, Problems& problems) {
  const std::optional<Expression> expression = parse_expression(value, what, problems);
  if (!expression) return std::nullopt;
  for (const ExpressionWord& word : expression->words) {
    if (word.kind != ExpressionWord::Kind::kName) continue;
    const bool is_of_bend =
        find_bend_quantity(word.name) != nullptr && !parameters.find(word.name).has_value();
    if (find_quantity(word.name) != nullptr || is_of_bend) {
      problems.error(expression->place_of(word),
                     what + " is fixed before the run and cannot ask for '" + word.name + "'");
      return std::nullopt;
    }
  }
  std::uint32_t slots = 0;
  std::optional<CompiledExpression> compiled =
      compile(*expression, what, parameters, slots, problems, outside);
  if (!compiled) return std::nullopt;
  if (expression->is_truth || slots > 0) {
    problems.error(value.place(), what + " must be a number, got a comparison");
    return std::nullopt;
  }
  const Instruction& first = compiled->program.code.front();
  if (compiled->program.code.size() == 1 && is_constant(first))
    return ChangingNumber{first.constant, {}};
  return ChangingNumber{0.0, std::move(compiled->program)};
}

/// The value of a formula of parameters alone.
std::optional<double> evaluate(const Value& value, const std::string& what,
                               const ParameterValues& parameters, Problems& problems) {
  const std::optional<ChangingNumber> changing =
      evaluate_changing(value, what, parameters, nullptr, problems);
  if (!changing) return std::nullopt;
  return changing->number;
}

}  // namespace

/// Puts parameters to values, each after those it names.
struct ParameterValues::Evaluation {
  const Value& section;
  const std::map<std::string, double>& overrides;
  const std::string& what;
  Problems& problems;
  ParameterValues& result;
  std::vector<std::string> open{};  // parameters whose formulas are being followed

  void put(const Value::Entry& entry) {
    if (result.values_.count(entry.key) != 0) return;
    const std::string name = "parameter '" + entry.key + "' of " + what;
    if (const auto known = overrides.find(entry.key); known != overrides.end()) {
      result.values_[entry.key] = known->second;
      return;
    }
    if (is_plain_number(entry.value)) {
      result.values_[entry.key] = config::read_number(entry.value, name, 1.0, {}, problems);
      return;
    }
    const std::optional<Expression> formula = parse_expression(entry.value, name, problems);
    result.values_[entry.key] = 1.0;  // so that nothing follows from a problem
    if (!formula) return;
    result.values_.erase(entry.key);
    if (!put_names(entry, *formula)) {
      result.values_[entry.key] = 1.0;
      return;
    }
    result.values_[entry.key] = evaluate(entry.value, name, result, problems).value_or(1.0);
  }

  /// The parameters that a formula names. @return false when it names itself in the end.
  bool put_names(const Value::Entry& entry, const Expression& formula) {
    if (open.size() >= kMaxOpen) {
      problems.error(entry.value.place(),
                     "more than " + std::to_string(kMaxOpen) + " parameters of " + what +
                         " each depend on the next, down to '" + entry.key + "'");
      return false;
    }
    open.push_back(entry.key);
    bool sound = true;
    for (const ExpressionWord& word : formula.words) {
      if (word.kind != ExpressionWord::Kind::kName) continue;
      const auto& entries = section.entries();
      const auto named = std::find_if(entries.begin(), entries.end(),
                                      [&](const auto& other) { return other.key == word.name; });
      if (named == entries.end()) continue;
      const auto cycle = std::find(open.begin(), open.end(), word.name);
      if (cycle == open.end()) {
        put(*named);
        continue;
      }
      std::string circle;
      for (auto name = cycle; name != open.end(); ++name) circle += *name + " -> ";
      problems.error(formula.place_of(word),
                     "parameter '" + entry.key + "' of " + what + " depends on itself",
                     circle + word.name);
      sound = false;
    }
    open.pop_back();
    return sound;
  }
};

ParameterValues::ParameterValues(const Value& section,
                                 const std::map<std::string, double>& overrides,
                                 const ParameterValues* outer, const std::string& what,
                                 Problems& problems)
    : outer_(outer) {
  if (section.exists() && section.kind() != Value::Kind::kMapping) {
    problems.error(section.place(), "'parameters' in " + what + " must be a mapping of keys, got " +
                                        section.described());
  }
  if (section.entries().size() > kMaxParameters) {
    problems.error(section.place(), "'parameters' in " + what + " has more than " +
                                        std::to_string(kMaxParameters) + " parameters");
    return;
  }
  for (const Value::Entry& entry : section.entries()) {
    if (!is_free_name(entry.key)) {
      problems.error(entry.key_place, "'" + entry.key + "' cannot be the name of a parameter",
                     find_quantity(entry.key) != nullptr ? "it is a quantity of the link" : "");
    }
  }
  Evaluation evaluation{section, overrides, what, problems, *this};
  for (const Value::Entry& entry : section.entries()) evaluation.put(entry);
  for (const Value::Entry& entry : section.entries()) names_.push_back(entry.key);
}

std::optional<double> ParameterValues::find(const std::string& name) const {
  const auto known = values_.find(name);
  if (known == values_.end()) return outer_ != nullptr ? outer_->find(name) : std::nullopt;
  used_.push_back(name);
  return known->second;
}

std::vector<std::string> ParameterValues::names() const {
  std::vector<std::string> names = names_;
  if (outer_ != nullptr) {
    const std::vector<std::string> others = outer_->names();
    names.insert(names.end(), others.begin(), others.end());
  }
  return names;
}

std::vector<std::string> ParameterValues::unused() const {
  std::vector<std::string> unused;
  for (const std::string& name : names_) {
    if (std::find(used_.begin(), used_.end(), name) == used_.end()) unused.push_back(name);
  }
  return unused;
}

void ParameterValues::warn_of_unused(const Value& section, const std::string& what,
                                     Problems& problems) const {
  for (const std::string& name : unused()) {
    problems.warning(section.find(name).place(),
                     "parameter '" + name + "' of " + what + " is used nowhere");
  }
}

bool is_plain_number(const Value& value) {
  if (value.kind() != Value::Kind::kScalar) return true;
  if (value.quoted()) return false;
  Problems of_number;
  config::read_number(value, "", 0.0, {}, of_number);
  if (!of_number.has_errors()) return true;
  const config::Problem& problem = of_number.all().front();
  if (problem.message.find("must be a number") == std::string::npos) return true;
  if (problem.hint == config::kNoFormula) return false;
  Problems of_formula;
  return !problem.hint.empty() && !parse_expression(value, "", of_formula);
}

double read_formula(const Value& value, const std::string& what, double fallback, Range range,
                    const ParameterValues& parameters, Problems& problems) {
  if (is_plain_number(value)) return config::read_number(value, what, fallback, range, problems);
  const std::optional<double> number = evaluate(value, what, parameters, problems);
  if (!number) return fallback;
  const Value as_written = Value::scalar(config::number_text(*number), value.place());
  return config::read_number(as_written, what, fallback, range, problems);
}

engine::Program product_of(engine::Program program, engine::Quantity quantity) {
  program.code.push_back({Operation::kQuantity, quantity, 0.0, 0});
  program.code.push_back({Operation::kMultiply, {}, 0.0, 0});
  return program;
}

bool asks_outside(const Value& value, const ParameterValues& parameters,
                  const std::set<std::string>& signals) {
  if (!value.exists() || is_plain_number(value)) return false;
  Problems scratch;
  const std::optional<Expression> expression = parse_expression(value, "", scratch);
  if (!expression) return false;
  std::vector<VariableReference> references;
  const AskedOutside outside{signals, references};
  return std::ranges::any_of(expression->words, [&](const ExpressionWord& word) {
    return reference_of(*expression, word, parameters, outside, ExpressionOwner::kLink).has_value();
  });
}

ChangingNumber optional_changing(config::MappingReader& reader, const std::string& key,
                                 double fallback, Range range, const ParameterValues& parameters,
                                 AskedOutside& outside, Problems& problems) {
  const Value value = reader.optional_value(key);
  if (!value.exists() || is_plain_number(value))
    return {optional_formula(reader, key, fallback, range, parameters, problems), {}};
  if (config::KeyLog* const log = config::KeyLog::current())
    log->add({key, config::KeyKind::kFormula, false, range, {}, 0, {}, reader.place()});
  const std::string what = "'" + key + "' in " + reader.what();
  std::optional<ChangingNumber> changing =
      evaluate_changing(value, what, parameters, &outside, problems);
  if (!changing) return {fallback, {}};
  if (changing->changes()) return std::move(*changing);
  const Value as_written = Value::scalar(config::number_text(changing->number), value.place());
  return {config::read_number(as_written, what, fallback, range, problems), {}};
}

double optional_formula(config::MappingReader& reader, const std::string& key, double fallback,
                        Range range, const ParameterValues& parameters, Problems& problems) {
  const Value value = reader.optional_value(key);
  if (config::KeyLog* const log = config::KeyLog::current())
    log->add({key, config::KeyKind::kFormula, false, range, {}, 0, {}, reader.place()});
  if (!value.exists()) return fallback;
  return read_formula(value, "'" + key + "' in " + reader.what(), fallback, range, parameters,
                      problems);
}

double required_formula(config::MappingReader& reader, const std::string& key, Range range,
                        const ParameterValues& parameters, Problems& problems) {
  reader.required_value(key);
  return optional_formula(reader, key, range.lowest_excluded ? 1.0 : 0.0, range, parameters,
                          problems);
}

}  // namespace cordis::scene
