// sim_node/plan/stability/drive_extremes.h -- how fast drives move matter, and how hard they push.
#pragma once

#include "sim_node/engine/description/network.h"

namespace cordis::plan {

/// The largest speed [m/s] of a driven position, as dampers see it; 0 when none is driven. Of a
/// table it is a bound. Formulas are asked at up to 20,000 moments of the first 10 s, at uneven
/// distances, and at 1,000 up to 100 s. Where one goes farther between two of them than its speed at both, the fastest
/// step between them counts: that of a jump. What comes back within less may stay unseen.
/// O(moments + entries).
double largest_drive_speed(const engine::NetworkDescription& network);

/// The sum of the largest forces [N] of all driven forces, found likewise. One that depends on more than time
/// counts as it is at the start.
double sum_of_drive_forces(const engine::NetworkDescription& network);

}  // namespace cordis::plan
