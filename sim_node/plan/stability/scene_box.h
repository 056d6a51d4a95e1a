// sim_node/plan/stability/scene_box.h -- the box about a scene, and what falls through it.
#pragma once

#include <vector>

#include "sim_node/engine/description/network.h"

namespace cordis::plan {

/// The diagonal of the box about all MATs and surfaces at the start [m]; planes count at one point. O(MATs).
/// Precondition: there is one.
double diagonal_of(const engine::NetworkDescription& network);

/// What the weight of each MAT brings in [J]; 0 of what is no mass. What links hold may swing out of the box, and falls
/// by its diagonal. Other masses fall to its bottom. O(MATs and links). Precondition: there is a MAT.
std::vector<double> falls_of(const engine::NetworkDescription& network);

}  // namespace cordis::plan
