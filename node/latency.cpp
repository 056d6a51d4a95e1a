// node/latency.cpp
#include "node/latency.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace cordis::node {
namespace {

constexpr int kBits = 5;  // 32 steps per octave
static_assert(1 << kBits == 32);

/// Bin of a delay: its octave and the 5 bits below its leading one. Delays below 32 ns have a bin
/// each.
std::size_t bin_of(std::uint64_t delay, std::size_t bin_count) noexcept {
  if (delay < (1u << kBits)) return static_cast<std::size_t>(delay);
  const auto octave = static_cast<int>(std::bit_width(delay)) - kBits;  // >= 1
  const std::uint64_t step = (delay >> (octave - 1)) & ((1u << kBits) - 1);
  return std::min((static_cast<std::size_t>(octave) << kBits) + step, bin_count - 1);
}

/// Middle of a bin [ns].
double middle_of(std::size_t bin) noexcept {
  const std::size_t octave = bin >> kBits;
  if (octave == 0) return static_cast<double>(bin);
  const double lowest =
      std::ldexp(static_cast<double>((bin & 31u) + 32u), static_cast<int>(octave) - 1);
  return lowest + 0.5 * (std::ldexp(1.0, static_cast<int>(octave) - 1) - 1.0);
}

}  // namespace

void LatencyHistogram::record(std::int64_t delay_nsec) noexcept {
  const std::int64_t delay = std::max<std::int64_t>(delay_nsec, 0);
  ++bins_[bin_of(static_cast<std::uint64_t>(delay), bins_.size())];
  ++count_;
  largest_ = std::max(largest_, delay);
}

double LatencyHistogram::quantile_nsec(double share) const noexcept {
  if (count_ == 0) return 0.0;
  const double wanted = std::clamp(share, 0.0, 1.0) * static_cast<double>(count_);
  std::uint64_t seen = 0;
  for (std::size_t bin = 0; bin < bins_.size(); ++bin) {
    seen += bins_[bin];
    if (seen > 0 && static_cast<double>(seen) >= wanted) {
      return std::min(middle_of(bin), static_cast<double>(largest_));
    }
  }
  return static_cast<double>(largest_);
}

void LatencyHistogram::clear() noexcept {
  *this = LatencyHistogram{};
}

}  // namespace cordis::node
