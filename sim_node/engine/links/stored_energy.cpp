// sim_node/engine/links/stored_energy.cpp
#include "sim_node/engine/links/stored_energy.h"

#include <algorithm>
#include <cmath>

namespace cordis::engine {
namespace {

/// Integral from 0 to the argument of a function that is linear between its points.
double area_up_to(const Table& table, double argument) noexcept {
  const auto value_at = [&](std::size_t i, double x) {
    const double slope = (table.value[i] - table.value[i - 1]) / (table.at[i] - table.at[i - 1]);
    return table.value[i - 1] + slope * (x - table.at[i - 1]);
  };
  const double low = std::min(0.0, argument);
  const double high = std::max(0.0, argument);
  double area = 0.0;
  if (low < table.at.front()) {
    area += table.value.front() * (std::min(high, table.at.front()) - low);
  }
  for (std::size_t i = 1; i < table.at.size(); ++i) {
    const double from = std::max(low, table.at[i - 1]);
    const double to = std::min(high, table.at[i]);
    if (from < to) area += 0.5 * (value_at(i, from) + value_at(i, to)) * (to - from);
  }
  if (high > table.at.back()) area += table.value.back() * (high - std::max(low, table.at.back()));
  return argument < 0.0 ? -area : area;
}

double power_energy(const Law& law, double elongation) noexcept {
  const double size = std::abs(elongation);
  auto half_powers = static_cast<unsigned>(2.0 * law.exponent) + 2;
  double power = (half_powers & 1U) != 0 ? std::sqrt(size) : 1.0;
  for (half_powers >>= 1; half_powers != 0; --half_powers) power *= size;
  return law.coefficient * power / (law.exponent + 1.0);
}

double lennard_jones_energy(const Law& law, double distance) noexcept {
  const auto of = [&law](double d) {
    const double ratio = law.diameter / d;
    const double cube = ratio * ratio * ratio;
    return 4.0 * law.depth * (cube * cube * cube * cube - cube * cube);
  };
  const double size = std::abs(distance);
  if (size == 0.0 || (law.cut > 0.0 && !(size < law.cut))) return 0.0;
  return law.cut > 0.0 ? of(size) - of(law.cut) : of(size);
}

double ring_energy(const Law& law, double distance) noexcept {
  double sum = 0.0;
  for (const Ring& ring : law.rings) {
    if (distance < ring.radius) {
      sum += 0.5 * ring.stiffness * (ring.radius - distance) * (ring.radius - distance);
    }
  }
  return sum;
}

}  // namespace

double stored_energy(const Law& law, double distance, double elongation) noexcept {
  switch (law.kind) {
    case Law::Kind::kTable:
      return area_up_to(law.table, elongation);
    case Law::Kind::kPower:
      return power_energy(law, elongation);
    case Law::Kind::kLennardJones:
      return lennard_jones_energy(law, distance);
    case Law::Kind::kRings:
      return ring_energy(law, distance);
    case Law::Kind::kNone:
    case Law::Kind::kExpression:
      break;
  }
  return 0.0;
}

}  // namespace cordis::engine
