// device_node/drivers/jump_check.h -- for devices whose answers have no checksum.
#pragma once

#include "device_node/axis.h"
#include "node/hand_speed.h"

namespace cordis::device {

/// Which places of a handle are believed: those no farther from the last one than a hand moves it
/// in a period, and any other as soon as the next sample confirms it. A damaged answer is thus left
/// out, and a hand that has jumped is believed one sample later.
class JumpCheck {
 public:
  explicit JumpCheck(double rate_hz) noexcept : largest_step_m_(kFastestHand / rate_hz) {}

  void forget() noexcept;  ///< the next place is the first one, and believed

  /// True if the place is believed [m].
  bool believes(const AxisValues& place_m) noexcept;

 private:
  bool is_near(const AxisValues& a, const AxisValues& b) const noexcept;

  double largest_step_m_;
  bool known_ = false;
  bool has_candidate_ = false;
  AxisValues last_{};       // believed
  AxisValues candidate_{};  // not believed, if has_candidate_
};

}  // namespace cordis::device
