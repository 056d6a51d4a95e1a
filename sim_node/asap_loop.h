// sim_node/asap_loop.h -- the loop without a clock.
#pragma once

#include "sim_node/scene_loop.h"

namespace cordis::sim {

/// Plays as fast as possible, without devices, until SceneLoop::finished(): a scene whose time is
/// not that of a hand has no force for it.
void run_asap(SceneLoop& loop);

}  // namespace cordis::sim
