// tests/bench/bench_scenes.h -- networks that more than one benchmark steps.
#pragma once

#include <cstdint>
#include <memory>

#include "sim_node/engine/description/network.h"

namespace cordis::bench {

/// The melt of LAMMPS' bench/in.lj: 4 x cells^3 balls of mass 1 on an fcc lattice of density 0.8442,
/// Lennard-Jones with cut 2.5, dt 0.005, velocities of a temperature. There it fills a periodic
/// box; here it is a drop in free space, and the balls at its surface have fewer neighbours, so the
/// counter `pairs_per_ball` stands beside the time (27.6 in the bulk).
std::shared_ptr<const engine::Network> melt(int cells = 20, double temperature = 1.44);

/// Balls in a square or cubic lattice, pressed into their neighbours, that move: contacts which push, with
/// viscosity. Those at the edge are fixed.
/// @param balls  as many at least, in a square or a cube
std::shared_ptr<const engine::Network> pack(int dimension, std::uint32_t balls);

/// Numbers the MATs of a network in another order, so that its links fit in no run.
engine::NetworkDescription with_shuffled_mats(engine::NetworkDescription network);

/// What the links of a net are.
enum LinkKind : int {
  kLinear = 0,
  kConditions = 1,     ///< two states with one condition each; few links change
  kManyChange = 2,     ///< every link changes every tenth step or so
  kTableOfForces = 3,  ///< conditions, and an elasticity given as a table
  kMixed = 4,          ///< conditions; neighbouring links are in different states
  kExpression = 5,     ///< one state, whose law is an expression of ten operations
  kFunctions = 6,      ///< one state, whose law is an expression with exp and tanh
};

/// A square net of side x side masses, each linked to its right and its upper neighbour.
std::shared_ptr<const engine::Network> net_of_links(int dimension, LinkKind kind,
                                                    std::uint32_t side);

}  // namespace cordis::bench
