// sim_node/engine/links/bend_angle.h -- the angle of three MATs, its rate, and their moment.
#pragma once

#include "sim_node/engine/core/vec.h"
#include "sim_node/engine/description/network.h"

namespace cordis::engine {

/// The sides of a bend and how they change: u from the first end to the middle, v from there to the second end.
struct BendSides {
  Vec3 u = Vec3::Zero();       ///< [m]
  Vec3 v = Vec3::Zero();       ///< [m]
  Vec3 rate_u = Vec3::Zero();  ///< [m/s], or a change of position [m]
  Vec3 rate_v = Vec3::Zero();
};

/// The angle from u to v. In 2 dimensions within +-pi, counter-clockwise; in 3 dimensions 0 to pi; in 1 dimension
/// the difference of the slopes over the rest lengths. It is 0 while a side has no length.
struct AngleAndRate {
  double angle = 0.0;  ///< [rad]
  double rate = 0.0;   ///< [rad/s], or to first order [rad]; 0 in space while straight or folded
};

/// Real time: O(1), no allocation; the same bits everywhere.
AngleAndRate angle_of(const Bend& bend, int dimension, const BendSides& sides) noexcept;

/// An angle less a rest angle; in 2 dimensions within +-pi [rad].
double angle_beyond(double rest_angle, double angle, int dimension) noexcept;

/// The moment along the bend vector, B w + Z (its rate along it), as the force of a bend has it [N m].
Vec3 moment_of(const Bend& bend, int dimension, const BendSides& sides) noexcept;

/// The torque with which a moment along the bend vector turns the sides back [N m], positive against a positive
/// bend: B sin(angle - rest) for sides of their rest lengths.
double moment_about_middle(const Bend& bend, int dimension, const BendSides& sides,
                           const Vec3& moment) noexcept;

/// The angle of a point (x, y) from the x axis, within +-pi [rad]; 0 at the origin. Error: below 1e-15.
double direction_of(double x, double y) noexcept;

}  // namespace cordis::engine
