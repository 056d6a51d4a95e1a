// sim_node/plan/limit_weights.h -- what stiffness and viscosity count for in the limit of each
// integrator.
#pragma once

#include "sim_node/engine/network.h"
#include "sim_node/plan/liaison_graph.h"

namespace cordis::plan {

/// Factors on stiffnesses and viscosities with which every integrator is stable just where
/// `cordis` is: dt^2 K + 2 dt Z below 4 M, in all directions.
struct LimitWeights {
  double link_stiffness = 1.0;  ///< of linear links
  double link_viscosity = 1.0;  ///< of linear links and the medium
  double stiffness = 1.0;       ///< of all others
  double viscosity = 1.0;
};

/// At the step of the network, on which the treatment of dampers by `leapfrog` depends.
LimitWeights limit_weights(const engine::NetworkDescription& network);

/// The graph with the weights on it.
LiaisonGraph weighted(LiaisonGraph graph, const LimitWeights& weights);

/// `leapfrog` takes dampers apart beyond some step: up to there its limit is one, beyond another.
/// @param limit  of a network at its step: the step at which it ends being stable
/// @return the limit that a network comes to as its step grows, or the one beyond when its step is
///         there already
template <class Limit>
auto limit_of_all_steps(const engine::NetworkDescription& network, Limit limit) {
  const double most = engine::largest_extrapolated_step(network);
  if (network.integrator != engine::Integrator::kLeapfrog || network.step > most) {
    return limit(network);
  }
  auto extrapolated = limit(network);
  if (!(extrapolated.step > most)) return extrapolated;
  engine::NetworkDescription in_sweeps = network;
  in_sweeps.step = most * (1.0 + 1e-9);
  return limit(in_sweeps);
}

}  // namespace cordis::plan
