// sim_node/scene/liaisons/law.h -- elasticity and dissipation that are not linear, as a scene
// writes them.
#pragma once

#include <vector>

#include "sim_node/engine/description/state_machine.h"
#include "sim_node/scene/language/formula.h"

namespace cordis::scene {

/// Reads the key `elasticity` of a state, a law over elongation or distance; no law when absent.
/// The language is described in docs/language.md.
/// @param formulas  those of its fields are added
/// @param owner     of a bend: a moment over the bend
engine::Law read_elasticity(config::MappingReader& reader, const ParameterValues& parameters,
                            AskedOutside& outside, config::Problems& problems,
                            std::vector<engine::ParameterFormula>& formulas,
                            ExpressionOwner owner = ExpressionOwner::kLink);

/// Reads the key `dissipation`, a law over the speed.
engine::Law read_dissipation(config::MappingReader& reader, const ParameterValues& parameters,
                             AskedOutside& outside, config::Problems& problems,
                             ExpressionOwner owner = ExpressionOwner::kLink);

}  // namespace cordis::scene
