// sim_node/plan/reference/load.h -- how long a step takes on this machine.
#pragma once

#include <cstddef>

#include "sim_node/engine/description/network.h"

namespace cordis::plan {

/// Processor time of the steps of a trial.
struct StepLoad {
  double median_nsec = 0.0;
  /// The longest step; where a step takes less than some microseconds, the longest mean of several
  /// that are measured together.
  double worst_nsec = 0.0;
  std::size_t step_count = 0;
};

/// Runs the network from its start, with all its masses awake, for some 50 ms. With liaisons of
/// sets it does so for some 500 ms, in which neighbour lists are made again. It takes one step
/// where that takes longer. It is the time of the thread, so that what else runs on the machine
/// counts little. Not a promise: a scene in motion may have more contacts.
/// @throws std::invalid_argument when the engine does not take the network.
StepLoad measure_steps(engine::NetworkDescription network);

}  // namespace cordis::plan
