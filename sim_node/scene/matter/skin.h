// sim_node/scene/matter/skin.h -- a closed surface.
#pragma once

#include "sim_node/scene/matter/source.h"

namespace cordis::scene {

/// A closed surface. Whatever is wrong is a problem; then the result is not to be used.
GeneratedMatter read_skin(Source& source);

}  // namespace cordis::scene
