// sim_node/devices/recent_peak.h -- the largest value of the last moments.
#pragma once

#include <algorithm>
#include <utility>

namespace cordis::sim {

/// The largest of the last `memory` to 2 x `memory` values: of a swing whose period is shorter, the
/// same all the time.
class RecentPeak {
 public:
  /// @param memory  [values], >= 1
  explicit RecentPeak(int memory) noexcept : memory_(std::max(memory, 1)) {}

  void enter(double value) noexcept {
    if (++count_ > memory_) {
      before_ = std::exchange(now_, value);
      count_ = 1;
    }
    now_ = std::max(now_, value);
  }

  double value() const noexcept { return std::max(now_, before_); }

 private:
  int memory_;
  int count_ = 0;        // of the values in now_
  double now_ = 0.0;     // of the last values, at most `memory`
  double before_ = 0.0;  // of as many before them
};

}  // namespace cordis::sim
