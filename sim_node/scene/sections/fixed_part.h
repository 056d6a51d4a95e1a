// sim_node/scene/sections/fixed_part.h -- a part that never moves.
#pragma once

#include <cstdint>
#include <string>

#include "node/config/problem.h"
#include "sim_node/scene/sections/assembly.h"

namespace cordis::scene {

/// Fixes all MATs that have been added since there were `first`. What moves one of them is a problem: a port, a
/// drive, a velocity.
/// @param what   the use of the part, for messages
/// @param place  of its `fixed`
void fix_part(Assembly& assembly, std::uint32_t first, const std::string& what,
              const config::Place& place);

}  // namespace cordis::scene
