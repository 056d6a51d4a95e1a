// sim_node/plan/stability/meeting_exit.h -- whether a state ends before its ends meet.
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

}  // namespace cordis::plan
