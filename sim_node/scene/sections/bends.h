// sim_node/scene/sections/bends.h -- the entries of `links:` that resist bending.
#pragma once

#include "sim_node/scene/sections/links.h"

namespace cordis::scene {

/// Adds bends between three ends, or along the lines of matter.
/// Precondition: the entry has a law, of a liaison that resists bending.
void read_bends(Assembly& assembly, LinkEntry& entry);

}  // namespace cordis::scene
