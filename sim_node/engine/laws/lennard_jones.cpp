// sim_node/engine/laws/lennard_jones.cpp
#include "sim_node/engine/laws/lennard_jones.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim_node/engine/core/require.h"

namespace cordis::engine {

void LennardJones::check(const std::string& name) const {
  require(is_finite_and_at_least_zero(well_depth), name + ": well depth", "finite and >= 0");
  require(std::isfinite(diameter) && diameter > 0.0, name + ": diameter", "finite and > 0");
  require(is_finite_and_at_least_zero(cutoff), name + ": cutoff", "finite and >= 0");
  const double cube = diameter * diameter * diameter;
  const double twelfth = cube * cube * cube * cube;
  require(std::isnormal(twelfth) && std::isfinite(well_depth * twelfth), name + ": diameter",
          "within the range of its 12th power");
}

LennardJones::Term LennardJones::term() const noexcept {
  const double cube = diameter * diameter * diameter;
  return {24.0 * well_depth * (cube * cube), 48.0 * well_depth * (cube * cube * cube * cube),
          cutoff > 0.0 ? cutoff : std::numeric_limits<double>::infinity()};
}

double LennardJones::potential(double distance, double /*elongation*/) const noexcept {
  const auto energy_at = [this](double d) {
    const double ratio = diameter / d;
    const double cube = ratio * ratio * ratio;
    return 4.0 * well_depth * (cube * cube * cube * cube - cube * cube);
  };
  const double size = std::abs(distance);
  if (size == 0.0 || (cutoff > 0.0 && !(size < cutoff))) return 0.0;
  return cutoff > 0.0 ? energy_at(size) - energy_at(cutoff) : energy_at(size);
}

/// The slope of a pair that approaches with the energy E, in units of the well depth: the turning point is at
/// (s/r)^6 = u = (1 + sqrt(1 + E)) / 2, and the law is stiffest there.
LawSlope LennardJones::largest_slope(const LawRange& range) const noexcept {
  if (well_depth <= 0.0) return {};
  const double energy = std::max(1.0, range.energy / well_depth);
  const double u = 0.5 * (1.0 + std::sqrt(1.0 + energy));
  const double curvature = 4.0 * (156.0 * std::pow(u, 7.0 / 3.0) - 42.0 * std::pow(u, 4.0 / 3.0));
  return {curvature * well_depth / (diameter * diameter), false};
}

double LennardJones::smallest_slope(double /*elongation*/) const noexcept {
  constexpr double kSlopeAtRest = 57.14628;  // 72 / 2^(1/3)
  return kSlopeAtRest * well_depth / (diameter * diameter);
}

}  // namespace cordis::engine
