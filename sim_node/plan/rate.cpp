// sim_node/plan/rate.cpp
#include "sim_node/plan/rate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "sim_node/plan/plan.h"
#include "sim_node/plan/table_pulse.h"

namespace cordis::plan {
namespace {

constexpr double kPartOfTheCertifiedStep = 0.9;

/// The largest step at which a vibration, or what creeps, is within the tolerance, by its exact
/// roots; infinite for the other of the two.
template <class Error>
double largest_step(const BandEdge& edge, engine::IntegratorKind integrator, double tolerance,
                    Error error, bool OscillatorError::*applies) {
  const double w = 2.0 * std::numbers::pi * edge.frequency_hz;
  const bool creeps = 0.5 * edge.viscosity >= w;
  if (creeps != (applies == &OscillatorError::creeps)) {
    return std::numeric_limits<double>::infinity();
  }
  const auto within = [&](double step) {
    const OscillatorError reached = error_of(edge, edge.viscosity, step, integrator);
    return reached.*applies && std::abs(error(reached)) <= tolerance;
  };
  // What creeps may have steps far beyond the limit of `cordis`. An error may pass 0 and grow again, so all shorter
  // steps are to be within, too.
  const double longest = creeps ? 2.0 / w : limit_step(w * w, edge.viscosity);
  constexpr double kShortest = 1e-6;
  constexpr double kRatio = 1.05;
  double low = 0.0;
  double high = kShortest * longest;
  while (high < longest && within(high)) {
    low = high;
    high = std::min(high * kRatio, longest);
  }
  for (int n = 0; n < 60; ++n) {
    const double step = 0.5 * (low + high);
    (within(step) ? low : high) = step;
  }
  return low;
}

/// A pitch that is off by e puts a vibration off by the phase e w t, and its positions over the
/// amplitude by as much; 1 / sqrt(3) of that in the mean square up to t.
double pitch_tolerance(const BandEdge& edge, const AccuracyTarget& target) {
  if (target.over_s == 0.0) return target.tolerance;
  const double w = 2.0 * std::numbers::pi * edge.frequency_hz;
  return std::sqrt(3.0) * target.tolerance / (w * target.over_s);
}

/// A rate s that is off by e puts e^(-s t) off by e s t e^(-s t), at most e / 2.718.
double tolerance_of_rate(double rate, const AccuracyTarget& target) {
  if (target.over_s == 0.0) return target.tolerance;
  const double lost = std::min(1.0, rate * target.over_s);
  return lost > 0.0 ? target.tolerance / (lost * std::exp(-lost))
                    : std::numeric_limits<double>::infinity();
}

double decay_tolerance(const BandEdge& edge, const AccuracyTarget& target) {
  return tolerance_of_rate(0.5 * edge.viscosity, target);
}

double creep_tolerance(const BandEdge& edge, const AccuracyTarget& target) {
  const double w = 2.0 * std::numbers::pi * edge.frequency_hz;
  const double rate = 0.5 * edge.viscosity;
  if (rate < w) return target.tolerance;
  return tolerance_of_rate(w * w / (rate + std::sqrt(rate * rate - w * w)), target);
}

/// True if anything but fixed points and masses is fastened to the modes of a network.
bool loads_modes(const engine::NetworkDescription& network, const LiaisonGraph& graph) {
  const auto is_port = [&network](std::uint32_t mat) {
    return network.mats[mat].kind == engine::MatKind::kPort;
  };
  return !graph.contacts.empty() || std::ranges::any_of(graph.edges, [&](const Edge& edge) {
    return edge.liaison.kind != LiaisonKind::kLink || is_port(edge.mat_a) || is_port(edge.mat_b);
  });
}

/// The longest step [s] that modes are certified at, with what is fastened to them, of the multiples of a rate.
/// Each step has modes of its own. Where none is up to the highest rate, a step shorter than that of it.
double longest_modal_step(engine::NetworkDescription network, double gesture_rate_hz,
                          double highest_hz) {
  const auto is_certified = [&](double multiple) {
    network.step = 1.0 / (multiple * gesture_rate_hz);
    const Stability stability = stability_of(network, liaison_graph(network));
    return kPartOfTheCertifiedStep * stability.certified.step >= network.step;
  };
  double high = 1.0;
  for (; !is_certified(high); high *= 2.0) {
    if (high * gesture_rate_hz > highest_hz) return network.step;
  }
  double low = 0.5 * high;
  while (high - low > 1.0) {
    const double middle = std::floor(0.5 * (low + high));
    (is_certified(middle) ? high : low) = middle;
  }
  return 1.0 / (high * gesture_rate_hz);
}

}  // namespace

double multiple_from(double rate_hz, double unit_hz) noexcept {
  constexpr double kRounding = 1e-9;
  return std::ceil(rate_hz / unit_hz - kRounding) * unit_hz;
}

FormulaRate rate_by_formula(const engine::NetworkDescription& network, const AccuracyTarget& target,
                            double gesture_rate_hz) {
  engine::NetworkDescription per_gesture = network;
  per_gesture.step = 1.0 / gesture_rate_hz;
  const LiaisonGraph graph = liaison_graph(per_gesture);

  double step = per_gesture.step;
  FormulaRate formula;
  const auto consider = [&](double largest, RateReason reason) {
    if (largest >= step) return;
    step = largest;
    formula.reason = reason;
  };
  if (network.integrator != engine::IntegratorKind::kModal) {
    consider(kPartOfTheCertifiedStep * certified_bound(per_gesture, graph).step,
             RateReason::kStability);
  } else if (loads_modes(per_gesture, graph)) {
    consider(longest_modal_step(per_gesture, gesture_rate_hz, target.highest_hz),
             RateReason::kStability);
  }
  if (const auto contact = worst_contact_of(per_gesture, graph)) {
    const double most = 4.0 * target.contact_energy / (1.0 + target.contact_energy);
    consider(per_gesture.step * std::sqrt(most / contact->stiffness), RateReason::kContact);
  }
  if (const auto pulse = narrowest_pulse(per_gesture)) consider(pulse->width, RateReason::kPulse);
  const engine::IntegratorKind integrator = network.integrator;
  const auto consider_vibration = [&](const BandEdge& edge) {
    consider(largest_step(
                 edge, integrator, pitch_tolerance(edge, target),
                 [](const OscillatorError& e) { return e.pitch; }, &OscillatorError::oscillates),
             RateReason::kPitch);
    consider(largest_step(
                 edge, integrator, decay_tolerance(edge, target),
                 [](const OscillatorError& e) { return e.decay; }, &OscillatorError::oscillates),
             RateReason::kDecay);
    consider(largest_step(
                 edge, integrator, creep_tolerance(edge, target),
                 [](const OscillatorError& e) { return e.creep; }, &OscillatorError::creeps),
             RateReason::kCreep);
  };
  BandEdge edge = band_edge_of(per_gesture, graph, target.band_hz);
  consider_vibration(edge);
  for (const BandEdge& lighter : lighter_creeps(edge)) consider_vibration(lighter);
  if (edge.swinging) {
    edge.viscosity = edge.min_viscosity;
    consider_vibration(edge);
  }

  formula.needed_hz = 1.0 / step;
  formula.rate_hz = multiple_from(formula.needed_hz, gesture_rate_hz);
  return formula;
}

const char* to_string(RateReason reason) noexcept {
  switch (reason) {
    case RateReason::kGesture:
      return "the gesture rate, the lowest there is";
    case RateReason::kStability:
      return "the stability in every pose and state";
    case RateReason::kContact:
      return "the energy of its contacts";
    case RateReason::kPitch:
      return "the pitch at the end of the band";
    case RateReason::kDecay:
      return "the decay at the end of the band";
    case RateReason::kCreep:
      return "the creep at the end of the band";
    case RateReason::kPulse:
      return "the shortest pulse of a table";
  }
  return "";
}

}  // namespace cordis::plan
