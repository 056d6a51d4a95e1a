// sim_node/scene/matter/region.h -- the room that matter fills: a box, or a disc or ball.
#pragma once

#include "sim_node/scene/matter/source.h"

namespace cordis::scene {

/// A box between two corners, or all points within a radius (a disc in 2-D, a ball in 3-D).
struct Region {
  int space = 3;
  bool round = false;
  engine::Vec3 lowest = engine::Vec3::Zero();   ///< lowest corner; round: of the box around it [m]
  engine::Vec3 highest = engine::Vec3::Zero();  ///< [m]

  engine::Vec3 center() const { return 0.5 * (lowest + highest); }
  double radius() const { return 0.5 * (highest.x() - lowest.x()); }  ///< if it is round [m]
  double measure() const;  ///< area [m^2] in 2-D, volume [m^3] in 3-D

  /// True if a point lies in the region or nearer to it than `tolerance` [m].
  bool holds(const engine::Vec3& point, double tolerance) const;
  /// The point of the region nearest to `point`.
  engine::Vec3 nearest(const engine::Vec3& point) const;
  /// The region less a margin along its border [m]: where the centres of balls may be.
  Region without_margin(double margin) const;
  /// True if there is any point in it.
  bool is_possible() const { return (highest - lowest).minCoeff() >= 0.0; }
};

/// `region: {from_m, to_m}` or `region: {center_m, radius_m}`.
Region read_region(const config::Value& section, Source& source);

}  // namespace cordis::scene
