// sim_node/plan/reduction/parallel.h -- linear links between the same two MATs as one.
#pragma once

#include "sim_node/scene/scene.h"

namespace cordis::plan {

/// Merges linear links between the same two MATs into the first of them:
///
///     K = sum K_i    Z = sum Z_i    rest = sum K_i rest_i / sum K_i
///
/// Exact to rounding; of links of different rest lengths the energy at rest is not kept, so that
/// they stay where a signal reports it. [Luc90 IV Assembly]
/// @return how many links are gone. O(links log links).
std::size_t merge_parallel(scene::Scene& scene);

}  // namespace cordis::plan
