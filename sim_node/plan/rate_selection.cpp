// sim_node/plan/rate_selection.cpp
#include "sim_node/plan/rate_selection.h"

#include <optional>

#include "sim_node/engine/integrators/integrator_limits.h"
#include "sim_node/plan/rate_trial.h"
#include "sim_node/plan/reference/trial_run.h"

namespace cordis::plan {
namespace {

RateSelection choose_for(engine::NetworkDescription network, const AccuracyTarget& wish,
                         double gesture_rate_hz, const std::string& integrator, bool has_ports) {
  network.integrator = engine::integrator_named(integrator);
  const RateChoice formula = choose_rate(network, wish, gesture_rate_hz);
  RateSelection choice{
      integrator, formula.rate_hz, formula.needed_hz, to_string(formula.reason), -1.0, {}};
  if (wish.over_s == 0.0) return choice;
  if (has_ports) {
    choice.uncertainty = "positions are promised for free vibrations alone: its ports are played";
    return choice;
  }
  AccuracyTarget only_limits = wish;
  only_limits.tolerance = 1e9;
  const RateChoice floor = choose_rate(network, only_limits, gesture_rate_hz);
  const RateTrial trial =
      find_rate(network, integrator, {wish.tolerance, wish.over_s, floor.rate_hz, gesture_rate_hz});
  if (trial.rate_hz == 0.0) {
    choice.uncertainty = "positions are not promised: " + trial.refusal;
    return choice;
  }
  choice.rate_hz = choice.needed_hz = trial.rate_hz;
  choice.error = trial.error;
  choice.because =
      trial.rate_hz > floor.rate_hz ? "the positions, as tried out" : to_string(floor.reason);
  return choice;
}

}  // namespace

double cost_of_a_step(const std::string& integrator) {
  constexpr double kFactorisation = 50.0;
  const bool factorises = integrator == to_string(engine::IntegratorKind::kImplicit);
  return factorises ? kFactorisation : evaluations_per_step(integrator);
}

double cost_of_a_step(engine::NetworkDescription network, const RateSelection& choice) {
  constexpr double kSolves = 15.0;  // in 1 dimension, where it factorises once
  network.integrator = engine::integrator_named(choice.integrator);
  network.step = 1.0 / choice.rate_hz;
  if (!engine::damps_implicitly(network)) return cost_of_a_step(choice.integrator);
  return network.dimension == 1 ? kSolves
                                : cost_of_a_step(to_string(engine::IntegratorKind::kImplicit));
}

RateSelection choose(const engine::NetworkDescription& network, const AccuracyTarget& wish,
                     double gesture_rate_hz, const std::vector<std::string>& integrators,
                     bool has_ports) {
  std::optional<RateSelection> best;
  const auto cost = [&network](const RateSelection& choice) {
    return choice.rate_hz * cost_of_a_step(network, choice);
  };
  for (const std::string& integrator : integrators) {
    const RateSelection next = choose_for(network, wish, gesture_rate_hz, integrator, has_ports);
    const bool keeps_more = best && next.uncertainty.empty() && !best->uncertainty.empty();
    const bool keeps_less = best && !next.uncertainty.empty() && best->uncertainty.empty();
    if (!best || keeps_more || (!keeps_less && cost(next) < cost(*best))) best = next;
  }
  return *best;
}

}  // namespace cordis::plan
