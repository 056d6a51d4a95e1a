// sim_node/scene/sections/fields.h -- gravity and flow that change in time: `world`.
#pragma once

#include <optional>

#include "sim_node/scene/language/named_formula.h"
#include "sim_node/scene/scene.h"

namespace cordis::scene {

/// What pushes the masses of a scene by formulas of time.
struct WorldFields {
  std::optional<AxisFormulas> gravity;  ///< [m/s^2]; nothing where it is constant
  std::optional<AxisFormulas> flow;     ///< velocity of the medium [m/s]; nothing where it rests
  config::Place flow_place;             ///< where it is written
};

/// Reads `world`. What is constant goes into the network of the scene.
WorldFields read_world(const config::Value& section, Scene& scene, config::Problems& problems);

/// Pushes each mass with m g(t) + Z u(t), Z being the viscosity of the medium on it, beside what pushes it
/// already. A flow without viscosity is a problem. Precondition: all MATs are there.
void add_fields(const WorldFields& fields, Scene& scene, config::Problems& problems);

}  // namespace cordis::scene
