// sim_node/scene/sections/ports.h -- the `ports:` section: MATs played by
// the axes of devices. [Luc90 V.1 Force feedback gestual transducers]
#pragma once

#include "sim_node/scene/sections/assembly.h"

namespace cordis::scene {

/// Adds the ports of a section, with their handles, tools and couplings.
void read_ports(Assembly& assembly, const config::Value& section);

}  // namespace cordis::scene
