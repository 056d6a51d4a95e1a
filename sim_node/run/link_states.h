// sim_node/run/link_states.h -- finds links with states by name, and states by name.
#pragma once

#include <string>
#include <vector>

#include "sim_node/run/request.h"
#include "sim_node/scene/scene.h"

namespace cordis::sim {

/// The links that `links` names (name, name[3] or name[2..5], both ends included), each with the
/// state of its liaison that `state` names.
/// @throws std::invalid_argument with one sentence when there is no such name, index or state, or a
/// link has no states
std::vector<Request::ForcedState> find_states(const scene::Scene& scene, const std::string& links,
                                              const std::string& state);

}  // namespace cordis::sim
