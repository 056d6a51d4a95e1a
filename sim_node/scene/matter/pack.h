// sim_node/scene/matter/pack.h -- balls without order that fill a region.
#pragma once

#include "sim_node/scene/matter/source.h"

namespace cordis::scene {

/// Balls without order that fill a region. Whatever is wrong is a problem; then the result is not to be used.
GeneratedMatter read_pack(Source& source);

}  // namespace cordis::scene
