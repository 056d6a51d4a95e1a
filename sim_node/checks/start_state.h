// sim_node/checks/start_state.h -- the state of a run as the start of a scene: `start_state`.
#pragma once

#include <string>

#include "node/config/problem.h"
#include "sim_node/engine/description/world_records.h"
#include "sim_node/scene/scene.h"

namespace cordis::sim {

/// The text of a file of a state: YAML, each value as the 16 hexadecimal digits of its bits.
std::string state_file_text(const scene::Scene& scene, const engine::Snapshot& snapshot);

/// Reads the file that a scene names in `start_state`. A file that is damaged, or holds the state of another
/// scene, is a problem. Precondition: the step and the start of the scene are known.
void read_start_state(scene::Scene& scene, config::Problems& problems);

}  // namespace cordis::sim
