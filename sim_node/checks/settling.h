// sim_node/checks/settling.h -- a scene that is to be at rest when it starts: `settle`.
#pragma once

#include <string>

#include "node/config/problem.h"
#include "sim_node/scene/scene.h"

namespace cordis::sim {

/// Puts the MATs of a scene with `settle` where it is at rest; Scene::settled says what moved. A scene that
/// does not come to rest is a problem. Precondition: its step is known.
void settle(scene::Scene& scene, config::Problems& problems);

/// Gives a scene with other parameters the start of the settled one, if it has the same MATs.
void keep_settled(const scene::Scene& settled, scene::Scene& scene);

/// What settling has moved, for a person; empty where nothing was asked.
std::string settled_text(const scene::Scene& scene);

}  // namespace cordis::sim
