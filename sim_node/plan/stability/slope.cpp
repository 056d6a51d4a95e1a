// sim_node/plan/stability/slope.cpp
#include "sim_node/plan/stability/slope.h"

#include <algorithm>
#include <cmath>

#include "sim_node/plan/stability/law_value.h"

namespace cordis::plan {
namespace {

using engine::Law;

constexpr double kMinSpeed = 1.0;  // [m/s]
constexpr int kSamples = 400;      // of a law that is known by its values alone

/// Elastic laws take elongations and distances, viscous ones speeds.
struct Argument {
  double reach = 0.0;        // of the elongation or the speed
  double rest_length = 0.0;  // of elastic laws
  bool elastic = true;
  bool turns = true;  // a pull also has a slope across the link: pull / distance
};

double value(const Law& law, double argument, const Argument& about) {
  return about.elastic ? elastic_pull(law, argument + about.rest_length, argument)
                       : viscous_pull(law, about.rest_length, 0.0, argument);
}

Slope of_table(const Law& law, const Argument& about) {
  Slope slope;
  const auto& [at, pull] = law.table;
  for (std::size_t i = 0; i < at.size(); ++i) {
    if (i > 0)
      slope.stiffness = std::max(slope.stiffness, (pull[i] - pull[i - 1]) / (at[i] - at[i - 1]));
    const double distance = about.rest_length + at[i];
    if (about.turns && distance > 0.0)
      slope.stiffness = std::max(slope.stiffness, pull[i] / distance);
  }
  slope.bounded = !about.turns || pull.front() <= 0.0;  // else it pulls on as the ends meet
  return slope;
}

Slope of_power(const Law& law, const Argument& about) {
  if (law.exponent == 0.0 || law.coefficient <= 0.0) return {};  // a step has no tangent
  // The slope of a root has no end towards 0: below a hundredth of the reach it is not followed.
  constexpr double kNearest = 0.01;
  const double at = law.exponent < 1.0 ? kNearest * about.reach : about.reach;
  return {law.coefficient * law.exponent * std::pow(at, law.exponent - 1.0), 0.0,
          law.exponent == 1.0};
}

/// Of a pair that approaches with the energy E, in units of the depth: the turning point is at
/// (s/r)^6 = u = (1 + sqrt(1 + E)) / 2, and the law is stiffest there.
Slope of_lennard_jones(const Law& law, const Reach& reach) {
  if (law.depth <= 0.0) return {};
  const double energy = std::max(1.0, reach.energy / law.depth);
  const double u = 0.5 * (1.0 + std::sqrt(1.0 + energy));
  const double curvature = 4.0 * (156.0 * std::pow(u, 7.0 / 3.0) - 42.0 * std::pow(u, 4.0 / 3.0));
  return {curvature * law.depth / (law.diameter * law.diameter), 0.0, false};
}

Slope of_rings(const Law& law, const Argument& about) {
  Slope slope;
  for (const engine::Ring& inner : law.rings) {  // just inside this ring
    double stiffness = 0.0;
    double pull = 0.0;
    for (const engine::Ring& ring : law.rings) {
      if (ring.radius >= inner.radius) stiffness += ring.stiffness;
      if (ring.radius > inner.radius) pull -= ring.stiffness * (ring.radius - inner.radius);
    }
    slope.stiffness = std::max(slope.stiffness, stiffness);
    if (about.turns) slope.stiffness = std::max(slope.stiffness, pull / inner.radius);
  }
  return slope;
}

Slope of_expression(const Law& law, const Argument& about) {
  Slope slope{0.0, 0.0, false};
  const double step = 2.0 * about.reach / kSamples;
  for (int i = 0; i < kSamples && step > 0.0; ++i) {
    const double at = -about.reach + step * i;
    const double rise = (value(law, at + step, about) - value(law, at, about)) / step;
    if (std::isfinite(rise)) slope.stiffness = std::max(slope.stiffness, rise);
  }
  return slope;
}

/// As a stiffness; of a viscous law too.
Slope of_law(const Law& law, const Argument& about, const Reach& reach) {
  switch (law.kind) {
    case Law::Kind::kNone:
      return {};
    case Law::Kind::kTable:
      return of_table(law, about);
    case Law::Kind::kPower:
      return of_power(law, about);
    case Law::Kind::kLennardJones:
      return of_lennard_jones(law, reach);
    case Law::Kind::kRings:
      return of_rings(law, about);
    case Law::Kind::kExpression:
      return of_expression(law, about);
  }
  return {};
}

}  // namespace

Slope largest_slope(const engine::StateMachine& state_machine, double rest_length, int dimension,
                    const Reach& reach) {
  const Argument elastic{reach.elongation, rest_length, true, dimension > 1};
  const Argument viscous{reach.speed, rest_length, false, false};
  Slope largest;
  for (const engine::LinkState& state : state_machine.states) {
    const Slope spring = of_law(state.elasticity, elastic, reach);
    const Slope damper = of_law(state.dissipation, viscous, reach);
    largest.stiffness = std::max(largest.stiffness, state.stiffness + spring.stiffness);
    largest.viscosity = std::max(largest.viscosity, state.viscosity + damper.stiffness);
    largest.bounded = largest.bounded && spring.bounded && damper.bounded;
  }
  return largest;
}

Tangent stiffest_tangent(const engine::StateMachine& state_machine, double rest_length,
                         double distance) {
  const double elongation = distance - rest_length;
  const double nearby = 1e-6 * std::max(std::abs(distance), 1e-6);
  const Argument elastic{0.0, rest_length, true, false};
  const Argument viscous{0.0, distance, false, false};
  const auto rise = [&](const Law& law, double at, const Argument& about) {
    if (law.kind == Law::Kind::kNone) return 0.0;
    return (value(law, at + nearby, about) - value(law, at - nearby, about)) / (2.0 * nearby);
  };
  Tangent stiffest;
  for (const engine::LinkState& state : state_machine.states) {
    stiffest.stiffness =
        std::max(stiffest.stiffness, state.stiffness + rise(state.elasticity, elongation, elastic));
    stiffest.viscosity =
        std::max(stiffest.viscosity, state.viscosity + rise(state.dissipation, 0.0, viscous));
  }
  const engine::LinkState& first = state_machine.states.front();
  if (state_machine.is_stateless()) {
    stiffest.pull = first.stiffness * elongation + value(first.elasticity, elongation, elastic);
  }
  return stiffest;
}

Reach reach_of(const engine::NetworkDescription& network) {
  Reach reach;
  reach.speed = kMinSpeed;
  for (const engine::StateLink& link : network.state_links) {
    const double distance =
        (network.mats[link.mat_b].position - network.mats[link.mat_a].position).norm();
    reach.elongation = std::max({reach.elongation, distance, std::abs(link.rest_length)});
  }
  for (const engine::SetLiaison& set : network.sets) {
    reach.elongation = std::max(reach.elongation, set.range);
  }
  for (const engine::Mat& mat : network.mats) {
    if (mat.kind != engine::MatKind::kMass) continue;
    reach.speed = std::max(reach.speed, mat.velocity.norm());
    reach.energy = std::max(reach.energy, mat.mass * mat.velocity.squaredNorm());
  }
  return reach;
}

}  // namespace cordis::plan
