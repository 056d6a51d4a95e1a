// sim_node/checks/rate_check.h -- the rate of a scene that says what it needs instead.
#pragma once

#include <optional>

#include "node/config/problem.h"
#include "sim_node/plan/rate_selection.h"
#include "sim_node/scene/scene.h"

namespace cordis::sim {

/// Sets the rate of a scene that leaves it to the plan; holds one that has a rate and an `accuracy`
/// against the plan. Warns where the accuracy is not kept, or cannot be promised.
/// @return the selection, empty without an `accuracy`
std::optional<plan::RateSelection> select_rate(scene::Scene& scene, config::Problems& problems);

}  // namespace cordis::sim
