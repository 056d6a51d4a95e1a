// sim_node/checks/limit_watch.cpp
#include "sim_node/checks/limit_watch.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "sim_node/plan/stability/liaison_graph.h"
#include "sim_node/plan/stability/limit_weights.h"
#include "sim_node/plan/stability/partner_limit.h"
#include "sim_node/plan/stability/step_bound.h"

namespace cordis::sim {
namespace {

/// A state machine that is always in this state.
engine::StateMachine only(const engine::StateMachine& state_machine, std::size_t state) {
  engine::StateMachine one;
  one.states = {state_machine.states[state]};
  one.states[0].first_exit = one.states[0].last_exit = 0;
  return one;
}

/// K' + 2 Z' of a liaison, for unit mass.
double number(double dt, double stiffness, double viscosity) {
  return dt * dt * stiffness + 2.0 * dt * viscosity;
}

constexpr double kStableBelow = 4.0;

}  // namespace

LimitWatch::LimitWatch(const engine::NetworkDescription& network)
    : dt_(network.step), sum_(network.mats.size(), 0.0) {
  const plan::LimitWeights weights = plan::limit_weights(network, plan::Limit::kStable);
  plan::LiaisonGraph graph = plan::liaison_graph(network);
  std::vector<plan::PartnerLimit> partners;
  // Not below the numbers that count at least, also where none is certified.
  if (!network.sets.empty()) partners = plan::partner_limits(network, graph, /*holds=*/true);
  graph = plan::weighted(std::move(graph), weights);
  for (const plan::ContactBound& contact : graph.contacts) {
    if (!contact.counted) continue;
    const bool is_second_half = !members_.empty() && members_.back().set == contact.set;
    const std::size_t first = is_second_half ? network.sets[contact.set].set_p.size() : 0;
    for (std::size_t m = 0; m < contact.members.size(); ++m)
      members_.push_back({contact.set, static_cast<std::uint32_t>(first + m), contact.members[m],
                          contact.neighbours[m]});
  }
  const plan::Reach reach = plan::reach_of(network);
  std::uint32_t index = 0;
  for (const engine::StateLink& link : network.state_links) {
    const double viscosity = weights.viscosity_of_state_link(index++);
    links_.push_back({link.mat_a, link.mat_b, static_cast<std::uint32_t>(slopes_.size())});
    const engine::StateMachine& state_machine = network.state_machines[link.state_machine];
    for (std::size_t state = 0; state < state_machine.states.size(); ++state) {
      const plan::Slope slope =
          plan::largest_slope(only(state_machine, state), link.rest_length, network.dimension,
                              reach_of_link(reach, network, link.mat_a, link.mat_b));
      slopes_.push_back(
          number(dt_, weights.stiffness * slope.stiffness, viscosity * slope.viscosity));
    }
  }
  // The weights with which the largest numbers of partners are certified.
  const plan::RowWeights certified =
      partners.empty() ? plan::row_weights(graph, dt_)
                       : plan::row_weights(plan::with_certified_partners(graph, partners), dt_);
  bounds_.push_back(bound_of(graph, certified.weight));
  if (certified.number < kStableBelow) return;
  std::vector<double> equal(graph.inverse_mass.size());
  std::ranges::transform(graph.inverse_mass, equal.begin(),
                         [](double inverse_mass) { return std::sqrt(inverse_mass); });
  bounds_.push_back(bound_of(graph, equal));
}

LimitWatch::Bound LimitWatch::bound_of(const plan::LiaisonGraph& graph,
                                       const std::vector<double>& weight) const {
  Bound bound;
  bound.share.assign(weight.size(), 0.0);
  bound.steady.assign(weight.size(), 0.0);
  for (std::size_t i = 0; i < weight.size(); ++i) {
    if (weight[i] > 0.0) bound.share[i] = graph.inverse_mass[i] / weight[i];
    bound.steady[i] = number(dt_, 0.0, graph.medium_viscosity[i]) * weight[i];
  }
  for (const plan::ForceBound& force : graph.forces)
    bound.steady[force.mat] += number(dt_, force.stiffness, force.viscosity) * weight[force.mat];
  for (const plan::Edge& edge : graph.edges) {
    if (edge.liaison.kind == plan::LiaisonKind::kStateLink) continue;
    const double both = weight[edge.mat_a] + weight[edge.mat_b];
    bound.steady[edge.mat_a] += number(dt_, edge.stiffness, edge.viscosity) * both;
    bound.steady[edge.mat_b] += number(dt_, edge.stiffness, edge.viscosity) * both;
  }
  for (const plan::ContactBound& contact : graph.contacts) {
    const double most = plan::largest_of_others(contact, weight);
    for (std::size_t m = 0; m < contact.members.size(); ++m) {
      const std::uint32_t mat = contact.members[m];
      const double one = number(dt_, contact.stiffness, contact.viscosity) * (weight[mat] + most);
      if (contact.counted) {
        bound.number.push_back(one);
      } else {
        bound.steady[mat] += contact.neighbours[m] * one;
      }
    }
  }
  for (const StateLink& link : links_)
    bound.both.push_back(weight[link.mat_a] + weight[link.mat_b]);
  return bound;
}

double LimitWatch::number_with(const Bound& bound, const engine::World& world) noexcept {
  std::copy(bound.steady.begin(), bound.steady.end(), sum_.begin());
  for (std::uint32_t l = 0; l < links_.size(); ++l) {
    const StateLink& link = links_[l];
    const double slope = slopes_[link.first + world.state_of(l)] * bound.both[l];
    sum_[link.mat_a] += slope;
    sum_[link.mat_b] += slope;
  }
  for (std::size_t m = 0; m < members_.size(); ++m) {
    const Member& member = members_[m];
    const double partners = world.partners_of(member.set, member.member);
    sum_[member.mat] += std::max(member.partners, partners) * bound.number[m];
  }
  double largest = 0.0;
  for (std::size_t i = 0; i < sum_.size(); ++i)
    largest = std::max(largest, bound.share[i] * sum_[i]);
  return largest;
}

void LimitWatch::update(const engine::World& world) noexcept {
  double least = std::numeric_limits<double>::infinity();
  for (const Bound& bound : bounds_) least = std::min(least, number_with(bound, world));
  largest_ = std::max(largest_, least);
}

}  // namespace cordis::sim
