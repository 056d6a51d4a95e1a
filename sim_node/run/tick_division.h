// sim_node/run/tick_division.h -- how the steps of a scene fall into its gesture periods.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

namespace cordis::sim {

/// Steps per gesture period as an exact fraction, so that no rounding adds up: step n belongs to
/// tick k when k < n / ratio <= k + 1. With 44,100 steps and 1000 gestures a second nine ticks of
/// ten have 44 steps and one has 45. With an integer ratio all are alike, and the last step of a
/// tick stands at its end. Real time: everything but the constructor is O(1) and allocates nothing.
class TickDivision {
 public:
  /// The ratio of the rates is taken as the simplest fraction within 1e-13 of it.
  /// Precondition: step_rate_hz >= gesture_rate_hz > 0, to within that.
  TickDivision(double step_rate_hz, double gesture_rate_hz);

  /// Steps of the present tick.
  int steps() const noexcept { return static_cast<int>((passed_ + numerator_) / denominator_); }
  /// Steps of the longest tick, and of the shortest.
  std::size_t max_steps() const noexcept {
    return static_cast<std::size_t>((numerator_ + denominator_ - 1) / denominator_);
  }
  std::size_t whole_steps() const noexcept {
    return static_cast<std::size_t>(numerator_ / denominator_);
  }
  /// Part of the gesture period that is over at step `number` of the present tick, 1..steps(): in
  /// (0, 1], and 1 when the step stands at its end.
  double share(int number) const noexcept {
    return static_cast<double>(number * denominator_ - passed_) / static_cast<double>(numerator_);
  }
  /// Goes on to the next tick.
  void next() noexcept { passed_ = (passed_ + numerator_) % denominator_; }
  /// Goes to the tick that begins behind a step.
  /// @return how many ticks are over then; nothing, and nothing has changed, where no tick ends there
  std::optional<std::uint64_t> go_behind(std::uint64_t step) noexcept;
  /// True if all ticks have as many steps.
  bool is_even() const noexcept { return denominator_ == 1; }

 private:
  std::int64_t numerator_ = 1;    // steps ...
  std::int64_t denominator_ = 1;  // ... in so many ticks
  std::int64_t passed_ = 0;       // since the last step before the tick, in steps / denominator_
};

}  // namespace cordis::sim
