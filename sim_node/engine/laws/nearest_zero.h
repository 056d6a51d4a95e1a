// sim_node/engine/laws/nearest_zero.h -- where a function of a distance vanishes.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace cordis::engine {

/// False where a function has a pole: it is the larger, the nearer.
template <class Function>
bool vanishes_or_steps_at(const Function& f, double place) noexcept {
  constexpr double kNear = 1e-9;
  constexpr double kFar = 1e-3;
  const auto beside = [&](double part) {
    return std::max(std::abs(f(place * (1.0 - part))), std::abs(f(place * (1.0 + part))));
  };
  return beside(kNear) <= 2.0 * beside(kFar);
}

/// Where a function changes its sign within an interval, by halving.
template <class Function>
double sign_change_within(const Function& f, double low, double high) noexcept {
  constexpr int kHalvings = 60;
  const bool sign_at_low = std::signbit(f(low));
  for (int n = 0; n < kHalvings; ++n) {
    const double middle = 0.5 * (low + high);
    const double value = f(middle);
    if (value == 0.0) return middle;
    (std::signbit(value) == sign_at_low ? low : high) = middle;
  }
  return low;
}

/// The zero of a function of the distance that is nearest to a place, as a ratio, on its side of 0. Looks
/// for changes of sign from 1e-4 to 1e4 times the place, or of 1 m where the place is 0. Where the function is
/// not finite it has none.
template <class Function>
std::optional<double> nearest_zero(const Function& f, double place) noexcept {
  constexpr double kRatio = 1.3;
  constexpr int kPlaces = 35;
  const double start = place == 0.0 ? 1.0 : place;
  const double first_value = f(start);
  if (first_value == 0.0 && vanishes_or_steps_at(f, start)) return start;
  struct Search {
    double ratio;
    double distance;
    double value;
  };
  std::array<Search, 2> outward{Search{kRatio, start, first_value},
                                Search{1.0 / kRatio, start, first_value}};
  for (int n = 0; n < kPlaces; ++n) {
    for (Search& search : outward) {
      const double before = search.distance;
      const double value_before = search.value;
      search.distance *= search.ratio;
      search.value = f(search.distance);
      if (!std::isfinite(search.value) || !std::isfinite(value_before)) continue;
      const bool changes = std::signbit(search.value) != std::signbit(value_before);
      if (search.value != 0.0 && !changes) continue;
      const double zero =
          search.value == 0.0 ? search.distance : sign_change_within(f, before, search.distance);
      if (vanishes_or_steps_at(f, zero)) return zero;
    }
  }
  return std::nullopt;
}

}  // namespace cordis::engine
