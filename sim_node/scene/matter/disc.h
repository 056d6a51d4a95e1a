// sim_node/scene/matter/disc.h -- a full circle.
#pragma once

#include "sim_node/scene/matter/source.h"

namespace cordis::scene {

/// A full circle. Whatever is wrong is a problem; then the result is not to be used.
GeneratedMatter read_disc(Source& source);

}  // namespace cordis::scene
