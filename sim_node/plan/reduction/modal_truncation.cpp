#include "sim_node/plan/reduction/modal_truncation.h"

#include <limits>

#include "sim_node/engine/integrators/modal_block.h"

namespace cordis::plan {

std::optional<scene::Reduction> modal_truncation(const scene::Scene& scene, double band_hz) {
  const engine::NetworkDescription& network = scene.network;
  if (network.integrator != engine::IntegratorKind::kModal || network.max_mode_hz == 0.0) return {};
  const std::size_t masses = network.mass_count();
  const std::size_t kept = engine::ModalBlock(network).mode_count();
  if (kept == masses) return {};
  const double ratio = band_hz / network.max_mode_hz;
  scene::Reduction reduction;
  reduction.name = "modal";
  reduction.count = masses - kept;
  reduction.what = std::to_string(reduction.count) + " of " + std::to_string(masses) +
                   " modes, above " + config::number_text(network.max_mode_hz) +
                   " Hz, count as static";
  reduction.bound = "r^2 / (1 - r^2) of their share in the motion, r = band over modes_to_hz";
  reduction.budget =
      ratio < 1.0 ? ratio * ratio / (1.0 - ratio * ratio) : std::numeric_limits<double>::infinity();
  const bool is_much = scene.accuracy && reduction.budget > scene.accuracy->tolerance;
  if (ratio >= 1.0 || is_much) {
    reduction.doubts.emplace_back(ratio >= 1.0
                                      ? "modes within the band are left out: raise modes_to_hz"
                                      : "that is more than the tolerance, unless their "
                                        "share is small: raise modes_to_hz");
  }
  return reduction;
}

}  // namespace cordis::plan
