// sim_node/plan/reach_limit.cpp
#include "sim_node/plan/reach_limit.h"

#include <algorithm>
#include <limits>
#include <utility>
#include <variant>

#include "sim_node/plan/plan.h"
#include "sim_node/plan/stability/slope.h"
#include "sim_node/plan/stability/stretch.h"

namespace cordis::plan {
namespace {

using engine::NetworkDescription;

bool is_certified(const NetworkDescription& network, const LiaisonGraph& graph) {
  if (network.integrator == engine::IntegratorKind::kModal)
    return stability_of(network, graph).holds();
  return !uncertainty_of(network, graph) && network.step < certified_bound(network, graph).step;
}

/// The energy up to which a state was followed within its reach [J].
double energy_followed(const engine::LinkState& state, double rest_length, bool turns,
                       const Reach& reach) {
  const double energy = energy_at(reach);
  if (!is_none(state.dissipation)) return energy;
  if (is_none(state.elasticity)) return std::numeric_limits<double>::infinity();
  if (reach.force == 0.0) return energy;
  const Stretch stretch = stretch_within(state, rest_length, turns, reach);
  if (!stretch.confined) return energy;
  return energy + work_of_forces(reach, std::min(stretch.longer, stretch.shorter));
}

/// Likewise a liaison.
double energy_followed(const engine::StateMachine& state_machine, double rest_length, bool turns,
                       const Reach& reach) {
  double energy = std::numeric_limits<double>::infinity();
  for (const engine::LinkState& state : state_machine.states) {
    energy = std::min(energy, energy_followed(state, rest_length, turns, reach));
    const auto* balls = std::get_if<engine::LennardJones>(&state.elasticity);
    if (balls != nullptr) energy = std::min(energy, std::max(balls->well_depth, reach.energy));
  }
  return energy;
}

/// The least energy to which a law without a largest slope was followed.
ReachLimit limit_at(const NetworkDescription& network, const LiaisonGraph& graph, double factor) {
  const Reach reach = reach_of(network, factor);
  ReachLimit limit;
  limit.speed = reach.speed;
  const bool turns = network.dimension > 1;
  for (const Edge& edge : graph.edges) {
    if (edge.bounded) continue;
    const engine::StateLink& link = network.state_links[edge.liaison.index];
    const Reach here = reach_between(reach, network, {edge.mat_a}, {edge.mat_b});
    limit.energy = std::min(
        limit.energy,
        energy_followed(network.state_machines[link.state_machine], link.rest_length, turns, here));
  }
  for (const ContactBound& contact : graph.contacts) {
    if (contact.bounded) continue;
    const Reach here = reach_between(reach, network, contact.members, contact.others);
    const engine::SetLiaison& set = network.sets[contact.set];
    limit.pair_energy =
        std::min(limit.pair_energy, energy_followed(network.state_machines[set.state_machine],
                                                    std::max(set.rest_length, 0.0), turns, here));
  }
  return limit;
}

}  // namespace

ReachLimit reach_limit(const NetworkDescription& network) {
  constexpr double kStep = 4.0;
  constexpr double kLargest = 1e6;
  LiaisonGraph graph = liaison_graph(network);
  if (graph.bounded) return {};
  if (!is_certified(network, graph)) return {};
  double factor = 1.0;
  while (factor < kLargest) {
    LiaisonGraph wider = liaison_graph(network, kStep * factor);
    if (!is_certified(network, wider)) break;
    factor *= kStep;
    graph = std::move(wider);
  }
  return limit_at(network, graph, factor);
}

bool is_beyond(const ReachLimit& limit, const engine::World& world,
               const engine::Energy& energy) noexcept {
  if (limit.is_infinite()) return false;
  double most = 0.0;  // kinetic energies of the two MATs that have the most [J]
  double second = 0.0;
  const auto& mats = world.network().description().mats;
  for (std::uint32_t i = 0; i < mats.size(); ++i) {
    if (mats[i].kind == engine::MatKind::kFixed) continue;
    const double square = world.velocity(i).squaredNorm();
    if (mats[i].kind == engine::MatKind::kPort) {
      if (!(square <= limit.speed * limit.speed)) return true;
      continue;
    }
    const double kinetic = 0.5 * mats[i].mass * square;
    second = std::max(second, std::min(most, kinetic));
    most = std::max(most, kinetic);
  }
  const double whole = energy.kinetic + std::max(energy.elastic, 0.0);
  return !(whole <= limit.energy && most + second <= limit.pair_energy);
}

}  // namespace cordis::plan
