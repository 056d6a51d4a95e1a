// sim_node/plan/reduction/take_out.h -- a scene without some of its MATs and linear links.
#pragma once

#include <vector>

#include "sim_node/scene/scene.h"

namespace cordis::plan {

/// Takes MATs and linear links out; all that counts MATs or links is counted again.
/// @param mats, links  per MAT and per linear link: true if it goes. Precondition: as many as the
/// scene has, and no link that stays, no port, set or signal asks for what goes.
void take_out(const std::vector<bool>& mats, const std::vector<bool>& links, scene::Scene& scene);

}  // namespace cordis::plan
