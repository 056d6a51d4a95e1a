// sim_node/scene/matter/string.h -- MATs in a row, each joined to the next.
#pragma once

#include "sim_node/scene/matter/source.h"

namespace cordis::scene {

/// MATs in a row, each joined to the next. Whatever is wrong is a problem; then the result is not to be used.
GeneratedMatter read_string(Source& source);

}  // namespace cordis::scene
