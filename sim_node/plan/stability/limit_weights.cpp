// sim_node/plan/stability/limit_weights.cpp
#include "sim_node/plan/stability/limit_weights.h"

#include <cmath>

#include "sim_node/engine/integrators/integrator_limits.h"

namespace cordis::plan {

using engine::IntegratorKind;

namespace {

/// Stable while 3.852 M - dt^2 K > 0. Surely diverging beyond B(Z') M - dt^2 K > 0: there the form
/// of the scheme at the root -1 has changed its sign. B is convex, hence below its chord from Z' = 0
/// to the largest Z' of the network. What opposes the motion and is extrapolated beside it only makes it
/// worse. What drives the motion does not: StartTangent holds its ends.
void weigh_implicit_damping(const engine::NetworkDescription& network, LimitWeights& weights,
                            Limit limit) {
  if (limit == Limit::kDiverging) {
    const double most = engine::largest_damping(network);
    weights.link_viscosity = -0.5 * (engine::implicit_damping_limit(most) - 4.0) / most;
    weights.viscosity = 0.0;
    return;
  }
  const double share = 4.0 / engine::kImplicitDampingLimit;
  weights.link_viscosity = 0.0;
  weights.link_stiffness = weights.stiffness = share;
  weights.viscosity *= share;
}

}  // namespace

LimitWeights limit_weights(const engine::NetworkDescription& network, Limit limit) {
  constexpr double kSurelyDiverging = 5.0269;  // w dt of symplectic4
  LimitWeights weights;
  switch (network.integrator) {
    case IntegratorKind::kCordis:
      break;
    case IntegratorKind::kLeapfrog:  // 4 M - dt^2 K - 4 dt Z > 0
      weights.link_viscosity = weights.viscosity = 2.0;
      if (engine::damps_implicitly(network)) weigh_implicit_damping(network, weights, limit);
      for (const double step : engine::largest_extrapolated_steps(network)) {
        weights.solved.push_back(network.step > step ? 1 : 0);
      }
      break;
    case IntegratorKind::kSymplectic4: {  // w dt below these, where `cordis` has 2
      const double most = limit == Limit::kStable ? engine::kSymplectic4Limit : kSurelyDiverging;
      weights.link_stiffness = weights.stiffness = 4.0 / (most * most);
      break;
    }
    case IntegratorKind::
        kModal:  // its linear links are exact; what drives them is checked by itself
      weights.link_stiffness = weights.link_viscosity = 0.0;
      break;
    case IntegratorKind::
        kImplicit:  // 4 M + dt^2 K + 2 dt Z, of linear links, less that of all others
      weights.link_stiffness = weights.link_viscosity = limit == Limit::kStable ? 0.0 : -1.0;
      break;
  }
  return weights;
}

std::vector<double> changing_steps(const engine::NetworkDescription& network) {
  if (network.integrator != IntegratorKind::kLeapfrog) return {};
  std::vector<double> steps = engine::largest_extrapolated_steps(network);
  steps.push_back(engine::largest_extrapolated_step(network));
  std::erase_if(steps, [](double step) { return !(step > 0.0 && std::isfinite(step)); });
  std::sort(steps.begin(), steps.end());
  return steps;
}

LiaisonGraph weighted(LiaisonGraph graph, const LimitWeights& weights) {
  for (Edge& edge : graph.edges) {
    const bool linear = edge.liaison.kind == LiaisonKind::kLink;
    edge.stiffness *= linear ? weights.link_stiffness : weights.stiffness;
    edge.viscosity *= linear ? weights.link_viscosity : weights.viscosity;
    if (edge.liaison.kind == LiaisonKind::kStateLink &&
        weights.viscosity_of_state_link(edge.liaison.index) == 0.0) {
      edge.viscosity = 0.0;
    }
  }
  for (ContactBound& contact : graph.contacts) {
    contact.stiffness *= weights.stiffness;
    contact.viscosity *= weights.viscosity;
  }
  for (ForceBound& force : graph.forces) {
    force.stiffness *= weights.stiffness;
    force.viscosity *= weights.viscosity;
  }
  for (double& viscosity : graph.medium_viscosity) viscosity *= weights.link_viscosity;
  return graph;
}

}  // namespace cordis::plan
