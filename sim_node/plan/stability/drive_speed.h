// sim_node/plan/stability/drive_speed.h -- how fast a function of time moves matter.
#pragma once

#include "sim_node/engine/description/network.h"

namespace cordis::plan {

/// The largest speed [m/s] that a driven position of the network was found to have in the first 10 s, at
/// 500 moments of them; 0 when none is driven. Each is that of one step, as dampers see it.
double largest_drive_speed(const engine::NetworkDescription& network);

}  // namespace cordis::plan
