// device_node/drivers/pantograph.cpp
#include "device_node/drivers/pantograph.h"

#include <algorithm>
#include <cmath>

namespace cordis::device {

Pantograph::Pose Pantograph::forward(const Pair& angle_rad) const noexcept {
  Pose pose;
  std::array<Pair, 2> elbow;
  std::array<Pair, 2> turn;  // of an elbow per angle of its motor
  for (std::size_t k = 0; k < 2; ++k) {
    const double base = (k == 0 ? -0.5 : 0.5) * base_m;
    const double c = std::cos(angle_rad[k]);
    const double s = std::sin(angle_rad[k]);
    elbow[k] = {base + inner_m * c, inner_m * s};
    turn[k] = {-inner_m * s, inner_m * c};
  }
  // The pen is at the distance `outer` from both elbows, to the right of the way from the right
  // elbow to the left one: away from the bases.
  const Pair apart{elbow[0][0] - elbow[1][0], elbow[0][1] - elbow[1][1]};
  const double gap = std::hypot(apart[0], apart[1]);
  const double height_squared = outer_m * outer_m - 0.25 * gap * gap;
  if (!(gap > 1e-9) || !(height_squared > 1e-12)) return pose;
  const double height = std::sqrt(height_squared);
  pose.pen_m = {0.5 * (elbow[0][0] + elbow[1][0]) + height * apart[1] / gap,
                0.5 * (elbow[0][1] + elbow[1][1]) - height * apart[0] / gap};

  // |pen - elbow_k| is constant: (pen - elbow_k) . (d pen - d elbow_k) = 0 for both k.
  const Pair left{pose.pen_m[0] - elbow[0][0], pose.pen_m[1] - elbow[0][1]};
  const Pair right{pose.pen_m[0] - elbow[1][0], pose.pen_m[1] - elbow[1][1]};
  const double determinant = left[0] * right[1] - left[1] * right[0];
  if (!(std::abs(determinant) > 1e-9)) return pose;
  const double by_left = (left[0] * turn[0][0] + left[1] * turn[0][1]) / determinant;
  const double by_right = (right[0] * turn[1][0] + right[1] * turn[1][1]) / determinant;
  pose.way_per_angle[0] = {right[1] * by_left, -left[1] * by_right};
  pose.way_per_angle[1] = {-right[0] * by_left, left[0] * by_right};
  pose.exists = true;
  return pose;
}

bool Pantograph::inverse(const Pair& pen_m, Pair& angle_rad) const noexcept {
  for (std::size_t k = 0; k < 2; ++k) {
    const double x = pen_m[0] - (k == 0 ? -0.5 : 0.5) * base_m;
    const double y = pen_m[1];
    const double reach = std::hypot(x, y);
    const double cosine =
        (inner_m * inner_m + reach * reach - outer_m * outer_m) / (2.0 * inner_m * reach);
    if (!(std::abs(cosine) <= 1.0)) return false;
    const double bend = std::acos(cosine);
    angle_rad[k] = std::atan2(y, x) + (k == 0 ? bend : -bend);
  }
  constexpr double kSamePlace = 1e-6;  // [m]
  const Pose pose = forward(angle_rad);
  return pose.exists && std::hypot(pose.pen_m[0] - pen_m[0], pose.pen_m[1] - pen_m[1]) < kSamePlace;
}

Pantograph::Pair Pantograph::torques(const Pose& pose, const Pair& force_n,
                                     double limit_n_m) noexcept {
  Pair torque{};
  for (std::size_t k = 0; k < 2; ++k) {
    torque[k] = pose.way_per_angle[0][k] * force_n[0] + pose.way_per_angle[1][k] * force_n[1];
  }
  const double largest = std::max(std::abs(torque[0]), std::abs(torque[1]));
  if (largest > limit_n_m) {
    for (double& value : torque) value *= limit_n_m / largest;
  }
  return torque;
}

}  // namespace cordis::device
