// sim_node/scene/sections/part_use.h -- matter that is a part.
#pragma once

#include "sim_node/scene/sections/assembly.h"

namespace cordis::scene {

/// Adds the body of the part once, or once per copy, where it is put. @return true if it was sound
bool read_part_use(Assembly& assembly, const config::Value::Entry& entry);

}  // namespace cordis::scene
