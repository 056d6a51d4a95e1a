// sim_node/plan/stability/force_slopes.h -- how stiff and how viscous a driven force can become.
#pragma once

#include <string>

#include "sim_node/engine/description/network.h"

namespace cordis::plan {

/// The largest slopes of a driven force at any place and velocity, and at any value of what it asks for.
struct ForceSlopes {
  double stiffness = 0.0;      ///< [N/m]
  double viscosity = 0.0;      ///< [N s/m]
  double variation = 0.0;      ///< by how much the slope over the place varies [N/m]
  bool brings_energy = false;  ///< it is more than a drag on what moves
  std::string uncertainty;     ///< why nothing bounds it; empty: something does
};

/// By interval arithmetic on the formulas of a force, with places and velocities up to 1e9. What a force does
/// on closed ways and far away is sampled. O(instructions), some thousand enclosures.
/// A function of time alone has no slopes. Precondition: one of the network.
ForceSlopes slopes_of_force(const engine::NetworkDescription& network,
                            const engine::TimeFunction& function);

}  // namespace cordis::plan
