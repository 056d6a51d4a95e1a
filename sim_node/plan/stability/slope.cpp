// sim_node/plan/stability/slope.cpp
#include "sim_node/plan/stability/slope.h"

#include <algorithm>
#include <cmath>

namespace cordis::plan {
namespace {

constexpr double kMinSpeed = 1.0;  // [m/s]

}  // namespace

Slope largest_slope(const engine::StateMachine& state_machine, double rest_length, int dimension,
                    const Reach& reach) {
  engine::LawRange elastic{reach.elongation, rest_length, reach.energy};
  elastic.turns = dimension > 1;
  engine::LawRange viscous{reach.speed, rest_length};
  viscous.viscous = true;
  Slope largest;
  for (const engine::LinkState& state : state_machine.states) {
    const engine::LawSlope spring = engine::largest_slope(state.elasticity, elastic);
    const engine::LawSlope damper = engine::largest_slope(state.dissipation, viscous);
    largest.stiffness = std::max(largest.stiffness, state.stiffness + spring.value);
    largest.viscosity = std::max(largest.viscosity, state.viscosity + damper.value);
    largest.bounded = largest.bounded && spring.bounded && damper.bounded;
  }
  return largest;
}

Tangent stiffest_tangent(const engine::StateMachine& state_machine, double rest_length,
                         double distance) {
  const double elongation = distance - rest_length;
  const double nearby = 1e-6 * std::max(std::abs(distance), 1e-6);
  const auto rise = [nearby](const auto& pull, double at) {
    return (pull(at + nearby) - pull(at - nearby)) / (2.0 * nearby);
  };
  Tangent stiffest;
  for (const engine::LinkState& state : state_machine.states) {
    const auto elastic = [&](double e) {
      return elastic_pull(state.elasticity, {e + rest_length, e});
    };
    const auto viscous = [&](double speed) {
      return viscous_pull(state.dissipation, {distance, 0.0, speed});
    };
    stiffest.stiffness = std::max(stiffest.stiffness, state.stiffness + rise(elastic, elongation));
    stiffest.viscosity = std::max(stiffest.viscosity, state.viscosity + rise(viscous, 0.0));
  }
  const engine::LinkState& first = state_machine.states.front();
  if (state_machine.is_stateless()) {
    stiffest.pull = first.stiffness * elongation +
                    elastic_pull(first.elasticity, {elongation + rest_length, elongation});
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
