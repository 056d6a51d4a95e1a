// sim_node/scene/sections/driven_part.h -- a part that follows a function of time as a whole.
#pragma once

#include "sim_node/scene/matter/driven.h"
#include "sim_node/scene/sections/assembly.h"

namespace cordis::scene {

/// Makes all MATs that have been added since there were `first` follow a displacement, or pushes all masses
/// among them; its axes are those of what the part is used in. What contradicts it is a problem.
/// @param what   the use of the part, for messages
/// @param place  of its `driven`
void drive_part(Assembly& assembly, const DriveSpec& spec, std::uint32_t first,
                const std::string& what, const config::Place& place);

}  // namespace cordis::scene
