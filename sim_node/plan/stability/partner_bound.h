// sim_node/plan/stability/partner_bound.h -- how many others a member of a set may touch at once.
#pragma once

#include <cstdint>
#include <vector>

#include "sim_node/engine/description/network.h"

namespace cordis::plan {

/// The numbers of partners of the members of a set, those of the first set first.
struct PartnerBounds {
  /// At the start, the most of any mass.
  std::uint32_t at_start = 0;
  /// By member: what a step has to support. The larger of the number of equal hard balls that
  /// touch one at once (max_neighbours) and of 1.25 times the most at the start; and as many fixed
  /// points as it can reach.
  std::vector<double> needed;
  /// By member: no pose whatever has more. All others there are, or as many of them as are in
  /// reach of one place where all are fixed points or surfaces. Of surfaces that many are needed too.
  std::vector<double> possible;
};

/// How far above the numbers at the start the certificate goes.
inline constexpr double kPartnerMargin = 1.25;

/// O(members + pairs in range at the start).
PartnerBounds partner_bounds(const engine::NetworkDescription& network,
                             const engine::SetLiaison& set);

/// The radius of the ball of a MAT; 0 where it has none [m].
double radius_of(const engine::NetworkDescription& network, std::uint32_t mat);

/// How many balls of radius `other` touch a ball of radius `own` at once, at most: the kissing
/// number of the space for balls that are not smaller, a bound of packing for smaller ones.
double max_neighbours(int dimension, double own, double other);

/// How many points that are nowhere nearer to each other than `spacing` lie within `reach` of one
/// of them, at most; 0 < spacing <= reach. See partner_bound.cpp for the derivation.
double packing_bound(int dimension, double reach, double spacing);

/// How many of these points lie within `reach` of any place, at most: exact in 1 dimension, above
/// the true number by up to a half in 2, by more in 3.
double max_in_reach(const std::vector<engine::Vec3>& points, double reach, int dimension);

}  // namespace cordis::plan
