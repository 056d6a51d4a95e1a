// sim_node/plan/stability/touch_sum.cpp
#include "sim_node/plan/stability/touch_sum.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "sim_node/plan/stability/partner_bound.h"

namespace cordis::plan {
namespace {

using engine::NetworkDescription;
using engine::Vec3;

/// The touches that come together at a mass, from one side of it [N/m].
struct Touches {
  double sum = 0.0;
  double strongest = 0.0;
  double other_end = 0.0;  // the largest K / m of an other end [1/s^2]
  LiaisonId liaison;

  void add(LiaisonId id, double stiffness, double of_one, double other_inverse_mass) {
    sum += stiffness;
    other_end = std::max(other_end, of_one * other_inverse_mass);
    if (stiffness <= strongest) return;
    strongest = stiffness;
    liaison = id;
  }
};

/// By MAT: what drives it towards larger coordinates and towards smaller ones; in 2 and 3 dimensions both have all.
using TouchesOfMats = std::vector<std::array<Touches, 2>>;

/// The side to which a link with states drives its second end in 1 dimension, or both.
std::array<bool, 2> sides_of(const NetworkDescription& network, LiaisonId liaison) {
  if (network.dimension > 1 || liaison.kind != LiaisonKind::kStateLink) return {true, true};
  const std::uint32_t machine = network.state_links[liaison.index].state_machine;
  std::array<bool, 2> sides{false, false};
  for (const engine::LinkState& state : network.state_machines[machine].states) {
    sides[0] = sides[0] || state.pushes;
    sides[1] = sides[1] || state.pulls;
  }
  return sides;
}

void add_edge(const NetworkDescription& network, const LiaisonGraph& graph, const Edge& edge,
              TouchesOfMats& all) {
  const std::array<bool, 2> sides = sides_of(network, edge.liaison);
  for (const std::size_t side : {0U, 1U}) {
    if (!sides[side]) continue;
    all[edge.mat_b][side].add(edge.liaison, edge.stiffness, edge.stiffness,
                              graph.inverse_mass[edge.mat_a]);
    all[edge.mat_a][1U - side].add(edge.liaison, edge.stiffness, edge.stiffness,
                                   graph.inverse_mass[edge.mat_b]);
  }
}

/// How many that touch a MAT on all sides touch it on one.
double share_of_a_side(int dimension, double number) {
  return std::max(number / (2.0 * dimension), std::min(number, 1.0));
}

/// What balls that a ball meets between count for beyond one of them.
double beyond_one(const NetworkDescription& network, const ContactBound& contact) {
  const auto is_mass = [&](std::uint32_t mat) {
    return network.mats[mat].kind == engine::MatKind::kMass;
  };
  if (std::ranges::none_of(contact.others, is_mass)) return 0.0;
  return share_of_a_side(network.dimension, max_neighbours(network.dimension, 0.0, 0.0)) - 1.0;
}

/// @param spare  so many partners of a member count for nothing, but for the first
void add_contact(const LiaisonGraph& graph, const ContactBound& contact, double spare,
                 TouchesOfMats& all) {
  const LiaisonId id{LiaisonKind::kSet, contact.set};
  const double lightest = largest_of_others(contact, graph.inverse_mass);
  for (std::size_t m = 0; m < contact.members.size(); ++m) {
    const double touching = std::max(contact.neighbours[m] - contact.apart[m], 0.0);
    if (touching == 0.0) continue;
    for (Touches& side : all[contact.members[m]])
      side.add(id, std::max(touching - spare, 1.0) * contact.stiffness, contact.stiffness,
               lightest);
  }
}

/// The normal of a surface that has one alone; 0 where there are several.
Vec3 normal_of(const engine::Surface& surface) {
  switch (surface.kind) {
    case engine::SurfaceKind::kPlane:
    case engine::SurfaceKind::kBoxFace:
    case engine::SurfaceKind::kCylinderEnd:
      return surface.both_sides ? Vec3::Zero() : surface.axis;
    default:
      return Vec3::Zero();
  }
}

/// A bound of the largest eigenvalue of the sum over n n' for the normals of one side: that of a row of n'n.
double surfaces_on_one_side(const NetworkDescription& network,
                            const std::vector<std::uint32_t>& surfaces) {
  constexpr std::size_t kMaxSurfaces = 2000;
  if (surfaces.size() > kMaxSurfaces) return std::numeric_limits<double>::infinity();
  std::vector<Vec3> normals;
  for (const std::uint32_t mat : surfaces)
    normals.push_back(normal_of(*engine::surface_of(network, mat)));
  double most = 0.0;
  for (const Vec3& one : normals) {
    double row = 0.0;
    for (const Vec3& other : normals) {
      const bool is_known = !one.isZero() && !other.isZero();
      row += is_known ? std::max(one.dot(other), 0.0) : 1.0;
    }
    most = std::max(most, row);
  }
  return most;
}

}  // namespace

std::vector<double> apart_of(const NetworkDescription& network, const engine::SetLiaison& set,
                             const ContactBound& side) {
  std::vector<double> apart(side.members.size(), 0.0);
  if (engine::acts_on_surfaces(network, set)) {
    if (side.others != set.set_p) return apart;
    const double most = surfaces_on_one_side(network, side.others);
    for (std::size_t m = 0; m < apart.size(); ++m)
      apart[m] = std::max(side.neighbours[m] - most, 0.0);
    return apart;
  }
  std::vector<Vec3> fixed;
  double smallest = std::numeric_limits<double>::infinity();
  for (const std::uint32_t mat : side.others) {
    smallest = std::min(smallest, radius_of(network, mat));
    if (network.mats[mat].kind == engine::MatKind::kFixed)
      fixed.push_back(network.mats[mat].position);
  }
  const int dimension = network.dimension;
  const double reach =
      std::min(engine::touch_distance(network.state_machines[set.state_machine]), set.range);
  const double in_reach = max_in_reach(fixed, reach, dimension);
  // Within half the reach they are seen under an angle of 60 degrees: a side has room for some such groups.
  const double group = max_in_reach(fixed, 0.5 * reach, dimension);
  const double groups = share_of_a_side(dimension, max_neighbours(dimension, 0.0, 0.0));
  const double of_fixed = std::min(in_reach, group * groups);
  const bool all_fixed = fixed.size() == side.others.size();
  for (std::size_t m = 0; m < apart.size(); ++m) {
    const double balls =
        all_fixed ? 0.0 : max_neighbours(dimension, radius_of(network, side.members[m]), smallest);
    const double around = in_reach + balls;
    const double on_one_side = of_fixed + share_of_a_side(dimension, balls);
    apart[m] = std::max(std::min(around, side.neighbours[m]) - on_one_side, 0.0);
  }
  return apart;
}

std::optional<TouchSum> largest_touch(const NetworkDescription& network, const LiaisonGraph& graph,
                                      const std::function<bool(LiaisonId)>& counts, Packs packs) {
  TouchesOfMats all(graph.inverse_mass.size());
  for (const Edge& edge : graph.edges) {
    if (counts(edge.liaison)) add_edge(network, graph, edge, all);
  }
  for (const ContactBound& contact : graph.contacts) {
    if (contact.counted && counts({LiaisonKind::kSet, contact.set}))
      add_contact(graph, contact, packs == Packs::kAsOneBall ? beyond_one(network, contact) : 0.0,
                  all);
  }
  std::optional<TouchSum> most;
  for (std::size_t mat = 0; mat < all.size(); ++mat) {
    const double inverse_mass = graph.inverse_mass[mat];
    for (const Touches& side : all[mat]) {
      if (inverse_mass == 0.0 || side.strongest == 0.0) continue;
      const double square = network.step * network.step;
      const double together = square * (side.sum * inverse_mass + side.other_end);
      if (most && together <= most->stiffness) continue;
      const double alone = square * (side.strongest * inverse_mass + side.other_end);
      most = {side.liaison, together, side.sum > side.strongest, alone};
    }
  }
  return most;
}

}  // namespace cordis::plan
