// sim_node/realtime_loop.h -- the loop under the clock of the machine.
#pragma once

#include "sim_node/scene_loop.h"

namespace cordis::sim {

/// Plays one tick per gesture period, with real-time priority where it is permitted, until
/// SceneLoop::finished(): when the samples of the devices have come, or at the end of the period.
void run_realtime(SceneLoop& loop);

}  // namespace cordis::sim
