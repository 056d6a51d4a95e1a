// sim_node/plan/stability/entry.h -- how stretched a state may be where an exit enters it.
#pragma once

#include <vector>

#include "sim_node/engine/description/state_machine.h"
#include "sim_node/plan/stability/reach.h"

namespace cordis::plan {

/// How a state may begin.
struct Entry {
  bool by_a_change = false;  ///< an exit leads to it
  /// The most energy that its law has there, beyond what the scene has [J]; infinite: it may begin anywhere.
  double brought = 0.0;
};

/// One of each state. An exit that keeps the rest length leads to where its condition begins to hold, or to wherever the
/// state before may be: as far as its own law lets it, or as far as that was entered. Only the first entry of
/// each state counts: what brings in more in every round may begin anywhere. Found where a power asks for it; 0 elsewhere.
/// O(states^2 samples).
std::vector<Entry> entries_of(const engine::StateMachine& state_machine, double rest_length,
                              const Reach& reach);

}  // namespace cordis::plan
