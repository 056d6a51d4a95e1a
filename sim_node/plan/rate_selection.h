// sim_node/plan/rate_selection.h -- the integrator and the rate that a scene gets for what it asks.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim_node/engine/description/network.h"
#include "sim_node/plan/rate.h"
#include "sim_node/plan/rate_trial.h"
#include "sim_node/plan/stability/liaison_graph.h"

namespace cordis::plan {

struct RateSelection {
  std::string integrator;
  double rate_hz = 0.0;    ///< a multiple of the gesture rate
  double needed_hz = 0.0;  ///< the least that serves
  std::string because;     ///< for a person: what asks for so much
  double error = -1.0;     ///< position error after over_s, as tried out; < 0: not tried
  /// Beside that: the body whose own motion is off by the most, where that is more than the tolerance.
  std::optional<OwnError> worst_body = {};
  std::string uncertainty = {};  ///< what is not promised, and why; empty when all is
  /// Where that is why: what keeps the scene from being certain.
  std::optional<Uncertainty> unstable = {};
};

/// Cost of a step of an integrator, in evaluations of all forces of `cordis`: about. A
/// step of `implicit` factorises and solves (docs/integrators.md).
double cost_of_a_step(const std::string& integrator);
/// Cost at this rate, where `leapfrog` may have to solve its dampers.
double cost_of_a_step(engine::NetworkDescription network, const RateSelection& selection);

/// The cheapest of the integrators for what is asked. By the formulas of rate_by_formula; with over_s,
/// a network that moves by itself is tried out (find_rate), within the limits of stability and of
/// contacts. One whose ports are played is not: the gesture is unknown beforehand. No rate is tried at
/// which its stability is not certain, if up to eight times the rate of the limits there is a certain one.
/// So it is without over_s.
/// Where there is none the rate of the formulas stays. That may be above the highest rate of the target,
/// where no integrator has a lower one.
/// @param integrators  by name, at least one
RateSelection select_rate(const engine::NetworkDescription& network, const AccuracyTarget& target,
                          double gesture_rate_hz, const std::vector<std::string>& integrators,
                          bool has_ports);

}  // namespace cordis::plan
