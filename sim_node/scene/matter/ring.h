// sim_node/scene/matter/ring.h -- a string that closes in a circle.
#pragma once

#include "sim_node/scene/matter/source.h"

namespace cordis::scene {

/// A string that closes in a circle. Whatever is wrong is a problem; then the result is not to be used.
GeneratedMatter read_ring(Source& source);

}  // namespace cordis::scene
