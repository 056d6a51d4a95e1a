// sim_node/engine/links/bend_shape.h -- how far three MATs are bent, and what a moment does.
#pragma once

#include "sim_node/engine/core/vec.h"
#include "sim_node/engine/description/network.h"

namespace cordis::engine {

/// The bend vector w of three MATs, and the forces of a moment along it. See Bend.
///
/// w is a linear function of the three positions. It is 0 at the rest angle. While the sides have their
/// rest lengths, its length is 2 sin(half the angle beyond the rest angle).
class BendShape {
 public:
  /// @param dimension  of the network
  BendShape(const Bend& bend, int dimension) noexcept;
  /// Gives it another rest angle [rad]. Real time: O(1), no allocation.
  void set_rest(double rest_angle, int dimension) noexcept;

  /// w at these positions.
  Vec3 operator()(const Vec3& a, const Vec3& b, const Vec3& c) const noexcept {
    Vec3 w = per_bc_ * (c - b) - per_ab_ * turned(b - a, sine_);
    w[0] -= offset_;
    return w;
  }

  /// Forces on the two ends by a moment M along w, [N] where M is in N m. The middle has the opposite of both.
  Vec3 force_on_a(const Vec3& moment) const noexcept { return -per_ab_ * turned(moment, -sine_); }
  Vec3 force_on_c(const Vec3& moment) const noexcept { return -per_bc_ * moment; }

 private:
  Vec3 turned(const Vec3& side, double sine) const noexcept {
    return {cosine_ * side[0] - sine * side[1], sine * side[0] + cosine_ * side[1], side[2]};
  }

  double per_ab_;  // 1 / rest length [1/m]
  double per_bc_;
  double cosine_ = 1.0;  // of the rest angle, in 2 dimensions
  double sine_ = 0.0;
  double offset_ = 0.0;  // the rest angle in 1 dimension [rad]
};

/// The bend vector of a bend where the scene starts.
Vec3 bend_at_start(const NetworkDescription& network, const Bend& bend) noexcept;

}  // namespace cordis::engine
