// sim_node/scene/matter/lattice.h -- a crystal.
#pragma once

#include "sim_node/scene/matter/source.h"

namespace cordis::scene {

/// A crystal: counts along its axes, or what fills a region. Whatever is wrong is a problem; then the result is not to be used.
GeneratedMatter read_lattice(Source& source);

}  // namespace cordis::scene
