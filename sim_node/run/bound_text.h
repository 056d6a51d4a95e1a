// sim_node/run/bound_text.h -- messages about a scene that is beyond its certificate.
#pragma once

#include <string>

#include "sim_node/run/loaded_scene.h"

namespace cordis::sim {

/// The message about a scene with LoadedScene::is_beyond_reach.
inline constexpr const char* kBeyondReach =
    "the scene has more energy, or a faster hand or drive, than its step is certified for: it may "
    "be unstable from here on, and lets go of devices when the steps make more than a tenth of the "
    "energy";

/// Why the devices were let go of. Precondition: a bound is passed.
std::string let_go_text(const Simulation& simulation);

/// The message about steps that have made or taken energy. @p energy is one with is_error_large().
std::string integration_error_text(const engine::Energy& energy);

/// let_go_text() or kBeyondReach; empty while the scene is within its bounds.
std::string bound_text(const LoadedScene& loaded);

}  // namespace cordis::sim
