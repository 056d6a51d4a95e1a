// sim_node/engine/laws/expression.cpp
#include "sim_node/engine/laws/expression.h"

#include <algorithm>
#include <cmath>

#include "sim_node/engine/core/require.h"
#include "sim_node/engine/laws/quadrature.h"
#include "sim_node/engine/laws/scalar_tension.h"

namespace cordis::engine {

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
  if (asks_for(program, Quantity::kElongation)) return link.distance - link.elongation;
  LinkQuantities at_zero{};
  at_zero[static_cast<std::size_t>(Quantity::kMassA)] = link.mass_a;
  at_zero[static_cast<std::size_t>(Quantity::kMassB)] = link.mass_b;
  if (std::isfinite(value_of(program, at_zero))) return 0.0;
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
