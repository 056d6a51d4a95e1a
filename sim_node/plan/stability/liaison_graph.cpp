// sim_node/plan/stability/liaison_graph.cpp
#include "sim_node/plan/stability/liaison_graph.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace cordis::plan {
namespace {

using engine::NetworkDescription;

double radius_of(const NetworkDescription& network, std::uint32_t mat) {
  return network.radius.empty() ? 0.0 : network.radius[mat];
}

double smallest_radius(const NetworkDescription& network, const std::vector<std::uint32_t>& mats) {
  double smallest = std::numeric_limits<double>::infinity();
  for (const std::uint32_t mat : mats) smallest = std::min(smallest, radius_of(network, mat));
  return smallest;
}

ContactBound crowd(const NetworkDescription& network, const std::vector<std::uint32_t>& members,
                   const std::vector<std::uint32_t>& others, const Slope& slope,
                   std::uint32_t set) {
  ContactBound side{members, others, {}, slope.stiffness, slope.viscosity, set, slope.bounded};
  const double smallest = smallest_radius(network, others);
  const double available = static_cast<double>(others.size() - (&members == &others ? 1 : 0));
  for (const std::uint32_t mat : members) {
    const double most = max_neighbours(network.dimension, radius_of(network, mat), smallest);
    side.neighbours.push_back(std::min(most, available));
  }
  return side;
}

void add_set(const NetworkDescription& network, std::uint32_t index, const Reach& reach,
             LiaisonGraph& graph) {
  const engine::SetLiaison& set = network.sets[index];
  const auto& others = set.set_q.empty() ? set.set_p : set.set_q;
  const double rest = set.rest_length >= 0.0
                          ? set.rest_length
                          : smallest_radius(network, set.set_p) + smallest_radius(network, others);
  const Slope slope =
      largest_slope(network.state_machines[set.state_machine], rest, network.dimension, reach);
  graph.bounded = graph.bounded && slope.bounded;
  graph.crowds.push_back(crowd(network, set.set_p, others, slope, index));
  if (!set.set_q.empty()) {
    graph.crowds.push_back(crowd(network, set.set_q, set.set_p, slope, index));
  }
}

}  // namespace

double largest_of_others(const ContactBound& crowd, const std::vector<double>& values) {
  double most = 0.0;
  for (const std::uint32_t mat : crowd.others) most = std::max(most, values[mat]);
  return most;
}

double max_neighbours(int dimension, double own, double other) {
  if (dimension == 1) return 2.0;
  if (other >= own || other <= 0.0) return dimension == 2 ? 6.0 : 12.0;
  const double half_angle = std::asin(other / (own + other));  // under which one ball is seen
  constexpr double kRounding = 1e-9;
  if (dimension == 2) return std::floor(std::numbers::pi / half_angle + kRounding);
  return std::floor(2.0 / (1.0 - std::cos(half_angle)) + kRounding);
}

void LiaisonGraph::set_step(const NetworkDescription& network, double step) {
  for (Edge& joint : joints) {
    if (joint.liaison.kind != LiaisonKind::kMaxwellLink) continue;
    const engine::MaxwellLink& link = network.maxwell_links[joint.liaison.index];
    const double turn = 0.5 * link.stiffness * step / link.viscosity;
    joint.stiffness = turn > 0.0 ? link.stiffness * std::tanh(turn) / turn : link.stiffness;
  }
}

LiaisonGraph liaison_graph(const NetworkDescription& network) {
  LiaisonGraph graph;
  graph.medium_viscosity = network.medium_viscosity;
  for (const engine::Mat& mat : network.mats) {
    graph.inverse_mass.push_back(mat.kind == engine::MatKind::kMass ? 1.0 / mat.mass : 0.0);
  }
  graph.joints.reserve(network.links.size() + network.state_links.size() +
                       network.maxwell_links.size());
  std::uint32_t index = 0;
  for (const engine::Link& link : network.links) {
    graph.joints.push_back(
        {link.mat_a, link.mat_b, link.stiffness, link.viscosity, {LiaisonKind::kLink, index++}});
  }
  const Reach reach = reach_of(network);
  index = 0;
  for (const engine::StateLink& link : network.state_links) {
    const Slope slope = largest_slope(network.state_machines[link.state_machine], link.rest_length,
                                      network.dimension, reach);
    graph.bounded = graph.bounded && slope.bounded;
    graph.joints.push_back({link.mat_a,
                            link.mat_b,
                            slope.stiffness,
                            slope.viscosity,
                            {LiaisonKind::kStateLink, index++},
                            slope.bounded});
  }
  index = 0;
  for (const engine::MaxwellLink& link : network.maxwell_links) {
    graph.joints.push_back(
        {link.mat_a, link.mat_b, link.stiffness, 0.0, {LiaisonKind::kMaxwellLink, index++}});
  }
  for (index = 0; index < network.sets.size(); ++index) add_set(network, index, reach, graph);
  return graph;
}

}  // namespace cordis::plan
