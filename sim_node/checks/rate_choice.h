// sim_node/checks/rate_choice.h -- the rate of a scene that says what it needs instead.
#pragma once

#include "node/config/problem.h"
#include "sim_node/plan/rate_selection.h"
#include "sim_node/scene/scene.h"

namespace cordis::sim {

/// What the plan chooses for the `accuracy` of a scene, with its integrator where it names one.
/// Precondition: it has an `accuracy`.
plan::RateSelection rate_selection_of(const scene::Scene& scene);

/// Sets the rate of a scene that leaves it to the plan; holds one that has a rate and an `accuracy`
/// against the plan. Warns where the accuracy is not kept, or cannot be promised.
void select_rate(scene::Scene& scene, config::Problems& problems);

}  // namespace cordis::sim
