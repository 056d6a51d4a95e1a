// sim_node/checks/limit_watch.cpp
#include "sim_node/checks/limit_watch.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "sim_node/plan/stability/liaison_graph.h"
#include "sim_node/plan/stability/limit_weights.h"
#include "sim_node/plan/stability/partner_limit.h"

namespace cordis::sim {
namespace {

/// A state machine that is always in this state.
engine::StateMachine only(const engine::StateMachine& state_machine, std::size_t state) {
  engine::StateMachine one;
  one.states = {state_machine.states[state]};
  one.states[0].first_exit = one.states[0].last_exit = 0;
  return one;
}

}  // namespace

LimitWatch::LimitWatch(const engine::NetworkDescription& network)
    : share_(network.mats.size(), 0.0),
      steady_(network.mats.size(), 0.0),
      sum_(network.mats.size(), 0.0) {
  const double dt = network.step;
  const auto number = [dt](double stiffness, double viscosity) {
    return dt * dt * stiffness + 2.0 * dt * viscosity;
  };
  const plan::LimitWeights weights = plan::limit_weights(network, plan::Limit::kStable);
  plan::LiaisonGraph graph = plan::liaison_graph(network);
  std::vector<plan::PartnerLimit> partners;
  if (!network.sets.empty()) partners = plan::partner_limits(network, graph, false);
  graph = plan::weighted(std::move(graph), weights);
  // The weights with which the largest numbers of partners are certified.
  const std::vector<double> weight =
      partners.empty()
          ? plan::row_weights(graph, dt).weight
          : plan::row_weights(plan::with_certified_partners(graph, partners), dt).weight;
  for (std::size_t i = 0; i < share_.size(); ++i) {
    if (weight[i] > 0.0) share_[i] = graph.inverse_mass[i] / weight[i];
    steady_[i] = number(0.0, graph.medium_viscosity[i]) * weight[i];
  }
  for (const plan::ForceBound& force : graph.forces)
    steady_[force.mat] += number(force.stiffness, force.viscosity) * weight[force.mat];
  for (const plan::Edge& edge : graph.edges) {
    if (edge.liaison.kind == plan::LiaisonKind::kStateLink) continue;
    const double both = weight[edge.mat_a] + weight[edge.mat_b];
    steady_[edge.mat_a] += number(edge.stiffness, edge.viscosity) * both;
    steady_[edge.mat_b] += number(edge.stiffness, edge.viscosity) * both;
  }
  for (const plan::ContactBound& contact : graph.contacts) {
    const double most = plan::largest_of_others(contact, weight);
    const bool is_second_half =
        !members_.empty() && contact.counted && members_.back().set == contact.set;
    const std::size_t first = is_second_half ? network.sets[contact.set].set_p.size() : 0;
    for (std::size_t m = 0; m < contact.members.size(); ++m) {
      const std::uint32_t mat = contact.members[m];
      const double one = number(contact.stiffness, contact.viscosity) * (weight[mat] + most);
      if (contact.counted) {
        members_.push_back(
            {contact.set, static_cast<std::uint32_t>(first + m), mat, contact.neighbours[m], one});
      } else {
        steady_[mat] += contact.neighbours[m] * one;
      }
    }
  }
  const plan::Reach reach = plan::reach_of(network);
  std::uint32_t index = 0;
  for (const engine::StateLink& link : network.state_links) {
    const double viscosity = weights.viscosity_of_state_link(index++);
    links_.push_back({link.mat_a, link.mat_b, static_cast<std::uint32_t>(slopes_.size()),
                      weight[link.mat_a] + weight[link.mat_b]});
    const engine::StateMachine& state_machine = network.state_machines[link.state_machine];
    for (std::size_t state = 0; state < state_machine.states.size(); ++state) {
      const plan::Slope slope =
          plan::largest_slope(only(state_machine, state), link.rest_length, network.dimension,
                              reach_of_link(reach, network, link.mat_a, link.mat_b));
      slopes_.push_back(number(weights.stiffness * slope.stiffness, viscosity * slope.viscosity));
    }
  }
}

void LimitWatch::update(const engine::World& world) noexcept {
  std::copy(steady_.begin(), steady_.end(), sum_.begin());
  for (std::uint32_t l = 0; l < links_.size(); ++l) {
    const StateLink& link = links_[l];
    const double slope = slopes_[link.first + world.state_of(l)] * link.both;
    sum_[link.mat_a] += slope;
    sum_[link.mat_b] += slope;
  }
  for (const Member& member : members_) {
    const double partners = world.partners_of(member.set, member.member);
    sum_[member.mat] += std::max(member.partners, partners) * member.number;
  }
  for (std::size_t i = 0; i < sum_.size(); ++i) {
    largest_ = std::max(largest_, share_[i] * sum_[i]);
  }
}

}  // namespace cordis::sim
