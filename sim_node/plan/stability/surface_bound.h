// sim_node/plan/stability/surface_bound.h -- how many surfaces a ball may touch at once.
#pragma once

#include <vector>

#include "sim_node/engine/description/surface.h"

namespace cordis::plan {

/// Counts the surfaces that are nearer to one place than `reach` [m], at the place where most are. Never
/// below the true number: every two of them have a place in common, and for one or two surfaces at
/// once, for planes and boxes, the number is exact.
/// @param centres  of the surfaces [m]
/// @param group    of each surface: those of one keep their places to each other, those of two may meet.
///                 Empty: all are of one
double max_surfaces_in_reach(const std::vector<engine::Surface>& surfaces,
                             const std::vector<engine::Vec3>& centres, double reach, int dimension,
                             const std::vector<std::size_t>& group = {});

}  // namespace cordis::plan
