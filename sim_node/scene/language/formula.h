// sim_node/scene/language/formula.h -- parameters, and expressions with their names put to values.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "node/config/mapping_reader.h"
#include "sim_node/engine/laws/law.h"
#include "sim_node/scene/language/expression.h"

namespace cordis::scene {

/// The named parameters of a liaison, put to values. A parameter is a number, or a formula of other
/// parameters in any order.
class ParameterValues {
 public:
  ParameterValues() = default;
  /// @param section    the mapping `parameters` of the liaison; need not exist
  /// @param overrides  values that stand for those of the section
  /// @param outer      parameters that formulas may name besides; nullptr when there are none
  /// @param what       names the liaison in messages
  ParameterValues(const config::Value& section, const std::map<std::string, double>& overrides,
                  const ParameterValues* outer, const std::string& what,
                  config::Problems& problems);

  /// Nothing when there is none of that name.
  std::optional<double> find(const std::string& name) const;
  std::vector<std::string> names() const;  ///< all names, those outside included
  /// Names of the section that find() was never asked for.
  std::vector<std::string> unused() const;
  /// Warns of each of these. @param section  as above
  void warn_of_unused(const config::Value& section, const std::string& what,
                      config::Problems& problems) const;

 private:
  struct Evaluation;

  std::map<std::string, double> values_;
  std::vector<std::string> names_;  // of the section, in the order of the file
  const ParameterValues* outer_ = nullptr;
  mutable std::vector<std::string> used_;
};

/// True if a value is read as a number rather than as a formula: it is one, or the message about a
/// wrong number fits it best (.nan, 3 N, a sequence).
bool is_plain_number(const config::Value& value);

/// A number of a liaison: written plainly, or a formula of parameters. It must be finite and within
/// the range; a problem and the fallback otherwise.
double read_formula(const config::Value& value, const std::string& what, double fallback,
                    config::Range range, const ParameterValues& parameters,
                    config::Problems& problems);

/// Reads a key of a mapping likewise; gives the fallback when the key is absent.
double optional_formula(config::MappingReader& reader, const std::string& key, double fallback,
                        config::Range range, const ParameterValues& parameters,
                        config::Problems& problems);
double required_formula(config::MappingReader& reader, const std::string& key, config::Range range,
                        const ParameterValues& parameters, config::Problems& problems);

/// What a condition or a law asks for outside its link, by name: whose it is shows where the link stands.
struct VariableReference {
  std::string owner;  ///< selection of one MAT, port or link; empty: of the scene
  std::string word;   ///< quantity with its axis and unit, time_s, or the name of a signal
  std::string state;  ///< not empty: the number of this state of the link is meant
  config::Place place;
};

/// What a condition or a law may ask for outside its link.
struct AskedOutside {
  const std::set<std::string>& signals;  ///< names of those of the scene
  std::vector<VariableReference>&
      references;  ///< references of the liaison; Instruction::slot is a place here
};

/// Whose quantities an expression asks for.
enum class ExpressionOwner { kLink, kBend };

/// A condition or a formula over the quantities of a link, for the engine.
struct CompiledExpression {
  engine::Program program;
  engine::Quantity first = engine::Quantity::kNone;  ///< the first quantity it names
};

/// Puts the names of an expression to quantities and values, and folds what is constant. Whatever
/// is wrong is a problem of its place.
/// @param next_slot  of the next `rising` or `falling`; moved on
/// @param outside    of a condition or a law; nullptr where nothing outside the link may be asked for
std::optional<CompiledExpression> compile(const Expression& expression, const std::string& what,
                                          const ParameterValues& parameters,
                                          std::uint32_t& next_slot, config::Problems& problems,
                                          AskedOutside* outside = nullptr,
                                          ExpressionOwner owner = ExpressionOwner::kLink);

/// A law: a tension [N] over distance_m, elongation_m, speed_m_per_s, mass_a_kg, mass_b_kg, the
/// parameters and what is outside the link. Of a bend a moment [N m] over bend_rad and speed_rad_per_s, which
/// the program asks for as elongation and speed. Whatever is wrong is a problem of its place.
std::optional<engine::Program> compile_law(const config::Value& text, const std::string& what,
                                           const ParameterValues& parameters, AskedOutside& outside,
                                           config::Problems& problems,
                                           ExpressionOwner owner = ExpressionOwner::kLink);

/// A number of a liaison, or a formula whose value changes while a run goes on.
struct ChangingNumber {
  double number = 0.0;
  engine::Program program;  ///< not empty: the formula; it asks for nothing of the link

  bool changes() const noexcept { return !program.empty(); }
};

/// A program times a quantity: a stiffness times the elongation, a viscosity times the speed.
engine::Program product_of(engine::Program program, engine::Quantity quantity);

/// True if a value is a formula that asks for something outside the link.
bool asks_outside(const config::Value& value, const ParameterValues& parameters,
                  const std::set<std::string>& signals);

/// Reads a key as optional_formula() does, or a formula that asks for something outside the link. A formula that
/// changes is held to no range.
ChangingNumber optional_changing(config::MappingReader& reader, const std::string& key,
                                 double fallback, config::Range range,
                                 const ParameterValues& parameters, AskedOutside& outside,
                                 config::Problems& problems);

}  // namespace cordis::scene
