// device_node/drivers/jump_check.cpp
#include "device_node/drivers/jump_check.h"

#include <cmath>

namespace cordis::device {

void JumpCheck::forget() noexcept {
  known_ = false;
  has_candidate_ = false;
}

bool JumpCheck::is_near(const AxisValues& a, const AxisValues& b) const noexcept {
  for (std::size_t axis = 0; axis < a.size(); ++axis) {
    if (!(std::abs(a[axis] - b[axis]) <= largest_step_m_)) return false;
  }
  return true;
}

bool JumpCheck::believes(const AxisValues& place_m) noexcept {
  const bool near =
      !known_ || is_near(place_m, last_) || (has_candidate_ && is_near(place_m, candidate_));
  (near ? last_ : candidate_) = place_m;
  known_ = true;
  has_candidate_ = !near;
  return near;
}

}  // namespace cordis::device
