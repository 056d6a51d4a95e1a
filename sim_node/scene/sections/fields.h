// sim_node/scene/sections/fields.h -- gravity, viscosity and flow that change: `world`.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "sim_node/scene/language/named_formula.h"
#include "sim_node/scene/sections/assembly.h"

namespace cordis::scene {

/// What pushes the masses of a scene by formulas of time and of what conditions ask for.
struct WorldFields {
  std::optional<AxisFormulas> gravity;  ///< [m/s^2]; nothing where it is constant
  std::optional<AxisFormulas> flow;     ///< velocity of the medium [m/s]; nothing where it rests
  engine::Program viscosity;      ///< viscosity of the medium [N s/m]; empty where it is constant
  config::Place flow_place;       ///< where it is written
  config::Place viscosity_place;  ///< likewise
  /// What they ask for by name; Instruction::slot of their programs is a place here.
  std::vector<VariableReference> references;
};

/// Reads `world`. What is constant goes into the network of the scene.
/// @param signals  names of those of the scene
WorldFields read_world(const config::Value& section, const std::set<std::string>& signals,
                       Scene& scene, config::Problems& problems);

/// Pushes each mass with m g + Z u, Z being the viscosity of the medium on it, beside what pushes it
/// already. Where that is a formula, with m g + Z (u - v), v the velocity that dampers see. A flow without
/// viscosity is a problem. Precondition: all MATs are there.
void add_fields(const WorldFields& fields, Assembly& assembly);

}  // namespace cordis::scene
