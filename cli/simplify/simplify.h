// cli/simplify/simplify.h -- a scene with less in it, as text.
#pragma once

#include <string>

#include "node/config/problem.h"
#include "sim_node/scene/scene.h"

namespace cordis::cli {

struct Simplified {
  std::string text;    ///< a scene file
  std::string report;  ///< what was taken out, in lines for a person
};

/// Makes the reductions that a scene asks for, or all when it does not speak of them. The text has
/// been read back: what is wrong with it becomes a problem.
Simplified simplify_scene(scene::Scene scene, config::Problems& problems);

}  // namespace cordis::cli
