// sim_node/plan/rate_selection.cpp
#include "sim_node/plan/rate_selection.h"

#include <cmath>
#include <optional>

#include "node/assert.h"
#include "sim_node/engine/integrators/integrator_limits.h"
#include "sim_node/plan/plan.h"
#include "sim_node/plan/rate_trial.h"
#include "sim_node/plan/reference/trial_run.h"

namespace cordis::plan {
namespace {

constexpr const char* kOfBends = "the energy that bends and contacts may gain";

/// A rate at which it is certain that the network is stable, from this one on to eight times that: a shorter step
/// makes the K' of a bend smaller. This one itself where none is.
double certain_rate(engine::NetworkDescription network, double rate_hz, double gesture_rate_hz) {
  constexpr double kMaxTimes = 8.0;
  const LiaisonGraph graph = liaison_graph(network);
  const auto is_certain = [&](double rate) {
    network.step = 1.0 / rate;
    return !uncertainty_of(network, graph);
  };
  double low = std::round(rate_hz / gesture_rate_hz);  // in gesture rates, as the next
  double high = kMaxTimes * low;
  if (is_certain(rate_hz) || !is_certain(high * gesture_rate_hz)) return rate_hz;
  while (high - low > 1.0) {
    const double middle = std::floor(0.5 * (low + high));
    (is_certain(middle * gesture_rate_hz) ? high : low) = middle;
  }
  return high * gesture_rate_hz;
}

RateSelection select_for(engine::NetworkDescription network, const AccuracyTarget& target,
                         double gesture_rate_hz, const std::string& integrator, bool has_ports) {
  network.integrator = engine::integrator_named(integrator);
  const FormulaRate formula = rate_by_formula(network, target, gesture_rate_hz);
  RateSelection selection{integrator, formula.rate_hz, formula.needed_hz,
                          to_string(formula.reason)};
  if (target.over_s == 0.0) {
    const double certain_hz = certain_rate(network, formula.rate_hz, gesture_rate_hz);
    if (certain_hz > formula.rate_hz && certain_hz <= target.highest_hz) {
      selection.rate_hz = selection.needed_hz = certain_hz;
      selection.because = kOfBends;
    }
    const std::optional<Uncertainty> uncertainty = uncertainty_of(network, liaison_graph(network));
    if (uncertainty && uncertainty->leaves_variables_free()) {
      selection.uncertainty = "pitch and decay are those without what signals bring in";
      selection.unstable = uncertainty;
    }
    return selection;
  }
  if (has_ports) {
    selection.uncertainty =
        "positions are promised for free vibrations alone: its ports are played";
    return selection;
  }
  AccuracyTarget only_limits = target;
  only_limits.tolerance = 1e9;
  const FormulaRate floor = rate_by_formula(network, only_limits, gesture_rate_hz);
  const double lowest_hz = certain_rate(network, floor.rate_hz, gesture_rate_hz);
  const RateTrial trial =
      find_rate(network, integrator,
                {target.tolerance, target.over_s, lowest_hz, gesture_rate_hz, target.highest_hz});
  if (trial.rate_hz == 0.0) {
    selection.uncertainty = "positions are not promised: " + trial.refusal;
    return selection;
  }
  network.step = 1.0 / trial.rate_hz;
  selection.unstable = uncertainty_of(network, liaison_graph(network));
  if (selection.unstable) {
    selection.uncertainty =
        "positions are not promised: it is not certain that the scene is stable";
    return selection;
  }
  selection.rate_hz = selection.needed_hz = trial.rate_hz;
  selection.error = trial.error;
  if (trial.worst_body && trial.worst_body->error > target.tolerance)
    selection.worst_body = trial.worst_body;
  if (trial.rate_hz > lowest_hz) {
    selection.because = "the positions, as tried out";
  } else {
    selection.because = lowest_hz > floor.rate_hz ? kOfBends : to_string(floor.reason);
  }
  return selection;
}

}  // namespace

double cost_of_a_step(const std::string& integrator) {
  constexpr double kFactorisation = 50.0;
  const bool factorises = integrator == to_string(engine::IntegratorKind::kImplicit);
  return factorises ? kFactorisation : evaluations_per_step(integrator);
}

double cost_of_a_step(engine::NetworkDescription network, const RateSelection& selection) {
  constexpr double kSolves = 15.0;  // in 1 dimension, where it factorises once
  network.integrator = engine::integrator_named(selection.integrator);
  network.step = 1.0 / selection.rate_hz;
  if (!engine::damps_implicitly(network)) return cost_of_a_step(selection.integrator);
  return network.dimension == 1 ? kSolves
                                : cost_of_a_step(to_string(engine::IntegratorKind::kImplicit));
}

RateSelection select_rate(const engine::NetworkDescription& network, const AccuracyTarget& target,
                          double gesture_rate_hz, const std::vector<std::string>& integrators,
                          bool has_ports) {
  CORDIS_ASSERT(!integrators.empty());
  std::optional<RateSelection> best;
  const auto cost = [&network](const RateSelection& selection) {
    return selection.rate_hz * cost_of_a_step(network, selection);
  };
  for (const std::string& integrator : integrators) {
    const RateSelection next = select_for(network, target, gesture_rate_hz, integrator, has_ports);
    const auto is_better = [&](const RateSelection& other) {
      const bool is_possible = next.rate_hz <= target.highest_hz;
      if (is_possible != (other.rate_hz <= target.highest_hz)) return is_possible;
      if (next.uncertainty.empty() != other.uncertainty.empty()) return next.uncertainty.empty();
      return cost(next) < cost(other);
    };
    if (!best || is_better(*best)) best = next;
  }
  return *best;
}

}  // namespace cordis::plan
