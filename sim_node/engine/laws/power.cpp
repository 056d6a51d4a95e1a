// sim_node/engine/laws/power.cpp
#include "sim_node/engine/laws/power.h"

#include <cmath>

#include "sim_node/engine/core/require.h"

namespace cordis::engine {
namespace {

/// start * base^(half_powers / 2), one factor after the other.
double times_power(double start, double base, unsigned half_powers) noexcept {
  double power = (half_powers & 1U) != 0 ? start * std::sqrt(base) : start;
  for (half_powers >>= 1; half_powers != 0; --half_powers) power *= base;
  return power;
}

}  // namespace

void Power::check(const std::string& name) const {
  require(std::isfinite(coefficient), name + ": coefficient", "finite");
  require(
      exponent >= 0.0 && exponent <= kMaxExponent && 2.0 * exponent == std::floor(2.0 * exponent),
      name + ": exponent",
      "a multiple of 0.5 from 0 to 16, which is computed by multiplication and square root alone; "
      "an expression or a table has any other power");
}

double Power::potential(double /*distance*/, double elongation) const noexcept {
  const double power = times_power(1.0, std::abs(elongation), term().half_powers + 2);
  return coefficient * power / (exponent + 1.0);
}

LawSlope Power::largest_slope(const LawRange& range) const noexcept {
  if (coefficient <= 0.0) return {};
  const bool is_root = exponent < 1.0;
  if (exponent == 0.0) return {0.0, true, is_root};  // a step has no tangent
  // The slope of a root has no end towards 0: below a hundredth of the range it is not followed.
  constexpr double kNearest = 0.01;
  const double argument = is_root ? kNearest * range.argument : range.argument;
  return {coefficient * exponent * std::pow(argument, exponent - 1.0), exponent == 1.0, is_root};
}

double Power::smallest_slope(double elongation) const noexcept {
  return std::abs(times_power(coefficient / elongation, elongation, term().half_powers));
}

}  // namespace cordis::engine
