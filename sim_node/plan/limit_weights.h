// sim_node/plan/limit_weights.h -- what stiffness and viscosity count for in the limit of each
// integrator.
#pragma once

#include "sim_node/engine/network.h"
#include "sim_node/plan/liaison_graph.h"
#include "sim_node/plan/step_bound.h"

namespace cordis::plan {

/// Factors on stiffnesses and viscosities with which every integrator is stable just where
/// `cordis` is: dt^2 K + 2 dt Z below 4 M, in all directions.
struct LimitWeights {
  double link_stiffness = 1.0;  ///< of linear links
  double link_viscosity = 1.0;  ///< of linear links and the medium
  double stiffness = 1.0;       ///< of all others
  double viscosity = 1.0;
};

/// For which of the two limits: up to it surely stable, or beyond it surely diverging. Those of
/// `symplectic4` differ: between w dt = 3.1635 and 5.0269 a vibration may grow by resonance, by at
/// most 0.24 % a step, near 3.166. So do those of `implicit`, whose implicit part makes the
/// explicit one more stable.
enum class Limit { kStable, kDiverging };

/// At the step of the network, on which the treatment of dampers by `leapfrog` depends.
LimitWeights limit_weights(const engine::NetworkDescription& network, Limit limit);

/// The graph with the weights on it.
LiaisonGraph weighted(LiaisonGraph graph, const LimitWeights& weights);

inline double step_of(double step) {
  return step;
}
inline double step_of(const StepBound& bound) {
  return bound.step;
}

/// `leapfrog` takes dampers apart beyond some step: up to there its limit is one, beyond another.
/// @param limit_of  a network at its step: the step at which it ends being stable
/// @return the limit that a network comes to as its step grows, or the one beyond when its step is
///         there already
template <class LimitOf>
auto limit_of_all_steps(const engine::NetworkDescription& network, LimitOf limit_of) {
  const double most = engine::largest_extrapolated_step(network);
  if (network.integrator != engine::Integrator::kLeapfrog || network.step > most) {
    return limit_of(network);
  }
  auto extrapolated = limit_of(network);
  if (!(step_of(extrapolated) > most)) return extrapolated;
  engine::NetworkDescription in_sweeps = network;
  in_sweeps.step = most * (1.0 + 1e-9);
  return limit_of(in_sweeps);
}

}  // namespace cordis::plan
