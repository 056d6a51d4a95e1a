// sim_node/plan/reduction/dimension.h -- a scene in as many dimensions as it moves in.
#pragma once

#include <string>

#include "sim_node/scene/scene.h"

namespace cordis::plan {

/// Computes a scene in 2 dimensions, or in 1, when all its MATs stay in a plane or on a line along
/// the axes. They do when they lie and begin to move in it, and gravity and ports act in it. Then
/// no force ever leads out of it. Exact: what is left out stays 0. Scene::subspace reports where it
/// is shown.
///
/// In 1 dimension the links of a line have a sign, and ends pass each other. So on a line every
/// link must have no rest length or no stiffness, and none states, nor a signal. Conditions on a
/// speed along an axis keep a scene in its dimensions.
/// @return what was done, for a person; empty when nothing. O(MATs + links).
std::string confine(scene::Scene& scene);

}  // namespace cordis::plan
