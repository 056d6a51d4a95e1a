// sim_node/plan/stability/law_value.cpp
#include "sim_node/plan/stability/law_value.h"

#include <algorithm>
#include <cmath>

namespace cordis::plan {
namespace {

using engine::Law;

double of_table(const engine::Table& table, double argument) {
  const auto& at = table.at;
  const auto i =
      static_cast<std::size_t>(std::upper_bound(at.begin(), at.end(), argument) - at.begin());
  if (i == 0) return table.value.front();
  if (i == at.size()) return table.value.back();
  const double share = (argument - at[i - 1]) / (at[i] - at[i - 1]);
  return table.value[i - 1] + share * (table.value[i] - table.value[i - 1]);
}

double of_power(const Law& law, double argument) {
  if (argument == 0.0) return 0.0;
  return std::copysign(1.0, argument) * law.coefficient *
         std::pow(std::abs(argument), law.exponent);
}

}  // namespace

double elastic_pull(const Law& law, double distance, double elongation, double mass_a,
                    double mass_b) {
  switch (law.kind) {
    case Law::Kind::kNone:
      return 0.0;
    case Law::Kind::kTable:
      return of_table(law.table, elongation);
    case Law::Kind::kPower:
      return of_power(law, elongation);
    case Law::Kind::kLennardJones: {
      if (distance <= 0.0 || (law.cut > 0.0 && distance >= law.cut)) return 0.0;
      const double sixth = std::pow(law.diameter / distance, 6.0);
      return -24.0 * law.depth * (2.0 * sixth * sixth - sixth) / distance;
    }
    case Law::Kind::kRings: {
      double pull = 0.0;
      for (const engine::Ring& ring : law.rings) {
        if (distance < ring.radius) pull -= ring.stiffness * (ring.radius - distance);
      }
      return pull;
    }
    case Law::Kind::kExpression:
      return engine::expression_pull(law.expression, distance, elongation, 0.0, mass_a, mass_b);
  }
  return 0.0;
}

double viscous_pull(const Law& law, double distance, double elongation, double speed, double mass_a,
                    double mass_b) {
  switch (law.kind) {
    case Law::Kind::kTable:
      return of_table(law.table, speed);
    case Law::Kind::kPower:
      return of_power(law, speed);
    case Law::Kind::kExpression:
      return engine::expression_pull(law.expression, distance, elongation, speed, mass_a, mass_b);
    case Law::Kind::kNone:
    case Law::Kind::kLennardJones:
    case Law::Kind::kRings:
      return 0.0;
  }
  return 0.0;
}

}  // namespace cordis::plan
