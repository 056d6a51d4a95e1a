// device_node/drivers/open_loop_driver.h -- a simulated device whose samples depend on time alone.
#pragma once

#include <cstdint>

#include "device_node/drivers/driver.h"

namespace cordis::device {

/// Counts the periods since start() and ignores every command, so that a run is exactly repeatable:
/// sample n is the value at n/rate seconds. Derived classes define read() and can_play().
class OpenLoopDriver : public Driver {
 public:
  void start(Role role) noexcept final;
  bool write(const AxisValues& commanded) noexcept final;
  bool changes_within_period() const noexcept final { return true; }
  bool begin_period() noexcept final;
  bool change_command(const AxisValues&, double) noexcept final { return true; }
  void stop() noexcept final {}  // it has no motor

 protected:
  explicit OpenLoopDriver(double rate_hz) : rate_hz_(rate_hz) {}

  Role role() const noexcept { return role_; }
  double rate_hz() const noexcept { return rate_hz_; }
  /// Periods since start().
  double period_count() const noexcept { return static_cast<double>(period_count_); }

 private:
  double rate_hz_;
  Role role_ = Role::kMass;
  std::uint64_t period_count_ = 0;
  bool is_in_period_ = false;  // in real time
};

}  // namespace cordis::device
