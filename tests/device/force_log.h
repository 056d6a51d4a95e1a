// tests/device/force_log.h -- when a board was given which force, as the board itself sees it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <mutex>
#include <utility>
#include <vector>

#include "node/time.h"

namespace cordis::test {

/// The frames that reach a board. Written on the board's thread.
class ForceLog {
 public:
  /// A frame has come. @param largest  of its forces, in units of the board, >= 0
  void note(double largest) {
    const std::lock_guard lock(mutex_);
    if (largest == 0.0 && newest_ > 0.0) zeros_nsec_.push_back(node::monotonic_nsec());
    ++frames_;
    largest_fall_ = std::max(largest_fall_, newest_ - largest);
    largest_rise_ = std::max(largest_rise_, largest - newest_);
    newest_ = largest;
  }

  double newest() const {
    const std::lock_guard lock(mutex_);
    return newest_;
  }

  std::uint64_t frames() const {
    const std::lock_guard lock(mutex_);
    return frames_;
  }

  /// The largest that its force fell by from one frame to the next since the last call.
  double take_largest_fall() {
    const std::lock_guard lock(mutex_);
    return std::exchange(largest_fall_, 0.0);
  }

  /// The largest that its force rose by, likewise.
  double take_largest_rise() {
    const std::lock_guard lock(mutex_);
    return std::exchange(largest_rise_, 0.0);
  }

  /// When its force first went to 0 since then, CLOCK_MONOTONIC; 0: it has not.
  std::int64_t zero_since(std::int64_t time_nsec) const {
    const std::lock_guard lock(mutex_);
    for (const std::int64_t zero_nsec : zeros_nsec_) {
      if (zero_nsec >= time_nsec) return zero_nsec;
    }
    return 0;
  }

 private:
  mutable std::mutex mutex_;
  double newest_ = 0.0;
  std::uint64_t frames_ = 0;
  double largest_fall_ = 0.0;
  double largest_rise_ = 0.0;
  std::vector<std::int64_t> zeros_nsec_;
};

}  // namespace cordis::test
