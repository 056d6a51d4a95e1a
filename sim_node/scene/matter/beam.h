// sim_node/scene/matter/beam.h -- a braced truss.
#pragma once

#include "sim_node/scene/matter/source.h"

namespace cordis::scene {

/// A braced truss. Whatever is wrong is a problem; then the result is not to be used.
GeneratedMatter read_beam(Source& source);

}  // namespace cordis::scene
