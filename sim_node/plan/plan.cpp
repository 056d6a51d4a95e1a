// sim_node/plan/plan.cpp
#include "sim_node/plan/plan.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "sim_node/engine/integrators/integrator_limits.h"
#include "sim_node/engine/integrators/modal_block.h"
#include "sim_node/engine/integrators/stiff_friction.h"
#include "sim_node/plan/stability/limit_weights.h"
#include "sim_node/plan/stability/start_point.h"
#include "sim_node/plan/stability/start_tangent.h"
#include "sim_node/plan/stability/touch_sum.h"

namespace cordis::plan {
namespace {

constexpr double kCertainBend = 1.0;  // K'

double lightest(const LiaisonGraph& graph, const std::vector<std::uint32_t>& mats) {
  double most = 0.0;  // of 1 / m
  for (const std::uint32_t mat : mats) most = std::max(most, graph.inverse_mass[mat]);
  return most;
}

/// The heaviest state link that `leapfrog` solves for its speed beside implicit dampers. It sees the
/// speed of these, which knows how the forces change: at the root -1 its friction is not 0, adds to a
/// spring where the dampers are light and takes from it where they are heavy. No limit is known then.
std::optional<std::uint32_t> friction_beside_dampers(const engine::NetworkDescription& network) {
  if (!engine::damps_implicitly(network)) return {};
  return engine::heaviest_solved_friction(network);
}

/// The first bend whose viscosity `leapfrog` would solve in a link, beside implicit dampers: it
/// extrapolates the speed instead, which knows how the forces change.
std::optional<std::uint32_t> bend_beside_dampers(const engine::NetworkDescription& network,
                                                 const LiaisonGraph& graph) {
  if (network.bends.empty() || !engine::damps_implicitly(network)) return {};
  std::vector<double> share(network.mats.size(), 0.0);  // Z' at a MAT, of all bends
  for (const Edge& edge : graph.edges) {
    if (edge.liaison.kind != LiaisonKind::kBend) continue;
    for (const std::uint32_t mat : {edge.mat_a, edge.mat_b})
      share[mat] += network.step * edge.viscosity * graph.inverse_mass[mat];
  }
  for (const Edge& edge : graph.edges) {
    const bool damps = edge.liaison.kind == LiaisonKind::kBend && edge.viscosity > 0.0;
    const double both = share[edge.mat_a] + share[edge.mat_b];
    if (damps && both > engine::kMaxExtrapolatedViscosity) return edge.liaison.index;
  }
  return {};
}

/// The first implicit damper that the energy of the start may turn by more than kMaxTurn in a step, at its length
/// of the start or at rest.
std::optional<LiaisonId> damper_that_turns(const engine::NetworkDescription& network,
                                           const LiaisonGraph& graph) {
  constexpr double kMaxTurn = 0.2;  // [rad]
  constexpr double kHeavy = 1.0;    // Z' from which on its direction matters
  if (network.dimension == 1 || !engine::damps_implicitly(network)) return {};
  for (std::uint32_t index = 0; index < network.links.size(); ++index) {
    const engine::Link& link = network.links[index];
    if (link.viscosity == 0.0 || link.isotropic) continue;
    const Reach here = reach_of_link(graph.reach, network, link.mat_a, link.mat_b);
    if (link.viscosity * here.inverse_mass * network.step <= kHeavy) continue;
    double length = (network.mats[link.mat_b].position - network.mats[link.mat_a].position).norm();
    if (link.stiffness > 0.0 && link.rest_length > 0.0) length = std::min(length, link.rest_length);
    const double speed =
        std::sqrt(2.0 * here.brought * here.inverse_mass) + (here.held ? here.speed : 0.0);
    if (graph.fed_by_forces || speed * network.step > kMaxTurn * length)
      return LiaisonId{LiaisonKind::kLink, index};
  }
  return {};
}

/// Step beyond which the tangent at the start diverges [s].
double diverging_step_of(const engine::NetworkDescription& network) {
  const auto limit_at = [](const engine::NetworkDescription& varied) {
    constexpr int kMaxRounds = 16;
    constexpr double kEndless = std::numeric_limits<double>::infinity();
    if (friction_beside_dampers(varied)) return kEndless;
    // At a longer step more of what `leapfrog` solves holds.
    double step = varied.step;
    for (int round = 0; round < kMaxRounds; ++round) {
      const double limit = StartTangent(varied, step).diverging_step();
      if (!(limit > step) || !engine::solves_stiff_friction(varied)) return limit;
      if (!std::isfinite(limit)) return limit;
      step = limit;
    }
    return kEndless;
  };
  return limit_of_all_steps(network, limit_at);
}

/// What is fastened to a block of modes: by how much the stiffnesses together, at most, and one of
/// them alone, at least, exceed what the block supports at the step of the network.
struct ModalLoad {
  double together = 0.0;
  double alone = 0.0;
  StepBound worst;
};

/// What a liaison surely adds to a block of modes: K + 2 Z / dt, of one with states as it acts at the start.
double surely_as_stiff(const engine::NetworkDescription& network, const Edge& edge) {
  if (edge.follows) return 0.0;
  if (edge.liaison.kind != LiaisonKind::kStateLink) {
    return edge.stiffness + 2.0 * edge.viscosity / network.step;
  }
  const engine::StateLink& link = network.state_links[edge.liaison.index];
  const Tangent tangent =
      tangent_at_start(network.state_machines[link.state_machine], start_point(network, link));
  return std::max(tangent.stiffness + 2.0 * tangent.viscosity / network.step, 0.0);
}

ModalLoad modal_load(const engine::NetworkDescription& network, const LiaisonGraph& graph) {
  const engine::ModalBlock block(network);
  ModalLoad load;
  double most = 0.0;
  if (!graph.contacts.empty()) {
    const ContactBound& contact = graph.contacts.front();
    load.together = most = std::numeric_limits<double>::infinity();
    load.worst.liaison = {LiaisonKind::kSet, contact.set};
    const auto is_mass = [&](std::uint32_t mat) { return graph.inverse_mass[mat] > 0.0; };
    const bool of_members = std::ranges::any_of(contact.members, is_mass);
    const std::vector<std::uint32_t>& moved = of_members ? contact.members : contact.others;
    const auto first = std::ranges::find_if(moved, is_mass);
    load.worst.mat = first == moved.end() ? moved.front() : *first;
  }
  for (const Edge& edge : graph.edges) {
    const bool to_port = network.mats[edge.mat_a].kind == engine::MatKind::kPort ||
                         network.mats[edge.mat_b].kind == engine::MatKind::kPort;
    if (edge.liaison.kind == LiaisonKind::kLink && !to_port) continue;
    const double at_a = block.alternating_compliance(edge.mat_a, edge.mat_a);
    const double at_b = block.alternating_compliance(edge.mat_b, edge.mat_b);
    const double between = block.alternating_compliance(edge.mat_a, edge.mat_b);
    const double stiffness = edge.stiffness + 2.0 * edge.viscosity / network.step;
    const double root = std::sqrt(at_a) + std::sqrt(at_b);
    load.together += stiffness * root * root;
    const double compliance = at_a + at_b - 2.0 * between;
    load.alone = std::max(load.alone, surely_as_stiff(network, edge) * compliance);
    if (stiffness * compliance < most) continue;
    most = stiffness * compliance;
    load.worst.liaison = edge.liaison;
    load.worst.mat = at_a > at_b ? edge.mat_a : edge.mat_b;
  }
  return load;
}

/// Certain at the step of the network alone; for others as if the block bore 1 / dt^2.
Stability stability_of_modes(const engine::NetworkDescription& network, LiaisonGraph graph) {
  graph.set_step(network.step);
  const ModalLoad load = modal_load(network, graph);
  Stability stability;
  stability.certified = load.worst;
  stability.certified.step = network.step / std::sqrt(load.together);
  stability.diverging_step = network.step / std::sqrt(load.alone);
  return stability;
}

/// The set whose surface lets a ball through, for its energy swings up by the step. What a contact stores where a
/// mass is, between two steps too, is at most swing_of() times what there is.
std::optional<LiaisonId> passed_surface(const engine::NetworkDescription& network,
                                        const LiaisonGraph& graph) {
  if (!graph.passable) return {};
  const double longest = certified_bound(network, graph).step;
  if (network.step >= longest) return {};  // not certain for that reason
  const double swing = swing_of(network.integrator, network.step / longest);
  return graph.passing * swing >= 1.0 ? graph.passable : std::nullopt;
}

/// True if a liaison of this state machine acts at some times and not at others.
bool switches(const engine::StateMachine& state_machine) {
  for (const engine::LinkState& state : state_machine.states) {
    if (lets_go(state)) return true;
  }
  return state_machine.states.size() > 1;
}

bool comes_and_goes(const engine::NetworkDescription& network, LiaisonId liaison) {
  switch (liaison.kind) {
    case LiaisonKind::kStateLink:
      return switches(network.state_machines[network.state_links[liaison.index].state_machine]);
    case LiaisonKind::kSet:
      return true;
    case LiaisonKind::kLink:
    case LiaisonKind::kMaxwellLink:
    case LiaisonKind::kBend:
    case LiaisonKind::kForce:
      return false;
  }
  return false;
}

/// True if a liaison with states, or of sets, lets go by being clamped or out of its rings.
bool is_clamped(const engine::NetworkDescription& network, LiaisonId liaison) {
  const std::uint32_t state_machine = liaison.kind == LiaisonKind::kSet
                                          ? network.sets[liaison.index].state_machine
                                          : network.state_links[liaison.index].state_machine;
  const auto& states = network.state_machines[state_machine].states;
  return std::any_of(states.begin(), states.end(), lets_go);
}

/// @param counts  of a liaison
std::optional<ContactGain> worst_touch_among(const engine::NetworkDescription& network,
                                             const LiaisonGraph& graph,
                                             const std::function<bool(LiaisonId)>& counts,
                                             Packs packs) {
  const std::optional<TouchSum> touch = largest_touch(network, graph, counts, packs);
  if (!touch) return {};
  const double gain = touch->stiffness < 4.0 ? touch->stiffness / (4.0 - touch->stiffness)
                                             : std::numeric_limits<double>::infinity();
  return ContactGain{touch->liaison, touch->stiffness, gain, touch->is_several, touch->alone};
}

/// @param clamped  only those that let go by being clamped
std::optional<ContactGain> worst_contact_among(const engine::NetworkDescription& network,
                                               const LiaisonGraph& graph, bool clamped,
                                               Packs packs = Packs::kAsOneSide) {
  const auto counts = [&](LiaisonId liaison) {
    return comes_and_goes(network, liaison) && (!clamped || is_clamped(network, liaison));
  };
  return worst_touch_among(network, graph, counts, packs);
}

/// Z / K that takes as much of a touch of K' as it may gain [s]: exp(2 pi zeta) = 1 / (1 - K'/4), with
/// zeta = (Z / K) sqrt(K') / 2 dt.
double damping_of_gain(double stiffness, double step) noexcept {
  return -std::log1p(-0.25 * stiffness) * step / (std::numbers::pi * std::sqrt(stiffness));
}

/// undamped_contact_of(). @param all  worst_contact_among() those that are clamped
std::optional<ContactGain> undamped_among(const engine::NetworkDescription& network,
                                          const LiaisonGraph& graph,
                                          const std::optional<ContactGain>& all) {
  if (!all) return {};
  const double enough = damping_of_gain(std::min(all->stiffness, kCertainBend), network.step);
  std::vector<bool> is_undamped_link(network.state_links.size());
  std::vector<bool> is_undamped_set(network.sets.size());
  for (const Edge& edge : graph.edges) {
    if (edge.liaison.kind == LiaisonKind::kStateLink)
      is_undamped_link[edge.liaison.index] = edge.touch_damping < enough;
  }
  for (const ContactBound& contact : graph.contacts)
    is_undamped_set[contact.set] = contact.touch_damping < enough;
  const auto counts = [&](LiaisonId liaison) {
    return liaison.kind == LiaisonKind::kSet
               ? is_undamped_set[liaison.index]
               : liaison.kind == LiaisonKind::kStateLink && is_undamped_link[liaison.index];
  };
  return worst_touch_among(network, graph, counts, Packs::kAsOneSide);
}

}  // namespace

double Plan::margin() const noexcept {
  const double share = stability.step / certain_step;
  return 1.0 - share * share;
}

std::optional<Uncertainty> uncertainty_of(const engine::NetworkDescription& network,
                                          const LiaisonGraph& graph) {
  if (graph.uncertainty) return graph.uncertainty;
  if (network.integrator == engine::IntegratorKind::kModal && !graph.contacts.empty()) {
    return Uncertainty{LiaisonId{LiaisonKind::kSet, graph.contacts.front().set},
                       "no limit is known for a set beside modes"};
  }
  if (const auto passed = passed_surface(network, graph))
    return Uncertainty{*passed, kPassesSurface};
  if (const auto solved = friction_beside_dampers(network)) {
    return Uncertainty{
        LiaisonId{LiaisonKind::kStateLink, *solved},
        "its friction is solved beside implicit dampers, for which no limit is known"};
  }
  if (const auto damped = bend_beside_dampers(network, graph)) {
    return Uncertainty{
        LiaisonId{LiaisonKind::kBend, *damped},
        "its viscosity has Z' above 0.3 beside implicit dampers, for which no limit is known"};
  }
  if (const auto damper = damper_that_turns(network, graph)) {
    return Uncertainty{*damper, "it may gain energy where it turns by more than 0.2 rad in a step"};
  }
  const std::optional<ContactGain> contact = worst_contact_among(network, graph, /*clamped=*/true);
  if (contact && contact->stiffness > kCertainBend) {
    return Uncertainty{
        contact->liaison,
        contact->alone > kCertainBend
            ? "each touch of it may gain energy, for its K' is above 1"
            : "each touch of it with what else touches the same mass may gain energy, for their K' "
              "together is above 1"};
  }
  const std::optional<ContactGain> undamped = undamped_among(network, graph, contact);
  if (undamped && undamped->stiffness > kCertainFall) {
    return Uncertainty{
        undamped->liaison,
        "each touch of it may gain more energy than its viscosity takes, for its K' is above 0.1"};
  }
  const std::optional<VaryingSlope> varying = varying_slope_of(network, graph);
  const double variation = varying ? varying->stiffness : 0.0;
  if (variation > kCertainBend) {
    return Uncertainty{
        varying->liaison,
        "each passage over its bend may gain energy, for its K' varies by more than 1"};
  }
  const std::optional<VaryingSlope> falling = falling_slope_of(network, graph);
  if (falling && falling->stiffness > kCertainFall) {
    return Uncertainty{
        falling->liaison,
        "each passage over its bend may gain energy, for its K' falls by more than 0.1"};
  }
  // Balls between which a ball lies are the vibration beside its touch.
  const std::optional<ContactGain> stop =
      worst_contact_among(network, graph, /*clamped=*/true, Packs::kAsOneBall);
  const double touch = stop ? stop->stiffness : 0.0;
  constexpr double kMaxNumber = 4.0;  // K' of any vibration
  constexpr double kCertainBesideAll = certain_beside(kMaxNumber) / kMaxNumber;
  if (std::max(touch, variation) <= kCertainBesideAll) return {};
  const double stiffest = stiffest_vibration(network, graph);
  if (std::max(touch, variation) * stiffest <= certain_beside(stiffest)) return {};
  return Uncertainty{
      touch > variation ? stop->liaison : varying->liaison,
      "it may gain energy from a stiff vibration beside it, for the product of what "
      "its K' varies by and the K' of that is above 1, or 0.6 where that has K' above 2"};
}

double swing_of(engine::IntegratorKind integrator, double part) noexcept {
  if (integrator == engine::IntegratorKind::kSymplectic4) return 1.06;
  const double most = integrator == engine::IntegratorKind::kImplicit ? part : part * part;
  return most < 1.0 ? 1.0 / (1.0 - most) : std::numeric_limits<double>::infinity();
}

Stability stability_of(const engine::NetworkDescription& network, const LiaisonGraph& graph) {
  Stability stability;
  if (network.integrator == engine::IntegratorKind::kModal) {
    stability = stability_of_modes(network, graph);
  } else {
    stability.certified = certified_bound(network, graph);
    stability.diverging_step = diverging_step_of(network);
  }
  stability.bounded = graph.bounded;
  stability.laws_are_bounded = graph.laws_are_bounded;
  stability.pair_share = graph.pair_share;
  stability.turning = graph.turning;
  // Elsewhere a link turns about by more than it has room for.
  if (network.dimension == 1)
    stability.turning.swing(swing_of(network.integrator, network.step / stability.certified.step));
  stability.step = network.step;
  constexpr double kNegligibleFall = 0.01;  // K'
  const auto bending = falling_slope_of(network, graph, /*anywhere=*/true);
  if (bending && bending->stiffness > kNegligibleFall) stability.bending = bending->liaison;
  const auto touching = undamped_contact_of(network, graph);
  if (touching && touching->stiffness > kNegligibleFall) stability.touching = touching->liaison;
  stability.sets = partner_limits(network, graph, stability.holds());
  stability.uncertainty = uncertainty_of(network, graph);
  // The two limits are found in ways that have nothing in common: where they cross one is wrong.
  constexpr double kRounding = 1e-6;
  if (stability.certified.step > stability.diverging_step * (1.0 + kRounding)) {
    stability.certified.step = stability.diverging_step;
    if (!stability.uncertainty) {
      stability.uncertainty = {stability.certified.liaison.value_or(LiaisonId{}), kLimitsCross};
    }
  }
  return stability;
}

double certain_step_of(const engine::NetworkDescription& network, const LiaisonGraph& graph,
                       const Stability& stability) {
  constexpr double kJustBelow = 1.0 - 1e-9;
  constexpr double kShortest = 1e-3;
  constexpr int kHalvings = 30;
  const double longest = stability.certified.step;
  if (graph.uncertainty || !(longest > 0.0)) return 0.0;
  if (!std::isfinite(longest)) return stability.uncertainty ? 0.0 : longest;
  engine::NetworkDescription varied = network;
  const auto is_certain = [&](double step) {
    varied.step = step;
    return !uncertainty_of(varied, graph);
  };
  if (is_certain(kJustBelow * longest)) return longest;
  double low = stability.holds() ? network.step : kShortest * longest;
  if (!is_certain(low)) return 0.0;
  double high = longest;
  for (int n = 0; n < kHalvings; ++n) {
    const double middle = std::sqrt(low * high);
    (is_certain(middle) ? low : high) = middle;
  }
  return low;
}

namespace {

/// The least Z / m of a vibration is w^2 `of_links` + `of_medium`: of linear springs, each with its damper, Z >= w^2
/// min(Z / K), and what the medium adds. Of all else 0, for its slopes are known from above alone.
struct MinViscosity {
  double of_links = 0.0;   // [s]
  double of_medium = 0.0;  // [1/s]
};

MinViscosity min_viscosity_of(const LiaisonGraph& graph) {
  double ratio = std::numeric_limits<double>::infinity();
  for (const Edge& edge : graph.edges) {
    if (edge.liaison.kind != LiaisonKind::kLink || edge.follows) return {};
    if (edge.stiffness > 0.0) ratio = std::min(ratio, edge.viscosity / edge.stiffness);
  }
  if (!graph.contacts.empty() || !graph.forces.empty()) return {};
  double of_medium = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < graph.inverse_mass.size(); ++i) {
    if (graph.inverse_mass[i] > 0.0)
      of_medium = std::min(of_medium, graph.medium_viscosity[i] * graph.inverse_mass[i]);
  }
  return {ratio, of_medium};
}

/// A vibration y of unit mass has w^2 = y'K y and Z = y'Z y, hence Z <= w^2 max(Z / K) over the links, and what the
/// medium adds. Where a link may be a damper alone that says nothing, and the largest eigenvalue of M^-1 Z does.
double max_viscosity_of(const LiaisonGraph& graph, double w) {
  double ratio = 0.0;
  LiaisonGraph dampers = graph;
  for (Edge& edge : dampers.edges) {
    ratio = std::max(ratio, edge.damping_ratio);
    edge.stiffness = 0.0;
  }
  for (ContactBound& contact : dampers.contacts) {
    ratio = std::max(ratio, contact.damping_ratio);
    contact.stiffness = 0.0;
  }
  double of_medium = 0.0;
  std::vector<double> to_ground = graph.medium_viscosity;
  for (const ForceBound& force : graph.forces) to_ground[force.mat] += force.viscosity;
  for (std::size_t i = 0; i < graph.inverse_mass.size(); ++i) {
    of_medium = std::max(of_medium, to_ground[i] * graph.inverse_mass[i]);
  }
  for (ForceBound& force : dampers.forces) force.stiffness = 0.0;
  const double of_dampers = 2.0 / edge_bound(dampers).step;  // 2 dt Z = 4
  return std::min(w * w * ratio + of_medium, of_dampers);
}

/// Puts in the place of each Maxwell element the spring and the damper that it is to a vibration, with T = Z / K:
/// K (w T)^2 / (1 + (w T)^2) and Z / (1 + (w T)^2). One whose parameters change may damp the most there is, K / 2 w.
LiaisonGraph at_frequency(const engine::NetworkDescription& network, LiaisonGraph graph, double w) {
  for (Edge& edge : graph.edges) {
    if (edge.liaison.kind != LiaisonKind::kMaxwellLink) continue;
    const engine::MaxwellLink& link = graph.maxwell_links[edge.liaison.index];
    if (!(link.stiffness > 0.0)) continue;
    const double turn = w * link.viscosity / link.stiffness;
    const double share = std::isfinite(turn) ? turn * turn / (1.0 + turn * turn) : 1.0;
    if (network.maxwell_links[edge.liaison.index].follows_variables()) {
      edge.viscosity = std::min(link.viscosity, 0.5 * link.stiffness / w);
      edge.damping_ratio = damping_ratio(edge.viscosity, 0.0);
      continue;
    }
    edge.viscosity = std::isfinite(turn) ? link.viscosity / (1.0 + turn * turn) : 0.0;
    edge.stiffness = link.stiffness * share;
    edge.damping_ratio = damping_ratio(edge.viscosity, edge.stiffness);
  }
  return graph;
}

/// True if a liaison acts in the pose of the start, or always.
bool acts_at_start(const engine::NetworkDescription& network, LiaisonId liaison) {
  if (!comes_and_goes(network, liaison)) return true;
  if (liaison.kind != LiaisonKind::kStateLink) return false;
  const engine::StateLink& link = network.state_links[liaison.index];
  return tangent_at_start(network.state_machines[link.state_machine], start_point(network, link))
      .acts;
}

/// True if the integrator of a network moves by the forces of a moment what a liaison does, as `cordis` does.
bool moves_as_cordis(const engine::NetworkDescription& network, const Edge& edge) {
  const auto is_port = [&](std::uint32_t mat) {
    return network.mats[mat].kind == engine::MatKind::kPort;
  };
  switch (network.integrator) {
    case engine::IntegratorKind::kLeapfrog:
      return edge.liaison.kind == LiaisonKind::kMaxwellLink;
    case engine::IntegratorKind::kModal:
      if (edge.liaison.kind == LiaisonKind::kLink)
        return is_port(edge.mat_a) || is_port(edge.mat_b);
      return acts_at_start(network, edge.liaison);
    case engine::IntegratorKind::kImplicit:
      return edge.liaison.kind != LiaisonKind::kLink && acts_at_start(network, edge.liaison);
    case engine::IntegratorKind::kCordis:
    case engine::IntegratorKind::kSymplectic4:
      return false;
  }
  return false;
}

/// A graph with some of its edges and with its forces alone.
template <class Keeps>
LiaisonGraph with_edges(LiaisonGraph graph, const Keeps& keeps) {
  std::erase_if(graph.edges, [&](const Edge& edge) { return !keeps(edge); });
  graph.contacts.clear();
  std::ranges::fill(graph.medium_viscosity, 0.0);
  return graph;
}

/// The part of a vibration that the integrator moves as `cordis` does. Contacts are left out: their error is
/// that of worst_contact_of(). @param at_edge  the graph of at_frequency()
MovedAsByCordis moved_as_by_cordis(const engine::NetworkDescription& network,
                                   const LiaisonGraph& at_edge, double w) {
  LiaisonGraph graph =
      with_edges(at_edge, [&](const Edge& edge) { return moves_as_cordis(network, edge); });
  const bool has_forces = network.integrator == engine::IntegratorKind::kModal ||
                          network.integrator == engine::IntegratorKind::kImplicit;
  if (!has_forces) graph.forces.clear();
  if (graph.edges.empty() && graph.forces.empty()) return {};
  MovedAsByCordis part;
  part.viscosity = max_viscosity_of(graph, w);
  for (Edge& edge : graph.edges) edge.viscosity = 0.0;
  for (ForceBound& force : graph.forces) force.viscosity = 0.0;
  const double longest = edge_bound(graph).step;  // dt^2 K = 4
  part.stiffness = std::min(4.0 / (longest * longest), w * w);
  return part;
}

/// Z / m over w, from 0.8 to 1.25 times the critical. Between them the frequency and the rate of the slower mode are
/// known to a root of their errors alone, and neither has time to show.
constexpr double kMaxSwinging = 1.6;
constexpr double kMinCreeping = 2.5;

}  // namespace

OscillatorError error_of(const BandEdge& edge, double viscosity, double step,
                         engine::IntegratorKind integrator) {
  const double w = 2.0 * std::numbers::pi * edge.frequency_hz;
  const bool swings = viscosity < 2.0 * w;
  const double counted =
      swings ? std::min(viscosity, kMaxSwinging * w) : std::max(viscosity, kMinCreeping * w);
  OscillatorError error = oscillator_error(w, counted, step, integrator, edge.as_by_cordis);
  // A Maxwell element of w T = 1 damps by w^2 dt^2 / 12 too much; a damper and a spring do not.
  if (error.oscillates) error.decay += edge.of_maxwell * w * w * step * step / 12.0;
  return error;
}

std::vector<BandEdge> lighter_creeps(const BandEdge& edge) {
  const double w = 2.0 * std::numbers::pi * edge.frequency_hz;
  std::vector<BandEdge> creeps;
  const auto add = [&](double frequency, double viscosity) {
    BandEdge lighter = edge;
    lighter.frequency_hz = frequency / (2.0 * std::numbers::pi);
    lighter.viscosity = viscosity;
    creeps.push_back(lighter);
  };
  if (edge.viscosity <= kMinCreeping * w) return creeps;
  add(w, std::max(edge.min_viscosity, kMinCreeping * w));
  // At the frequency w' the least viscosity is of_links w'^2 + min_of_medium: kMinCreeping w' at the larger root.
  const double of_links = (edge.min_viscosity - edge.min_of_medium) / (w * w);
  const double square = kMinCreeping * kMinCreeping - 4.0 * of_links * edge.min_of_medium;
  if (edge.min_viscosity <= kMinCreeping * w || !(square > 0.0) || of_links == 0.0) return creeps;
  const double lower = 0.5 * (kMinCreeping + std::sqrt(square)) / of_links;
  if (lower < w) add(lower, kMinCreeping * lower);
  return creeps;
}

BandEdge band_edge_of(const engine::NetworkDescription& network, const LiaisonGraph& graph,
                      double frequency_hz) {
  const double w = 2.0 * std::numbers::pi * frequency_hz;
  const LiaisonGraph at_edge = at_frequency(network, graph, w);
  BandEdge edge;
  edge.frequency_hz = frequency_hz;
  edge.viscosity = max_viscosity_of(at_edge, w);
  const MinViscosity least = min_viscosity_of(at_edge);
  edge.min_viscosity = std::min(w * w * least.of_links + least.of_medium, edge.viscosity);
  edge.min_of_medium = std::min(least.of_medium, edge.min_viscosity);
  edge.as_by_cordis = moved_as_by_cordis(network, at_edge, w);
  if (!network.maxwell_links.empty() && edge.viscosity > 0.0) {
    LiaisonGraph maxwell = with_edges(
        at_edge, [](const Edge& link) { return link.liaison.kind == LiaisonKind::kMaxwellLink; });
    maxwell.forces.clear();
    edge.of_maxwell = std::min(max_viscosity_of(maxwell, w) / edge.viscosity, 1.0);
  }
  edge.error = error_of(edge, edge.viscosity, network.step, network.integrator);
  for (const BandEdge& lighter : lighter_creeps(edge)) {
    const OscillatorError error =
        error_of(lighter, lighter.viscosity, network.step, network.integrator);
    edge.error.creeps = edge.error.creeps && error.creeps;
    if (std::abs(error.creep) > std::abs(edge.error.creep)) edge.error.creep = error.creep;
  }
  if (0.5 * edge.viscosity >= w && 0.5 * edge.min_viscosity < w)
    edge.swinging = error_of(edge, edge.min_viscosity, network.step, network.integrator);
  return edge;
}

std::optional<ContactGain> worst_contact_of(const engine::NetworkDescription& network,
                                            const LiaisonGraph& graph) {
  return worst_contact_among(network, graph, /*clamped=*/false);
}

std::optional<ContactGain> undamped_contact_of(const engine::NetworkDescription& network,
                                               const LiaisonGraph& graph) {
  return undamped_among(network, graph, worst_contact_among(network, graph, /*clamped=*/true));
}

namespace {

/// The largest of what a number [N/m] of each liaison comes to for its masses.
/// @param number  that of an edge, of a contact, or of a force
template <class Number>
std::optional<VaryingSlope> largest_slope_among(const engine::NetworkDescription& network,
                                                const LiaisonGraph& graph, const Number& number) {
  const double weight = limit_weights(network, Limit::kStable).stiffness;
  std::optional<VaryingSlope> most;
  const auto consider = [&](LiaisonId liaison, double variation, double inverse_mass) {
    const double stiffness = weight * variation * inverse_mass * network.step * network.step;
    if (stiffness > (most ? most->stiffness : 0.0)) most = {liaison, stiffness};
  };
  for (const Edge& edge : graph.edges) {
    consider(edge.liaison, number(edge),
             graph.inverse_mass[edge.mat_a] + graph.inverse_mass[edge.mat_b]);
  }
  for (const ContactBound& contact : graph.contacts) {
    consider({LiaisonKind::kSet, contact.set}, number(contact),
             lightest(graph, contact.members) + lightest(graph, contact.others));
  }
  for (const ForceBound& force : graph.forces)
    consider(force.liaison, number(force), graph.inverse_mass[force.mat]);
  return most;
}

}  // namespace

std::optional<VaryingSlope> varying_slope_of(const engine::NetworkDescription& network,
                                             const LiaisonGraph& graph) {
  return largest_slope_among(network, graph, [](const auto& each) { return each.variation; });
}

std::optional<VaryingSlope> falling_slope_of(const engine::NetworkDescription& network,
                                             const LiaisonGraph& graph, bool anywhere) {
  return largest_slope_among(network, graph, [anywhere](const auto& each) {
    return anywhere ? each.fall_anywhere : each.fall;
  });
}

double stiffest_vibration(const engine::NetworkDescription& network, LiaisonGraph graph) {
  constexpr double kMaxNumber = 4.0;
  LimitWeights weights = limit_weights(network, Limit::kStable);
  if (network.integrator == engine::IntegratorKind::kImplicit) {
    weights.link_stiffness = weights.stiffness;
  }
  graph.set_step(network.step);
  graph = weighted(std::move(graph), weights);
  std::ranges::fill(graph.medium_viscosity, 0.0);
  for (Edge& edge : graph.edges) edge.viscosity = 0.0;
  for (ContactBound& contact : graph.contacts) contact.viscosity = 0.0;
  for (ForceBound& force : graph.forces) force.viscosity = 0.0;
  return std::min(row_weights(graph, network.step).number, kMaxNumber);
}

Plan plan_of(const engine::NetworkDescription& network, double band_hz) {
  const LiaisonGraph graph = liaison_graph(network);
  Plan plan{stability_of(network, graph), band_edge_of(network, graph, band_hz),
            worst_contact_of(network, graph)};
  plan.certain_step = certain_step_of(network, graph, plan.stability);
  return plan;
}

}  // namespace cordis::plan
