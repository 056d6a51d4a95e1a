// sim_node/plan/stability/set_slope.cpp
#include "sim_node/plan/stability/set_slope.h"

#include <algorithm>
#include <limits>
#include <variant>

#include "sim_node/plan/stability/law_energy.h"
#include "sim_node/plan/stability/parameter_bounds.h"
#include "sim_node/plan/stability/partner_bound.h"
#include "sim_node/plan/stability/start_pairs.h"
#include "sim_node/plan/stability/start_point.h"

namespace cordis::plan {
namespace {

using engine::NetworkDescription;

/// The largest distance from a surface at which its normal flips [m]: 0 where edges meet, the middle of
/// what has none, -infinity for a plane with one side.
double flips_at(const engine::Surface& surface, int dimension) {
  const engine::Vec3& half = surface.half_size;
  if (surface.both_sides) return 0.0;
  switch (surface.kind) {
    case engine::SurfaceKind::kPlane:
      return -std::numeric_limits<double>::infinity();
    case engine::SurfaceKind::kBox: {
      const auto ends = half.head(dimension).array().isFinite();
      return ends.count() == 1 ? -half.head(dimension).minCoeff() : 0.0;
    }
    case engine::SurfaceKind::kCylinder:
      return std::isinf(half[1]) ? -half[0] : 0.0;
    case engine::SurfaceKind::kSegment:
    case engine::SurfaceKind::kBoxFace:
    case engine::SurfaceKind::kCylinderWall:
    case engine::SurfaceKind::kCylinderEnd:
      return 0.0;
  }
  return 0.0;
}

/// The radii of the hollow cylinders among the surfaces of a set.
HollowRadii hollow_radii(const NetworkDescription& network, const engine::SetLiaison& set) {
  HollowRadii radii;
  for (const std::uint32_t mat : set.set_p) {
    const engine::Surface& surface = *engine::surface_of(network, mat);
    if (surface.kind != engine::SurfaceKind::kCylinderWall) continue;
    radii.narrowest = std::min(radii.narrowest, surface.half_size[0]);
    radii.widest = std::max(radii.widest, surface.half_size[0]);
  }
  return radii;
}

/// The longest rest length of a pair [m].
double longest_rest(const NetworkDescription& network, const engine::SetLiaison& set) {
  if (set.rest_length >= 0.0) return set.rest_length;
  const auto largest_of = [&](const std::vector<std::uint32_t>& mats) {
    double largest = 0.0;
    for (const std::uint32_t mat : mats) largest = std::max(largest, radius_of(network, mat));
    return largest;
  };
  return largest_of(set.set_p) + largest_of(set.set_q.empty() ? set.set_p : set.set_q);
}

}  // namespace

double smallest_radius(const NetworkDescription& network, const std::vector<std::uint32_t>& mats) {
  double smallest = std::numeric_limits<double>::infinity();
  for (const std::uint32_t mat : mats) smallest = std::min(smallest, radius_of(network, mat));
  return smallest;
}

bool all_begin_within(const engine::SetLiaison& set, const StartPairs& near) {
  const std::size_t count_p = set.set_p.size();
  const std::size_t count =
      set.set_q.empty() ? count_p * (count_p - 1) / 2 : count_p * set.set_q.size();
  return near.are_kept() && near.pairs().size() == count;
}

double smallest_rest_of(const NetworkDescription& network, const engine::SetLiaison& set) {
  if (set.rest_length >= 0.0) return set.rest_length;
  const auto& others = set.set_q.empty() ? set.set_p : set.set_q;
  return smallest_radius(network, set.set_p) + smallest_radius(network, others);
}

double flips_at(const NetworkDescription& network, const engine::SetLiaison& set) {
  double largest = -std::numeric_limits<double>::infinity();
  for (const std::uint32_t mat : set.set_p) {
    largest = std::max(largest, flips_at(*engine::surface_of(network, mat), network.dimension));
  }
  return largest;
}

double stiffness_across_at(const engine::StateMachine& state_machine, int dimension,
                           const engine::LawPoint& start) {
  if (dimension == 1 || state_machine.is_stateless() || start.distance <= 0.0) return 0.0;
  return tension_at_start(state_machine, start) / start.distance;
}

SetStart set_start_of(const NetworkDescription& network, const engine::SetLiaison& set,
                      const Reach& reach) {
  const auto& others = set.set_q.empty() ? set.set_p : set.set_q;
  const engine::StateMachine& state_machine = network.state_machines[set.state_machine];
  const StartPairs near(network, set);
  const bool on_surfaces = engine::acts_on_surfaces(network, set);
  SetStart start{reach_between(reach, network, set.set_p, others)};
  start.rest_length = smallest_rest_of(network, set);
  Reach& here = start.reach;
  double most = 0.0;  // stored in a pair
  double nearest = set.range;
  // Pairs that come into range begin there.
  const double longest = longest_rest(network, set);
  here.begins =
      near.are_kept() ? Interval{set.range - longest, set.range - start.rest_length} : kAnyNumber;
  here.rests_differ = longest > start.rest_length;
  for (const StartPair& pair : near.pairs()) {
    const engine::LawPoint point = start_point(network, set, pair);
    const double in_pair = max_stored_in(state_machine, point, here);
    most = std::max(most, in_pair);
    start.stored += in_pair;
    nearest = std::min(nearest, pair.distance);
    here.begins.low = std::min(here.begins.low, point.elongation);
    here.begins.high = std::max(here.begins.high, point.elongation);
    if (!on_surfaces)
      start.across =
          std::max(start.across, stiffness_across_at(state_machine, network.dimension, point));
  }
  if (near.at_one_point()) start.uncertainty = starts_at_one_point(state_machine, {});
  const auto& law = state_machine.states[state_machine.start].elasticity;
  start.are_balls = std::holds_alternative<engine::LennardJones>(law);
  start.all_begin_within = all_begin_within(set, near);
  const NearestPairs pairs{nearest, start.rest_length, start.all_begin_within};
  start.fall = start.are_balls ? 0.0 : brought_by_pair(network, set, pairs, here);
  if (reach.counts_sets) {
    const double all = reach.brought + here.struck;
    const double own_falls = reach.factor * brought_by_pairs(network, set, pairs, here);
    here.energy += most + std::max(reach.in_pairs - start.stored, 0.0) +
                   std::max(reach.falls - own_falls, 0.0);
    if (on_surfaces && std::isfinite(start.fall)) here.energy += start.fall;
    if (near.are_kept()) here.energy = std::min(here.energy, all);
  } else {
    here.energy += most;
    here.brought += most + (std::isfinite(start.fall) ? start.fall : 0.0);
  }
  here.range = set.range;
  start.is_known = near.are_kept();
  return start;
}

Slope largest_slope_of(const NetworkDescription& network, const engine::SetLiaison& set,
                       const SetStart& start) {
  const engine::StateMachine& state_machine = network.state_machines[set.state_machine];
  Slope slope;
  if (engine::acts_on_surfaces(network, set)) {
    slope = largest_slope_at_surfaces(state_machine, start.rest_length, flips_at(network, set),
                                      start.reach);
    slope = with_hollow(slope, state_machine, hollow_radii(network, set),
                        longest_rest(network, set), start.reach);
  } else {
    slope = largest_slope(state_machine, start.rest_length, network.dimension, start.reach);
  }
  slope.stiffness = std::max(slope.stiffness, start.across);
  if (slope.uncertainty == nullptr) slope.uncertainty = start.uncertainty;
  return with_friction(slope, state_machine);
}

}  // namespace cordis::plan
