// sim_node/plan/stability/force_slopes.h -- how stiff and how viscous a driven force can become.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "sim_node/engine/description/network.h"
#include "sim_node/plan/stability/program_enclosure.h"

namespace cordis::plan {

/// The largest slopes of a driven force at any place and velocity, and at any value of what it asks for.
struct ForceSlopes {
  double stiffness = 0.0;      ///< [N/m]
  double viscosity = 0.0;      ///< [N s/m]
  double variation = 0.0;      ///< by how much the slope over the place varies [N/m]
  bool brings_energy = false;  ///< it is more than a drag on what moves
  std::string uncertainty;     ///< why nothing bounds it; empty: something does
  /// What it asks for, where that is why: indices in NetworkDescription::variables.
  std::vector<std::uint32_t> variables = {};
};

/// True if no motion of a mass changes the values of a function: it asks for no place and no velocity of its MAT, and
/// of variables for those of time, of states, and of where a port or a fixed point is. O(instructions).
bool is_given(const engine::NetworkDescription& network, const engine::TimeFunction& function);

/// The slopes of the forces of a network. Those of equal formulas, whose variables lie within the same numbers, are
/// searched once.
class SlopesOfForces {
 public:
  /// Keeps a reference to the network.
  explicit SlopesOfForces(const engine::NetworkDescription& network);

  /// By interval arithmetic on the formulas of a force, with places and velocities up to 1e9. What a force does
  /// on closed ways and far away is sampled. O(instructions), some thousand enclosures where it is new.
  /// A function of time alone has no slopes. Precondition: one of the network.
  ForceSlopes of(const engine::TimeFunction& function);

 private:
  const engine::NetworkDescription& network_;
  std::vector<Interval> ranges_;  // of the variables of the network
  std::map<std::vector<std::uint64_t>, ForceSlopes>
      known_;  // their variables are inputs of a field
};

}  // namespace cordis::plan
