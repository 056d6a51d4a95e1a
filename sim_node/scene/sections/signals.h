// sim_node/scene/sections/signals.h -- the `signals:` section: named scalars
// of MATs, ports, links and the scene.
#pragma once

#include "sim_node/scene/sections/assembly.h"

namespace cordis::scene {

/// Compiles the signals of a section; the last of the sections.
std::vector<Signal> read_signals(Assembly& assembly, const config::Value& section);

}  // namespace cordis::scene
