// sim_node/plan/reduction/modal_truncation.h -- what the modes cost that `modal` leaves out.
#pragma once

#include <optional>

#include "sim_node/scene/scene.h"

namespace cordis::plan {

/// Modes above `modes_to_hz`, of which only the answer to a steady force is kept. Under a force of
/// frequency f a mode of frequency F answers with 1 / (F^2 - f^2) instead of 1 / F^2: up to the end
/// of the band their share is wrong by r^2 / (1 - r^2), r = band / modes_to_hz, at most.
/// @return nothing unless the integrator is `modal` and leaves modes out. O(masses^3).
std::optional<scene::Reduction> modal_truncation(const scene::Scene& scene, double band_hz);

}  // namespace cordis::plan
