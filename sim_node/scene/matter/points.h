// sim_node/scene/matter/points.h -- MATs one by one.
#pragma once

#include "sim_node/scene/matter/source.h"

namespace cordis::scene {

/// MATs one by one. Whatever is wrong is a problem; then the result is not to be used.
GeneratedMatter read_points(Source& source);

}  // namespace cordis::scene
