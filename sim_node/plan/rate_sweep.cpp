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

struct Moment {
  double time = 0.0;   // [s]
  double group = 0.0;  // [Hz]
};

/// Steps of a rate up to the end, one in each of equal parts of the time, by the golden ratio.
void add_uneven(double rate, double duration, int most, std::vector<Moment>& moments) {
  constexpr double kGolden = 0.6180339887498949;
  const double steps = std::max(1.0, std::ceil(duration * rate - 1e-9));
  const double count = std::min(steps, static_cast<double>(most));
  for (double part = 0.0; part < count - 1.0; part += 1.0) {
    const double place = part + std::fmod(part * kGolden, 1.0);
    moments.push_back({(1.0 + std::floor(place * steps / count)) / rate, rate});
  }
  moments.push_back({steps / rate, rate});
}

/// One group of moments for all rates that are multiples of one that resolves every vibration; one of
/// its own for each other rate.
Sampling uneven_sampling(const std::vector<double>& rates_hz, double resolving_hz,
                         const RateSweepOptions& options) {
  std::vector<Moment> moments;
  for (const double rate : rates_hz) {
    const bool is_served = std::ranges::any_of(rates_hz, [&](double lower) {
      return lower >= resolving_hz && lower < rate && is_multiple(rate, lower);
    });
    if (!is_served) add_uneven(rate, options.duration, options.max_samples, moments);
  }
  std::ranges::stable_sort(moments, {}, &Moment::time);
  Sampling sampling;
  sampling.resolving_hz = resolving_hz;
  for (const Moment& moment : moments) {
    sampling.moments.push_back(moment.time);
    sampling.groups_hz.push_back(moment.group);
  }
  return sampling;
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
  sweep.sampling =
      periods < kFewestSamples
          ? even_sampling(1.0 / base, static_cast<int>(periods))
          : uneven_sampling(sweep.rates_hz, std::max(limit_hz, options.resolving_hz), options);
  return sweep;
}

}  // namespace cordis::plan
