// sim_node/plan/reduction/reduce.h -- the reductions a scene wants.
#pragma once

#include "sim_node/scene/scene.h"

namespace cordis::plan {

/// The scene after the reductions that its `reduce` wants; Scene::reductions reports them, and
/// Scene::whole is the scene as it was, when any was made. A MAT without mass that none takes out
/// is a problem. What signals, ports, sets and links with states ask for stays; to set a parameter
/// of a liaison, set it in the whole and reduce that again. Deterministic; O(MATs + links log
/// links).
scene::Scene reduce(scene::Scene scene, config::Problems& problems);

}  // namespace cordis::plan
