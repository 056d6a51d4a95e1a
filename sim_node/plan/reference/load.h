// sim_node/plan/reference/load.h -- how long a step takes on this machine.
#pragma once

#include "sim_node/engine/description/network.h"

namespace cordis::plan {

/// Runs the network from its start, with all its masses awake, for some 50 ms of wall time, or one
/// step where that takes longer.
/// @return the time of a step [ns]: of the quickest of several batches, so that what else runs on
///         the machine counts little. Not a promise: a scene in motion may have more contacts.
/// @throws std::invalid_argument when the engine does not take the network.
double measure_step_nsec(engine::NetworkDescription network);

}  // namespace cordis::plan
