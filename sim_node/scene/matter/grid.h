// sim_node/scene/matter/grid.h -- MATs in rows and columns.
#pragma once

#include "sim_node/scene/matter/source.h"

namespace cordis::scene {

/// Rows and columns. Whatever is wrong is a problem; then the result is not to be used.
GeneratedMatter read_grid(Source& source);

}  // namespace cordis::scene
