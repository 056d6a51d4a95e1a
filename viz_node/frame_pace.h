// viz_node/frame_pace.h -- lets at most so many frames a second through.
#pragma once

#include <algorithm>
#include <cstdint>

#include "node/assert.h"

namespace cordis::viz {

/// Lets frames through at a rate, whatever rate they come at.
///
/// A frame up to half a period early is let through, so that frames that come at just that rate,
/// with the jitter of the machine, all pass. Over time the rate holds all the same.
class FramePace {
 public:
  explicit FramePace(double rate_hz) noexcept
      : period_nsec_(static_cast<std::int64_t>(1e9 / rate_hz)) {
    CORDIS_ASSERT(rate_hz > 0.0);
  }

  bool lets_through(std::int64_t now_nsec) noexcept {
    if (due_nsec_ == 0) due_nsec_ = now_nsec;
    if (now_nsec < due_nsec_ - period_nsec_ / 2) return false;
    due_nsec_ = std::max(due_nsec_, now_nsec - period_nsec_ / 2) + period_nsec_;
    return true;
  }

 private:
  std::int64_t period_nsec_;
  std::int64_t due_nsec_ = 0;  // of the next frame [ns]; 0 before the first
};

}  // namespace cordis::viz
