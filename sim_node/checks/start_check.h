// sim_node/checks/start_check.h -- warns of starts that no rate or rounding can follow.
#pragma once

#include "node/config/problem.h"
#include "sim_node/scene/scene.h"

namespace cordis::sim {

/// Warns at the place of the liaison or of the mass, once for each set and once for all masses. One
/// warning is of Lennard-Jones balls so close at the start that the first step throws them apart. One
/// is of members of a set that start at one point, though their pair has a rest length. The third is
/// of positions so far from the origin that their rounding swallows gravity. The fourth is that of check_overlap().
/// O(MATs + pairs).
/// Precondition: the scene has its rate.
void check_start(const scene::Scene& scene, config::Problems& problems);

}  // namespace cordis::sim
