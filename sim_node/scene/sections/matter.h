// sim_node/scene/sections/matter.h -- the `matter:` section.
#pragma once

#include "sim_node/scene/sections/assembly.h"

namespace cordis::scene {

/// Adds the matter of a section: what is generated, and the parts that are used. @return true if all
/// parts were sound
bool read_matter(Assembly& assembly, const config::Value& section);
/// What matter is called in messages.
std::string matter_called(const Assembly& assembly, const std::string& name);

}  // namespace cordis::scene
