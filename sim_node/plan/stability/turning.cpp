// sim_node/plan/stability/turning.cpp
#include "sim_node/plan/stability/turning.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <tuple>

#include "sim_node/plan/stability/law_energy.h"
#include "sim_node/plan/stability/start_point.h"

namespace cordis::plan {
namespace {

using engine::LiaisonId;
using engine::LiaisonKind;
using engine::NetworkDescription;

constexpr double kNever = std::numeric_limits<double>::infinity();

/// What presses a spring by a quarter of its length from where its direction turns, or to there [J]. So far
/// its push over the length is a third of its stiffness.
double energy_of_spring(double stiffness, double length, bool to_the_end) {
  constexpr double kPressed = 0.25;
  const double way = to_the_end ? length : kPressed * length;
  return 0.5 * stiffness * way * way;
}

/// Likewise of any law, from sample to sample.
double energy_of_law(const engine::LinkState& state, const WayInwards& way, const Reach& reach) {
  constexpr double kCloser = 0.97;     // of the length, in each sample
  constexpr double kNearest = 1e-4;    // of the length at which it begins to push
  constexpr double kPart = 1.0 / 3.0;  // of the slope; a spring pressed by a quarter has it
  const double farthest = way.farthest - way.turns_at;
  double nearest = kNearest * kNearest * farthest;
  double energy = 0.0;
  double slope = 0.0;
  double push_before = 0.0;
  double length_before = farthest;
  for (double length = farthest; length > nearest; length *= kCloser) {
    const double distance = way.turns_at + length;
    const double push = -tension_at(state, distance, way.rest_length, reach).low;
    if (!std::isfinite(push)) return kNever;
    if (push > 0.0) nearest = std::max(nearest, kNearest * length);
    const double nearer = length_before - length;
    if (nearer > 0.0) slope = std::max(slope, (push - push_before) / nearer);
    energy = std::max(energy + 0.5 * (push + push_before) * nearer, 0.0);
    if (!way.passes && slope > 0.0 && push > kPart * slope * length) return energy;
    push_before = push;
    length_before = length;
  }
  // What grows without an end lets nothing through.
  constexpr double kEndless = 0.1;
  const bool comes_there = push_before > 0.0 && push_before * length_before < kEndless * energy;
  return comes_there && (way.passes || slope == 0.0) ? energy : kNever;
}

double energy_of_state(const engine::LinkState& state, const WayInwards& way, const Reach& reach) {
  if (!state.pushes) return kNever;
  if (!is_none(state.elasticity) || std::isfinite(state.force_limit))
    return way.farthest > way.turns_at ? energy_of_law(state, way, reach) : kNever;
  const double length = way.rest_length - way.turns_at;
  if (!(state.stiffness > 0.0 && length > 0.0)) return kNever;
  return energy_of_spring(state.stiffness, length, way.passes);
}

double mass_of(const NetworkDescription& network, std::uint32_t mat) noexcept {
  const engine::Mat& end = network.mats[mat];
  return end.kind == engine::MatKind::kMass ? end.mass : 0.0;
}

/// energy_of_turning() of links with states: found once for all that are alike but for rounding.
class TurningOfLinks {
 public:
  explicit TurningOfLinks(const NetworkDescription& network) : network_(network) {}

  double energy_of(const engine::StateLink& link, const Reach& reach) {
    const Key key{link.state_machine, static_cast<float>(link.rest_length), reach.mass_a.high,
                  reach.mass_b.high};
    const auto found = known_.find(key);
    if (found != known_.end()) return found->second;
    const double farthest = std::max(reach.elongation, link.rest_length);
    const WayInwards way{.rest_length = link.rest_length, .farthest = farthest};
    const auto& state_machine = network_.state_machines[link.state_machine];
    return known_.emplace(key, energy_of_turning(state_machine, way, reach)).first->second;
  }

 private:
  using Key = std::tuple<std::uint32_t, float, double, double>;

  const NetworkDescription& network_;
  std::map<Key, double> known_;
};

}  // namespace

double energy_of_turning(const engine::StateMachine& state_machine, const WayInwards& way,
                         const Reach& reach) {
  double least = kNever;
  if (!std::isfinite(way.turns_at)) return least;
  for (const engine::LinkState& state : state_machine.states)
    least = std::min(least, energy_of_state(state, way, reach));
  return least;
}

void add_turning(LiaisonId liaison, double energy, const Reach& reach, Turning& turning) {
  if (std::isinf(energy) || (reach.mass_a.high == 0.0 && reach.mass_b.high == 0.0)) return;
  turning.energy = std::min(turning.energy, energy);
  const double share = energy > 0.0 ? energy_at(reach) / energy : kNever;
  if (turning.weakest && share < turning.share) return;
  turning.share = share;
  turning.weakest = liaison;
  if (share >= 1.0) turning.liaison = liaison;
}

void Turning::swing(double times) noexcept {
  energy /= times;
  share *= times;
  if (share >= 1.0) liaison = weakest;
}

Turning turning_of(const NetworkDescription& network, const Reach& reach) {
  Turning turning;
  if (network.dimension == 1 || network.integrator == engine::IntegratorKind::kModal)
    return turning;
  const auto between = [&](std::uint32_t mat_a, std::uint32_t mat_b) {
    const double mass_a = mass_of(network, mat_a);
    const double mass_b = mass_of(network, mat_b);
    Reach here = reach;
    here.mass_a = {mass_a, mass_a};
    here.mass_b = {mass_b, mass_b};
    return here;
  };
  std::uint32_t index = 0;
  for (const engine::Link& link : network.links) {
    const bool pushes = link.stiffness > 0.0 && link.rest_length > 0.0;
    const double energy =
        pushes ? energy_of_spring(link.stiffness, link.rest_length, /*to_the_end=*/false) : kNever;
    add_turning({LiaisonKind::kLink, index++}, energy, between(link.mat_a, link.mat_b), turning);
  }
  index = 0;
  TurningOfLinks known(network);
  for (const engine::StateLink& link : network.state_links) {
    const Reach here = between(link.mat_a, link.mat_b);
    add_turning({LiaisonKind::kStateLink, index++}, known.energy_of(link, here), here, turning);
  }
  return turning;
}

}  // namespace cordis::plan
