// sim_node/engine/description/driving_law.h -- which liaisons may bring in energy by their laws.
#pragma once

#include "sim_node/engine/description/state_machine.h"

namespace cordis::engine {

/// True if a state may bring in more energy than it has stored and taken. Such are an expression that
/// asks for the speed, and a dissipation that may push along. O(states).
bool may_drive(const StateMachine& state_machine) noexcept;

}  // namespace cordis::engine
