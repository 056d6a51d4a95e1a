// sim_node/run/kinetic_watch.h -- the largest kinetic energy that a scene has had.
#pragma once

#include <algorithm>
#include <cstdint>

#include "sim_node/engine/world.h"

namespace cordis::sim {

/// Looks at the kinetic energy of a world in one of 64 steps, and keeps the largest. The steps are spread
/// evenly over each period but never in step with it, by the golden ratio.
class KineticWatch {
 public:
  /// After each step. Real time: O(1), O(MATs) in one of 64 steps; no allocation.
  void update(const engine::World& world) noexcept {
    constexpr std::uint64_t kGoldenRatio = 0x9e3779b97f4a7c15U;  // its part after the point
    constexpr int kOneOf64 = 64 - 6;
    if (world.step_count() * kGoldenRatio >> kOneOf64 != 0) return;
    largest_ = std::max(largest_, world.kinetic_energy());
  }
  double largest() const noexcept { return largest_; }  ///< [J]

 private:
  double largest_ = 0.0;
};

}  // namespace cordis::sim
