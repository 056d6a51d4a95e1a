// sim_node/plan/stability/meeting_exit.h -- where exits end a state.
#pragma once

#include <cstddef>

#include "sim_node/engine/description/state_machine.h"
#include "sim_node/plan/stability/reach.h"

namespace cordis::plan {

/// True if an exit of a state can come true where the ends of the liaison meet, at any speed of the
/// reach. Age and impulse may be anything: they say nothing of where the ends are. Never where a
/// condition of the liaison asks for variables of other things, which may hold it anywhere.
bool may_end_where_ends_meet(const engine::StateMachine& state_machine, std::size_t state,
                             double rest_length, const Reach& reach);

/// The elongation from which on, up to `highest`, a state exerts no force, whatever the rest length. There an exit to
/// another state surely holds in every step, before the force is found, and none that may hold leads to the state.
/// `highest` where nothing is sure. O(exits), some dozen enclosures. Precondition: no exit moves the rest length.
/// @param highest      the largest elongation that a pair can have [m]
/// @param rest_length  any of a pair [m]
double last_elongation_of(const engine::StateMachine& state_machine, std::size_t state,
                          double highest, double rest_length, const Reach& reach);

}  // namespace cordis::plan
