// sim_node/scene/sections/ports.h -- the `ports:` section: MATs played by
// the axes of devices. [Luc90 V.1 Force feedback gestual transducers]
#pragma once

#include "sim_node/scene/sections/assembly.h"

namespace cordis::scene {

/// Adds the ports of a section, with their handles, tools and couplings, of the scene or of the part that
/// is being added.
void read_ports(Assembly& assembly, const config::Value& section);

/// Finds what the ports of a scene contradict each other in: roles and axes of devices. Copies of a port
/// have one problem.
void check_ports(Assembly& assembly);

}  // namespace cordis::scene
