// sim_node/checks/stability_check.h -- refuses before the run what would diverge in it.
#pragma once

#include <cstdint>
#include <string>

#include "node/config/problem.h"
#include "sim_node/plan/plan.h"
#include "sim_node/scene/scene.h"

namespace cordis::sim {

/// What a run watches of a scene whose step is not certified.
inline constexpr const char* kWatchedText = "energy and K' + 2 Z' are watched during the run";

/// Holds the step of a scene against its limits: an error where it surely diverges, unless forced
/// (then a warning); a warning where it is not certified in every pose and state. The place is that
/// of the liaison that sets the limit. `cordis check` says more.
/// @return the stability of its network
plan::Stability check_stability(const scene::Scene& scene, bool force, config::Problems& problems);
/// @param stability  of its network: of a large one it takes seconds to find
void check_stability(const scene::Scene& scene, const plan::Stability& stability, bool force,
                     config::Problems& problems);

/// The lowest rate above `rate_hz` that is a multiple of the gesture rate of the scene [1/s].
double rate_above(const scene::Scene& scene, double rate_hz) noexcept;

/// What keeps a scene from being certain, as a sentence: the liaison and the reason, and what its law asks for
/// that nothing bounds, with the place in the file.
std::string uncertainty_text(const scene::Scene& scene, const plan::Uncertainty& uncertainty);

/// Why a scene has diverged that did so at this MAT first: the strongest liaison at it, with its
/// place, and how the sum of all there stands to the limit. Not in real time.
std::string reason_of_divergence(const scene::Scene& scene, std::uint32_t mat);

/// What could hold a scene that has diverged at this MAT first, as a sentence without its full stop: a rate, or formulas
/// that keep a stiffness there at 0 or above. Not in real time.
std::string hint_of_divergence(const scene::Scene& scene, std::uint32_t mat);

}  // namespace cordis::sim
