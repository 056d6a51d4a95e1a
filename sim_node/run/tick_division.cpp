// sim_node/run/tick_division.cpp
#include "sim_node/run/tick_division.h"

#include <cmath>

#include "node/assert.h"

namespace cordis::sim {

TickDivision::TickDivision(double step_rate_hz, double gesture_rate_hz) {
  CORDIS_ASSERT(gesture_rate_hz > 0.0 && step_rate_hz > 0.0);
  constexpr double kNear = 1e-13;
  constexpr std::int64_t kLargestDenominator = 1'000'000'000;
  const double ratio = step_rate_hz / gesture_rate_hz;
  // The convergents of the continued fraction of the ratio, from the simplest on.
  std::int64_t numerator_before = 0;
  std::int64_t denominator_before = 1;
  std::int64_t numerator = 1;
  std::int64_t denominator = 0;
  double rest = ratio;
  for (;;) {
    const double whole = std::floor(rest);
    const auto term = static_cast<std::int64_t>(whole);
    const std::int64_t next_denominator = term * denominator + denominator_before;
    if (denominator > 0 && next_denominator > kLargestDenominator) break;
    const std::int64_t next_numerator = term * numerator + numerator_before;
    numerator_before = numerator;
    denominator_before = denominator;
    numerator = next_numerator;
    denominator = next_denominator;
    const double value = static_cast<double>(numerator) / static_cast<double>(denominator);
    if (std::abs(value - ratio) <= kNear * ratio || rest == whole) break;
    rest = 1.0 / (rest - whole);
    if (!(rest < static_cast<double>(kLargestDenominator))) break;
  }
  CORDIS_ASSERT(numerator >= denominator);
  numerator_ = numerator;
  denominator_ = denominator;
}

std::optional<std::uint64_t> TickDivision::go_behind(std::uint64_t step) noexcept {
  // step * denominator_ = ticks * numerator_ + rest, bit by bit: the product may have 83 bits
  std::uint64_t ticks = 0;
  std::int64_t rest = 0;
  for (int bit = 63; bit >= 0; --bit) {
    ticks *= 2;
    rest *= 2;
    if ((step >> static_cast<unsigned>(bit) & 1U) != 0) rest += denominator_;
    ticks += static_cast<std::uint64_t>(rest / numerator_);
    rest %= numerator_;
  }
  const std::int64_t passed = rest == 0 ? 0 : numerator_ - rest;
  if (passed >= denominator_) return std::nullopt;
  passed_ = passed;
  return rest == 0 ? ticks : ticks + 1;
}

}  // namespace cordis::sim
