// sim_node/plan/stability/stretch.h -- how far energy and forces stretch a state.
#pragma once

#include "sim_node/engine/description/state_machine.h"
#include "sim_node/plan/stability/reach.h"

namespace cordis::plan {

/// How far a state may be from its rest length, either way.
struct Stretch {
  double longer = 0.0;   ///< [m]
  double shorter = 0.0;  ///< [m]
  bool confined = true;  ///< its tension takes up all that the scene has, both ways
};

/// Where the tension of a state, summed up, has taken the energy of the reach and what forces that last bring in
/// on the way: twice the way, for they may turn about. A way that nothing takes up is the length of the start.
/// @param turns  its distance has no sign, and so it is not shorter than to length 0
Stretch stretch_within(const engine::LinkState& state, double rest_length, bool turns,
                       const Reach& reach);

/// The elongations that a state may have by the same account [m], within its limits; infinite where it does not act, or
/// where a port holds an end.
Interval elongations_within(const engine::LinkState& state, double rest_length, const Reach& reach);

}  // namespace cordis::plan
