// sim_node/checks/planned_scene.h -- a scene file as it will run: reduced, with its rate, settled.
#pragma once

#include <optional>
#include <string>

#include "node/config/problem.h"
#include "sim_node/plan/rate_selection.h"
#include "sim_node/scene/scene.h"

namespace cordis::sim {

struct PlannedScene {
  scene::Scene scene;
  std::optional<plan::RateSelection> rate;  ///< for the `accuracy` of the scene
};

/// Reads a scene file, takes out what `reduce` names, selects its rate, settles it, and reads the state
/// that it starts from. Usable when there is no
/// problem. @param referrer  the place that names the file, if any
PlannedScene plan_scene(const std::string& file, const config::Place& referrer,
                        config::Problems& problems);

/// Reduces a scene that has been read, and selects its rate. `problems` are those of the reading.
PlannedScene plan_scene(scene::Scene scene, config::Problems& problems);

}  // namespace cordis::sim
