// sim_node/plan/rate_sweep.cpp
#include "sim_node/plan/rate_sweep.h"

#include <algorithm>
#include <cmath>

#include "node/assert.h"

namespace cordis::plan {
namespace {

/// The largest of 1, 2, 5, 10, 20, ... that is not above the value.
double round_below(double value) {
  const double decade = std::pow(10.0, std::floor(std::log10(value)));
  for (const double digit : {5.0, 2.0}) {
    if (digit * decade <= value) return digit * decade;
  }
  return decade;
}

/// The smallest of 1, 2, 5, 10, 20, ... that is not below the value.
double round_above(double value) {
  const double below = round_below(value);
  if (below >= value) return below;
  const double digit = below / std::pow(10.0, std::floor(std::log10(below)));
  return below * (digit > 1.5 && digit < 2.5 ? 2.5 : 2.0);
}

bool is_multiple(double value, double base) {
  constexpr double kRounding = 1e-9;
  const double times = value / base;
  return times >= 0.5 && std::abs(times - std::round(times)) < kRounding * times;
}

}  // namespace

RateSweep make_rate_sweep(double limit_hz, const RateSweepOptions& options) {
  CORDIS_ASSERT(limit_hz >= 0.0);
  constexpr double kLowest = 0.35;  // of the limit, half of the lowest rate
  constexpr double kNoLimit = 0.1;  // of the scene's own rate, likewise
  double base = round_below(limit_hz > 0.0 ? kLowest * limit_hz : kNoLimit * options.own_hz);
  // A run of few periods of the base has too few samples; begin higher, where that is still below the limit.
  const double fewest = round_above(kFewestSamples / options.duration);
  if (base < fewest && 2.0 * fewest <= limit_hz) base = fewest;
  const double lowest = 2.0 * base;
  for (int finer = 0; finer < 9 && !is_multiple(options.own_hz, base); ++finer) {
    const double next = round_below(0.999 * base);
    if (base >= fewest && next < fewest) break;
    base = next;
  }
  const double highest = options.highest_factor * std::max(limit_hz, lowest);
  RateSweep sweep;
  for (double rate = 2.0 * base; rate <= highest; rate *= 2.0) {
    if (rate >= 0.7 * lowest) sweep.rates_hz.push_back(rate);
    const bool between = !options.coarse && 1.5 * rate >= 0.7 * lowest && 1.5 * rate <= highest;
    if (between) sweep.rates_hz.push_back(1.5 * rate);
  }
  const auto is_there = [&](double rate) {
    return std::find(sweep.rates_hz.begin(), sweep.rates_hz.end(), rate) != sweep.rates_hz.end();
  };
  if (is_multiple(options.own_hz, base) && !is_there(options.own_hz)) {
    sweep.rates_hz.push_back(options.own_hz);
    std::sort(sweep.rates_hz.begin(), sweep.rates_hz.end());
  }
  const double periods = std::max(1.0, std::ceil(options.duration * base - 1e-9));
  const double stride = std::ceil(periods / options.max_samples);
  sweep.sampling = {stride / base, static_cast<int>(std::ceil(periods / stride))};
  return sweep;
}

}  // namespace cordis::plan
