// sim_node/plan/stability/slope_fall.h -- how far a law bends over.
#pragma once

#include "sim_node/engine/description/state_machine.h"
#include "sim_node/plan/stability/reach.h"

namespace cordis::plan {

/// By how much the slope of a state falls along its liaison, the way its force grows or holds [N/m]: 0 for a spring
/// and for what only becomes stiffer. A force limit and a table fall to 0 at their ends. Lennard-Jones and rings
/// count for nothing before their force limit. An expression that asks for variables is looked at with three values of each.
/// O(1), about 1000 tensions. Measured growth by it: docs/stability.md.
/// @param within   elongations at which it is looked at [m]; infinite: up to 1000 times the reach
/// @param largest  slope of the state, for the fall at its force limit [N/m]
double slope_fall(const engine::LinkState& state, double rest_length, const Interval& within,
                  double largest, const Reach& reach);

}  // namespace cordis::plan
