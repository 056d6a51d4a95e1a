// sim_node/scene/matter/ball.h -- a full sphere.
#pragma once

#include "sim_node/scene/matter/source.h"

namespace cordis::scene {

/// A full sphere. Whatever is wrong is a problem; then the result is not to be used.
GeneratedMatter read_ball(Source& source);

}  // namespace cordis::scene
