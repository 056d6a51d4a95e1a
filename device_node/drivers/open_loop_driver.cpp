// device_node/drivers/open_loop_driver.cpp
#include "device_node/drivers/open_loop_driver.h"

#include <utility>

namespace cordis::device {

void OpenLoopDriver::start(Role role) noexcept {
  role_ = role;
  period_count_ = 0;
  is_in_period_ = false;
}

bool OpenLoopDriver::write(const AxisValues&) noexcept {
  ++period_count_;
  return true;
}

bool OpenLoopDriver::begin_period() noexcept {
  if (std::exchange(is_in_period_, true)) ++period_count_;
  return true;
}

}  // namespace cordis::device
