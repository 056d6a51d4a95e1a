// sim_node/plan/stability/limit_weights.h -- what stiffness and viscosity count for in the limit of
// each integrator.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "sim_node/engine/description/network.h"
#include "sim_node/engine/integrators/integrator_limits.h"
#include "sim_node/engine/integrators/stiff_friction.h"
#include "sim_node/plan/stability/liaison_graph.h"
#include "sim_node/plan/stability/step_bound.h"

namespace cordis::plan {

/// Factors on stiffnesses and viscosities with which every integrator is stable just where
/// `cordis` is: dt^2 K + 2 dt Z below 4 M, in all directions.
struct LimitWeights {
  double link_stiffness = 1.0;  ///< factor for linear links
  double link_viscosity = 1.0;  ///< factor for linear links and the medium
  double stiffness = 1.0;       ///< factor for all others
  double viscosity = 1.0;
  std::vector<std::uint8_t> solved;  ///< by state link: solved for its speed; empty: none

  /// `viscosity`, but 0 where a link is solved for its speed.
  double viscosity_of_state_link(std::uint32_t link) const noexcept {
    return link < solved.size() && solved[link] != 0 ? 0.0 : viscosity;
  }
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

/// The steps beyond which `leapfrog` no longer extrapolates the velocity of some damper, ascending;
/// none for the others.
std::vector<double> changing_steps(const engine::NetworkDescription& network);

/// `leapfrog` takes dampers apart, and solves stiff links, beyond some steps: up to each there is
/// one limit, beyond it another, which is not nearer.
/// @param limit_of  a network at its step: the step at which it ends being stable
/// @return the limit that a network comes to as its step grows
template <class LimitOf>
auto limit_of_all_steps(const engine::NetworkDescription& network, LimitOf limit_of) {
  constexpr int kMaxRounds = 16;
  const std::vector<double> changes = changing_steps(network);
  auto limit = limit_of(network);
  engine::NetworkDescription varied;
  double before = network.step;
  for (int round = 0; round < kMaxRounds; ++round) {
    const auto after = std::lower_bound(changes.begin(), changes.end(), step_of(limit));
    if (after == changes.begin() || !(*(after - 1) >= before)) break;
    if (varied.mats.empty()) varied = network;
    before = varied.step = *(after - 1) * (1.0 + 1e-9);
    limit = limit_of(varied);
  }
  // The chord of weigh_implicit_damping depends on the step too.
  constexpr double kSettled = 1e-6;
  for (int round = 0; round < kMaxRounds && std::isfinite(step_of(limit)); ++round) {
    if (varied.mats.empty()) varied = network;
    const double reached = varied.step = step_of(limit);
    if (!engine::damps_implicitly(varied)) break;
    limit = limit_of(varied);
    if (std::abs(step_of(limit) - reached) <= kSettled * reached) break;
  }
  return limit;
}

}  // namespace cordis::plan
