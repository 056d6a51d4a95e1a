// sim_node/scene/language/named_formula.h -- formulas that ask for time or for places.
#pragma once

#include <array>
#include <span>
#include <string>

#include "sim_node/scene/language/formula.h"
#include "sim_node/scene/language/quantity.h"

namespace cordis::scene {

/// A name that a formula may ask for, and the quantity of a link whose place it takes in the program.
struct FormulaName {
  const char* word;
  engine::Quantity place;
};

/// What a formula of time may ask for: the time since step 0.
inline constexpr std::array<FormulaName, 1> kNamesOfTime{{{kTimeWord, engine::Quantity::kAge}}};

/// A vector, a formula for each axis. An empty one is 0.
using AxisFormulas = std::array<engine::Program, 3>;

/// True if a value is a formula, or a list of numbers and formulas with a formula among them.
bool has_formula(const config::Value& value);

/// A formula that may ask for these names, for pi and for parameters. Whatever is wrong is a problem of its
/// place; the program is empty then.
/// @param outside  what it may ask for besides; nullptr: nothing
engine::Program read_named_formula(const config::Value& text, const std::string& what,
                                   std::span<const FormulaName> names,
                                   const ParameterValues& parameters, config::Problems& problems,
                                   AskedOutside* outside = nullptr);

/// The formulas of a vector of `space` components, in 1-D one formula, likewise.
/// @param or_else  what the value may be besides, for the message of a wrong length: ", or a table"
AxisFormulas read_axis_formulas(const config::Value& value, const std::string& what, int space,
                                std::span<const FormulaName> names,
                                const ParameterValues& parameters, const std::string& or_else,
                                config::Problems& problems, AskedOutside* outside = nullptr);

/// Parameters of such formulas: one that is called as a name or pi is a problem.
ParameterValues read_formula_parameters(config::MappingReader& reader,
                                        std::span<const FormulaName> names,
                                        const std::string& formulas, config::Problems& problems);

}  // namespace cordis::scene
