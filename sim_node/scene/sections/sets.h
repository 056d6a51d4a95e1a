// sim_node/scene/sections/sets.h -- liaisons of the `links:` section within a set of MATs, or
// between two sets. [Luc90 III.2.3 a formalism for inter-connection]
#pragma once

#include "sim_node/scene/sections/links.h"

namespace cordis::scene {

/// An entry with `within`.
void read_set(Assembly& assembly, LinkEntry& entry);
/// An entry with `between_sets`.
void read_two_sets(Assembly& assembly, LinkEntry& entry);

}  // namespace cordis::scene
