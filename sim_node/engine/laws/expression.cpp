// sim_node/engine/laws/expression.cpp
#include "sim_node/engine/laws/expression.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "sim_node/engine/core/require.h"
#include "sim_node/engine/laws/quadrature.h"
#include "sim_node/engine/laws/scalar_tension.h"

namespace cordis::engine {
namespace {

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

}  // namespace

bool is_known_to_laws(Quantity quantity) noexcept {
  switch (quantity) {
    case Quantity::kDistance:
    case Quantity::kElongation:
    case Quantity::kSpeed:
    case Quantity::kMassA:
    case Quantity::kMassB:
      return true;
    default:
      return false;
  }
}

bool is_known_to_laws(const Program& program) noexcept {
  return std::ranges::all_of(program.code, [](const Instruction& instruction) {
    return instruction.operation != Operation::kQuantity || is_known_to_laws(instruction.quantity);
  });
}

void Expression::check(const std::string& name) const {
  const std::string what = name + ": expression";
  check_program(program, what);
  require(!has_edge(program), what, "one without rising and falling");
  require(is_known_to_laws(program), what + ": quantity",
          "distance, elongation, speed, or the mass of an end");
}

double Expression::distance_of_no_potential(const LawPoint& link) const noexcept {
  const double rest_length = link.distance - link.elongation;
  if (asks_for(program, Quantity::kElongation)) return rest_length;
  LinkQuantities quantities{};
  quantities[static_cast<std::size_t>(Quantity::kMassA)] = link.mass_a;
  quantities[static_cast<std::size_t>(Quantity::kMassB)] = link.mass_b;
  const auto tension = [&](double distance) {
    quantities[static_cast<std::size_t>(Quantity::kDistance)] = distance;
    return value_of(program, quantities);
  };
  // Rounded, so that all distances of a link, whose rest lengths differ by rounding, have one zero.
  const auto place = static_cast<double>(static_cast<float>(rest_length));
  if (const auto nearest = nearest_zero(tension, place)) return *nearest;
  if (std::isfinite(tension(0.0))) return 0.0;
  return link.distance < 0.0 ? -1.0 : 1.0;
}

double Expression::potential(const LawPoint& link) const noexcept {
  const double rest_length = link.distance - link.elongation;
  const auto tension = [&](double argument) {
    return scalar_tension(*this, {argument, argument - rest_length, 0.0, link.mass_a, link.mass_b},
                          argument);
  };
  return integral_over_distance(tension, distance_of_no_potential(link), link.distance);
}

/// The largest rise between two samples.
LawSlope Expression::largest_slope(const LawRange& range) const noexcept {
  const auto tension = [&](double argument) {
    LawPoint point{range.rest_length, 0.0, argument, range.mass, range.mass};
    if (!range.viscous)
      point = {argument + range.rest_length, argument, 0.0, range.mass, range.mass};
    return scalar_tension(*this, point, argument);
  };
  LawSlope slope{0.0, false};
  const double step = 2.0 * range.argument / range.samples;
  for (int i = 0; i < range.samples && step > 0.0; ++i) {
    const double argument = -range.argument + step * i;
    const double rise = (tension(argument + step) - tension(argument)) / step;
    if (std::isfinite(rise)) slope.value = std::max(slope.value, rise);
  }
  return slope;
}

}  // namespace cordis::engine
