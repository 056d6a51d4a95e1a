// sim_node/plan/stability/energy_share.h -- the energy of a scene that may come to one mass.
#pragma once

#include <vector>

#include "sim_node/engine/description/network.h"

namespace cordis::plan {

/// What liaisons may lead to one mass.
struct EnergyShare {
  /// What the two bodies have that have the most, of masses that links join: kinetic and by falling [J].
  double of_bodies = 0.0;
  double stored = 0.0;  ///< [J]
  double struck = 0.0;  ///< what a port or driven matter may give to a body: twice its speed [J]
};

/// The share of each MAT: of all masses that links join with it, and pairs of sets, directly or by others. What is no
/// mass joins nothing, so that balls which only touch walls have their own energy alone. O(MATs and liaisons).
/// Allocates.
/// @param stored      in the liaisons at each MAT, each counted at one of its ends [J]
/// @param port_speed  of ports and driven matter [m/s]
std::vector<EnergyShare> energy_shares(const engine::NetworkDescription& network,
                                       const std::vector<double>& stored, double port_speed);

}  // namespace cordis::plan
