// sim_node/checks/overlap_check.h -- warns of contacts that throw matter away as the scene starts.
#pragma once

#include <cstdint>

#include "node/config/problem.h"
#include "sim_node/plan/stability/start_pairs.h"
#include "sim_node/scene/scene.h"

namespace cordis::sim {

/// The speed [m/s] above which a contact that lets go of what it stores at the start is warned of.
inline constexpr double kThrownSpeed = 10.0;

/// Warns once, at the place of a liaison of sets, when its pairs start so deep in each other, or in a surface,
/// that the lighter one of a pair would leave it faster than kThrownSpeed. Each pair counts alone, without
/// dampers, in the state that its exits lead it to. Lennard-Jones laws are left out. O(pairs).
/// @param near  the pairs of the set
void check_overlap(const scene::Scene& scene, const plan::StartPairs& near, std::uint32_t set,
                   config::Problems& problems);

}  // namespace cordis::sim
