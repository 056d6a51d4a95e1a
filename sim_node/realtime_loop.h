// sim_node/realtime_loop.h -- the loop under the clock of the machine.
#pragma once

#include "node/status.h"
#include "sim_node/scene_loop.h"

namespace cordis::sim {

/// Plays one tick per gesture period, with real-time priority where it is permitted, until
/// SceneLoop::finished(): when the samples of the devices have come, or at the end of the period.
/// @param status  publishes at once when slow motion ends: devices take their pace from it
void run_realtime(SceneLoop& loop, node::StatusPublisher& status);

}  // namespace cordis::sim
