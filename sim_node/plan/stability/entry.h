// sim_node/plan/stability/entry.h -- what the changes of state of a liaison bring in.
#pragma once

#include <vector>

#include "sim_node/engine/description/state_machine.h"
#include "sim_node/plan/stability/reach.h"

namespace cordis::plan {

/// How a state may begin.
struct Entry {
  bool by_a_change = false;  ///< an exit leads to it
  /// The most energy that the changes of state on a way to it bring into the scene [J], 0 or more; infinite: nothing
  /// bounds it.
  double brought = 0.0;
};

/// One of each state. A change brings in what the new state may give where it begins, less what the state before
/// still had there. A state gives what its potential may fall by, as far as it goes. An exit that keeps the rest
/// length leads to where its condition comes true, by intervals over the elongation at any speed, or to wherever
/// the state before may be. States that enter each other with more energy in every round bring in energy without
/// an end. Where the force jumps at a threshold, it counts a step farther.
/// O(states^2 samples), some thousand enclosures for each exit.
/// @param rest_length  at the start [m]; of a set, that of its nearest pair
/// @param possible     the elongations that it can have [m]; where one end is infinite, at its first rest length alone
std::vector<Entry> entries_of(const engine::StateMachine& state_machine, double rest_length,
                              const Interval& possible, const Reach& reach);

/// The elongations of a link [m]: where its distance has no sign it is not shorter than to length 0.
Interval possible_elongations(double rest_length, bool turns) noexcept;

}  // namespace cordis::plan
