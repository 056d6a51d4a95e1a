// sim_node/plan/stability/energy_share.cpp
#include "sim_node/plan/stability/energy_share.h"

#include <algorithm>
#include <cstdint>

#include "node/assert.h"
#include "node/disjoint_sets.h"
#include "sim_node/plan/stability/link_ends.h"
#include "sim_node/plan/stability/scene_box.h"

namespace cordis::plan {
namespace {

bool is_mass(const engine::NetworkDescription& network, std::uint32_t mat) {
  return network.mats[mat].kind == engine::MatKind::kMass;
}

bool is_port(const engine::NetworkDescription& network, std::uint32_t mat) {
  return network.mats[mat].kind == engine::MatKind::kPort;
}

node::DisjointSets bodies_of(const engine::NetworkDescription& network) {
  node::DisjointSets bodies(network.mats.size());
  visit_links(network, [&](std::uint32_t a, std::uint32_t b) {
    if (is_mass(network, a) && is_mass(network, b)) bodies.join(a, b);
  });
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

/// Marks the masses that ports or driven matter act on.
std::vector<bool> struck_masses(const engine::NetworkDescription& network) {
  std::vector<bool> struck(network.mats.size(), false);
  const auto strike = [&](std::uint32_t a, std::uint32_t b) {
    if (is_port(network, a)) struck[b] = true;
    if (is_port(network, b)) struck[a] = true;
  };
  visit_links(network, strike);
  for (const engine::SetLiaison& set : network.sets) {
    const auto& others = set.set_q.empty() ? set.set_p : set.set_q;
    const auto strikes = [&](std::uint32_t mat) { return is_port(network, mat); };
    if (std::ranges::any_of(set.set_p, strikes))
      for (const std::uint32_t mat : others) struck[mat] = true;
    if (std::ranges::any_of(others, strikes))
      for (const std::uint32_t mat : set.set_p) struck[mat] = true;
  }
  return struck;
}

/// What a group of bodies has.
struct Group {
  double first = 0.0;   // of the richest body [J]
  double second = 0.0;  // of the next one
  double struck = 0.0;  // that a port gives to a body at most [J]
  double stored = 0.0;  // [J]
};

}  // namespace

std::vector<EnergyShare> energy_shares(const engine::NetworkDescription& network,
                                       const std::vector<double>& stored, double port_speed) {
  CORDIS_ASSERT(stored.size() == network.mats.size());
  const auto count = static_cast<std::uint32_t>(network.mats.size());
  const std::vector<double> falls = falls_of(network);
  node::DisjointSets bodies = bodies_of(network);
  std::vector<double> moving(count, 0.0);  // of the body whose root this is
  std::vector<double> mass(count, 0.0);    // likewise
  for (std::uint32_t i = 0; i < count; ++i) {
    const engine::Mat& mat = network.mats[i];
    if (!is_mass(network, i)) continue;
    mass[bodies.root_of(i)] += mat.mass;
    moving[bodies.root_of(i)] += 0.5 * mat.mass * mat.velocity.squaredNorm() + falls[i];
  }
  node::DisjointSets groups = bodies;
  join_pairs(network, groups);
  const std::vector<bool> struck = struck_masses(network);
  std::vector<Group> of(count);  // by root
  for (std::uint32_t i = 0; i < count; ++i) {
    Group& group = of[groups.root_of(i)];
    group.second = std::max(group.second, std::min(group.first, moving[i]));
    group.first = std::max(group.first, moving[i]);
    group.stored += stored[i];
    if (struck[i] && is_mass(network, i))
      group.struck =
          std::max(group.struck, 2.0 * mass[bodies.root_of(i)] * port_speed * port_speed);
  }
  std::vector<EnergyShare> shares(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    const Group& group = of[groups.root_of(i)];
    shares[i] = {group.first + group.second, group.stored, group.struck};
  }
  return shares;
}

}  // namespace cordis::plan
