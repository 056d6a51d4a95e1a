// sim_node/scene/liaisons/diagnostics.h -- state machines that can be simulated, but hardly as they
// were meant.
#pragma once

#include "sim_node/scene/liaisons/state_machine.h"

namespace cordis::scene {

/// Reports a state that no exit leads to (an error), and warns of
/// - a state that acts, is not `final`, and has no exit;
/// - a condition that always or never holds;
/// - an exit that holds at the moment its state is entered: the link would change again in the next
///   step, whatever the length of a step is, and the outcome would depend on that length. Seen by
///   trying entries of many links whose ends move slowly: the speed is 0 unless the condition of
///   the entry asks for one.
/// @param is_of_bend  then no entries are tried
/// @param what  names the liaison in messages
void diagnose(const engine::StateMachine& state_machine, const StateMachinePlaces& places,
              bool is_of_bend, const std::string& what, config::Problems& problems);

}  // namespace cordis::scene
