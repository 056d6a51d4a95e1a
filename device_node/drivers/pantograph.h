// device_node/drivers/pantograph.h -- the kinematics of a pantograph, both ways.
#pragma once

#include <array>

namespace cordis::device {

/// A pen that two motors hold by two arms each. Inner arms go from the bases at (-base/2, 0) and
/// (base/2, 0), at the angles of the motors. From their ends outer arms meet in the pen, on the
/// side away from the bases. Motor 0 is the one on the left. Angles count from x,
/// counter-clockwise.
struct Pantograph {
  double inner_m = 0.07;
  double outer_m = 0.09;
  double base_m = 0.0;

  using Pair = std::array<double, 2>;

  /// A pose of the arms, or none for angles at which the outer arms do not meet.
  struct Pose {
    bool exists = false;
    Pair pen_m{};                         ///< x, y
    std::array<Pair, 2> way_per_angle{};  ///< [i][k] = d pen_i / d angle_k [m/rad]
  };
  Pose forward(const Pair& angle_rad) const noexcept;

  /// The angles that hold the pen there, elbows outwards; false when it is out of reach, or would
  /// hang on the other side of the elbows.
  bool inverse(const Pair& pen_m, Pair& angle_rad) const noexcept;

  /// Torques of the motors that give a force at the pen: the transposed Jacobian [N m]. Where the
  /// outer arms are nearly in line they grow beyond all bounds, and are both made smaller by the
  /// same factor, so that none exceeds the limit.
  static Pair torques(const Pose& pose, const Pair& force_n, double limit_n_m) noexcept;
};

}  // namespace cordis::device
