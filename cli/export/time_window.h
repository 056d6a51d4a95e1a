// cli/export/time_window.h -- which steps of a scene are wanted.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

#include "node/assert.h"

namespace cordis::cli {

/// The steps behind a start, up to an end that belongs to them.
class TimeWindow {
 public:
  /// @param start_s     time of the scene, >= 0
  /// @param duration_s  0: without an end
  TimeWindow(double start_s, double duration_s, double step_rate_hz) noexcept
      : first_(static_cast<std::uint64_t>(std::llround(start_s * step_rate_hz)) + 1),
        last_(duration_s > 0.0
                  ? static_cast<std::uint64_t>(std::llround((start_s + duration_s) * step_rate_hz))
                  : std::numeric_limits<std::uint64_t>::max()) {
    CORDIS_ASSERT(start_s >= 0.0);
  }

  bool has(std::uint64_t step) const noexcept { return step >= first_ && step <= last_; }
  std::uint64_t first() const noexcept { return first_; }  ///< the first step
  std::uint64_t last() const noexcept { return last_; }

 private:
  std::uint64_t first_;
  std::uint64_t last_;
};

}  // namespace cordis::cli
