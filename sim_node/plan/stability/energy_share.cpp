// sim_node/plan/stability/energy_share.cpp
#include "sim_node/plan/stability/energy_share.h"

#include <algorithm>
#include <cstdint>

#include "node/assert.h"
#include "node/disjoint_sets.h"
#include "sim_node/plan/stability/reach.h"

namespace cordis::plan {
namespace {

bool is_mass(const engine::NetworkDescription& network, std::uint32_t mat) {
  return network.mats[mat].kind == engine::MatKind::kMass;
}

node::DisjointSets bodies_of(const engine::NetworkDescription& network) {
  node::DisjointSets bodies(network.mats.size());
  const auto join = [&](std::uint32_t a, std::uint32_t b) {
    if (is_mass(network, a) && is_mass(network, b)) bodies.join(a, b);
  };
  for (const engine::Link& link : network.links) join(link.mat_a, link.mat_b);
  for (const engine::StateLink& link : network.state_links) join(link.mat_a, link.mat_b);
  for (const engine::MaxwellLink& link : network.maxwell_links) join(link.mat_a, link.mat_b);
  for (const engine::Bend& bend : network.bends) {
    join(bend.mat_a, bend.mat_b);
    join(bend.mat_b, bend.mat_c);
  }
  return bodies;
}

/// Joins what the pairs of sets may join.
void join_pairs(const engine::NetworkDescription& network, node::DisjointSets& groups) {
  for (const engine::SetLiaison& set : network.sets) {
    const auto& others = set.set_q.empty() ? set.set_p : set.set_q;
    const auto is_moved = [&](std::uint32_t mat) { return is_mass(network, mat); };
    const auto one = std::ranges::find_if(set.set_p, is_moved);
    const auto other = std::ranges::find_if(others, is_moved);
    if (one == set.set_p.end() || other == others.end()) continue;
    for (const auto* side : {&set.set_p, &others}) {
      for (const std::uint32_t mat : *side) {
        if (is_mass(network, mat)) groups.join(*one, mat);
      }
    }
  }
}

}  // namespace

std::vector<EnergyShare> energy_shares(const engine::NetworkDescription& network,
                                       const std::vector<double>& stored) {
  CORDIS_ASSERT(stored.size() == network.mats.size());
  const auto count = static_cast<std::uint32_t>(network.mats.size());
  const double extent = diagonal_of(network);
  node::DisjointSets bodies = bodies_of(network);
  std::vector<double> moving(count, 0.0);  // of the body whose root this is
  for (std::uint32_t i = 0; i < count; ++i) {
    const engine::Mat& mat = network.mats[i];
    if (!is_mass(network, i)) continue;
    moving[bodies.root_of(i)] +=
        mat.mass * (0.5 * mat.velocity.squaredNorm() + network.gravity_on(mat).norm() * extent);
  }
  node::DisjointSets groups = bodies;
  join_pairs(network, groups);
  std::vector<EnergyShare> shares(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    EnergyShare& share = shares[groups.root_of(i)];
    share.of_body = std::max(share.of_body, moving[i]);
    share.stored += stored[i];
  }
  for (std::uint32_t i = 0; i < count; ++i) shares[i] = shares[groups.root_of(i)];
  return shares;
}

}  // namespace cordis::plan
