// sim_node/scene/sections/conditions.h -- what conditions ask for outside their links.
#pragma once

#include "sim_node/scene/sections/assembly.h"

namespace cordis::scene {

/// Puts variables of the network in the place of the names in conditions and driven forces, once all
/// matter, links and signals are known. A name in a part is first one of the part, then one of the scene.
/// Whatever is wrong is a problem of its place, once for all links of a liaison.
void read_conditions(Assembly& assembly, const std::vector<Signal>& signals);

}  // namespace cordis::scene
