// sim_node/scene/matter/mass.h -- single masses and fixed points.
#pragma once

#include "sim_node/scene/matter/source.h"

namespace cordis::scene {

/// Masses at given points. Whatever is wrong is a problem; then the result is not to be used.
GeneratedMatter read_mass(Source& source);
/// Points that never move. Whatever is wrong is a problem; then the result is not to be used.
GeneratedMatter read_fixed(Source& source);

}  // namespace cordis::scene
