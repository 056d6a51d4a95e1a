// tests/gallery/wild_hand.h -- a hand on the page that drags at will
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <random>

#include "device_node/drivers/pointer_port.h"

namespace cordis::test {

/// Targets as a page sends them: all axes wander over the whole travel, in strokes between two
/// places, as fast as viz_node leads a target.
class WildHand {
 public:
  /// @param axes  of the device, at most 4; @param lowest_m, highest_m  their travel
  WildHand(unsigned seed, std::size_t axes, double lowest_m, double highest_m)
      : lot_(seed), axes_(axes), place_(lowest_m, highest_m) {}

  /// The target of the next millisecond.
  device::PointerTarget next() {
    for (std::size_t a = 0; a < axes_; ++a) {
      if (left_[a]-- <= 0) {
        wanted_[a] = place_(lot_);
        left_[a] = std::uniform_int_distribution(20, 600)(lot_);
      }
      constexpr double kLed = 0.002;  // 2 m/s
      target_.target_m[a] += std::clamp(wanted_[a] - target_.target_m[a], -kLed, kLed);
    }
    target_.epoch = 1;
    ++target_.number;
    target_.holds = true;
    target_.held = (1u << axes_) - 1u;
    return target_;
  }

 private:
  std::mt19937 lot_;
  std::size_t axes_;
  std::uniform_real_distribution<> place_;
  std::array<double, 4> wanted_{};
  std::array<int, 4> left_{};
  device::PointerTarget target_;
};

}  // namespace cordis::test
