// node/machine/deadline_record.h -- how late a periodic timer wakes a thread.
#pragma once

#include <cstdint>

#include "node/latency.h"

namespace cordis::machine {

/// The lateness of every deadline of a periodic timer. A deadline that passes while an earlier
/// wake-up is late counts too, with its own lateness: the shares do not depend on the rate of the
/// timer.
class DeadlineRecord {
 public:
  static constexpr std::int64_t kLateNsec = 200'000;  ///< a wake-up later than this counts as late

  /// Records a wake-up and the deadlines that passed meanwhile. @return how many those are
  std::int64_t record(std::int64_t late_nsec, std::int64_t period_nsec) noexcept;

  std::uint64_t count() const noexcept { return lateness_.count(); }  ///< deadlines
  double late_share() const noexcept { return share(late_); }         ///< by more than kLateNsec
  double lost_share() const noexcept { return share(lost_); }         ///< by a period or more
  double p99_s() const noexcept { return lateness_.quantile_nsec(0.99) * 1e-9; }
  double worst_s() const noexcept { return static_cast<double>(lateness_.largest_nsec()) * 1e-9; }

 private:
  double share(std::uint64_t part) const noexcept {
    return count() == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(count());
  }

  node::LatencyHistogram lateness_;
  std::uint64_t late_ = 0;
  std::uint64_t lost_ = 0;
};

}  // namespace cordis::machine
