// sim_node/scene/language/name.h -- the spelling of a name in a scene.
#pragma once

#include <string>

#include "node/config/problem.h"

namespace cordis::scene {

/// True for letters, digits, '_' and '-' of which the first is a letter or '_'; otherwise a problem
/// of the place.
bool check_name(const std::string& name, const config::Place& place, config::Problems& problems);

}  // namespace cordis::scene
