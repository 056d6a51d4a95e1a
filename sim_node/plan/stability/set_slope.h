// sim_node/plan/stability/set_slope.h -- the largest slope of the pairs of a set.
#pragma once

#include <cstdint>
#include <vector>

#include "sim_node/engine/description/network.h"
#include "sim_node/plan/stability/reach.h"
#include "sim_node/plan/stability/slope.h"
#include "sim_node/plan/stability/start_pairs.h"

namespace cordis::plan {

/// A set at the start, and how far its pairs may go from there.
struct SetStart {
  Reach reach;               ///< reach of its pairs, with what the pair stores that stores the most
  double rest_length = 0.0;  ///< the least of a pair [m]
  double across = 0.0;       ///< the largest stiffness across a pair at the start [N/m]
  double fall = 0.0;    ///< what the potential of a pair may fall by; infinite without an end [J]
  double stored = 0.0;  ///< by all pairs [J]
  bool are_balls = false;             ///< Lennard-Jones in the state of the start
  bool is_known = true;               ///< false: the pairs are too many to look at
  bool all_begin_within = false;      ///< every pair is within range
  const char* uncertainty = nullptr;  ///< why a pair keeps every step from being certain
};

/// O(members + pairs). @param reach  of the network
SetStart set_start_of(const engine::NetworkDescription& network, const engine::SetLiaison& set,
                      const Reach& reach);

/// The largest slope of a pair, along or across, with friction.
Slope largest_slope_of(const engine::NetworkDescription& network, const engine::SetLiaison& set,
                       const SetStart& start);

/// The stiffness across a liaison at one point of its start [N/m]: its tension over its length. The largest
/// slope of one with several states has none, because exits end a state that pulls before the ends meet.
double stiffness_across_at(const engine::StateMachine& state_machine, int dimension,
                           const engine::LawPoint& start);

/// The largest distance from the surfaces of a set at which a normal flips [m]; -infinity: none does.
double flips_at(const engine::NetworkDescription& network, const engine::SetLiaison& set);

/// True if every pair of a set is within range.
bool all_begin_within(const engine::SetLiaison& set, const StartPairs& near);

/// The smallest rest length of a pair of a set [m].
double smallest_rest_of(const engine::NetworkDescription& network, const engine::SetLiaison& set);

/// The smallest radius of some MATs [m].
double smallest_radius(const engine::NetworkDescription& network,
                       const std::vector<std::uint32_t>& mats);

}  // namespace cordis::plan
