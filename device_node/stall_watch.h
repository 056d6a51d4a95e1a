// device_node/stall_watch.h -- whether the loop of a device has itself stalled.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>

namespace cordis::device {

/// Compares the time between two commands of a loop with the limit of a stall.
class StallWatch {
 public:
  using ClockFunction = std::int64_t (*)() noexcept;

  /// @param clock  goes on while the machine sleeps [ns] @param rate_hz  of the loop
  StallWatch(ClockFunction clock, double rate_hz)
      : clock_(clock),
        limit_s_(std::max(kStall, kStallPeriods / rate_hz)),
        stepped_nsec_(clock()) {}

  /// Once for each command. @param time_scale  simulated time per real time, 0..1; between two commands
  ///                                           the slower counts
  /// @return whether the one before is longer ago than the limit
  bool has_stalled(double time_scale = 1.0) noexcept {
    const std::int64_t now = clock_();
    const auto since_s = static_cast<double>(now - std::exchange(stepped_nsec_, now)) * 1e-9;
    return since_s * std::min(time_scale, std::exchange(time_scale_, time_scale)) > limit_s_;
  }

 private:
  // Limits of a stall of the loop itself, safely below the watchdog of 20 ms that boards have.
  static constexpr double kStall = 0.018;  // [s]
  // Two commands of a slow device are apart by one period and a half at most. One follows an answer
  // at the beginning of a period, the next waits for Exchange::kAnswerShare of its own.
  static constexpr double kStallPeriods = 1.9;

  ClockFunction clock_;
  double limit_s_;
  std::int64_t stepped_nsec_;  // when a command was found last
  double time_scale_ = 1.0;    // then
};

}  // namespace cordis::device
