// node/latency.h -- the distribution of a delay, without storing its samples.
#pragma once

#include <array>
#include <cstdint>

namespace cordis::node {

/// A histogram of delays from 1 ns to 68 s with bins of 1/32 of an octave (at most 3.1 % wide), and
/// their exact largest. Recording costs a few nanoseconds and allocates nothing. One thread at a
/// time.
class LatencyHistogram {
 public:
  /// A negative delay counts as 0.
  void record(std::int64_t delay_nsec) noexcept;

  std::uint64_t count() const noexcept { return count_; }
  std::int64_t largest_nsec() const noexcept { return largest_; }

  /// The delay that the given share (0..1) of all samples does not exceed [ns]; 0 without samples.
  double quantile_nsec(double share) const noexcept;

  void clear() noexcept;  ///< forgets all samples

 private:
  static constexpr std::size_t kStepsPerOctave = 32;
  static constexpr std::size_t kOctaves = 33;

  std::array<std::uint64_t, kStepsPerOctave * kOctaves> bins_{};
  std::uint64_t count_ = 0;
  std::int64_t largest_ = 0;
};

}  // namespace cordis::node
