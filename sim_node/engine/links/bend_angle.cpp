// sim_node/engine/links/bend_angle.cpp
#include "sim_node/engine/links/bend_angle.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "sim_node/engine/expressions/elementary_functions.h"
#include "sim_node/engine/links/bend_shape.h"

namespace cordis::engine {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

struct AngleOfDirection {};
using OfDirection = ElementaryFunctions<AngleOfDirection>;

/// Arc tangent for 0 <= t <= tan(pi / 8): its series, whose terms fall below the rounding after the last.
double small_arc(double t) noexcept {
  constexpr int kLast = 41;
  const double square = t * t;
  double sum = 0.0;
  for (int n = kLast; n >= 1; n -= 2) sum = 1.0 / n - square * sum;
  return t * sum;
}

/// Arc tangent for 0 <= t <= 1: two halvings at most bring it to the series.
double arc(double t) noexcept {
  constexpr double kTangent = 0.41421356237309503;  // of pi / 8
  if (t <= kTangent) return small_arc(t);
  return 2.0 * small_arc(t / (1.0 + std::sqrt(1.0 + t * t)));
}

}  // namespace

double direction_of(double x, double y) noexcept {
  const double across = std::abs(x);
  const double along = std::abs(y);
  if (!(std::max(across, along) > 0.0)) return 0.0;
  double angle =
      along <= across ? arc(along / across) : 0.5 * std::numbers::pi - arc(across / along);
  if (x < 0.0) angle = std::numbers::pi - angle;
  return y < 0.0 ? -angle : angle;
}

AngleAndRate angle_of(const Bend& bend, int dimension, const BendSides& sides) noexcept {
  const auto& [u, v, rate_u, rate_v] = sides;
  if (dimension == 1) {
    return {v.x() / bend.length_bc - u.x() / bend.length_ab,
            rate_v.x() / bend.length_bc - rate_u.x() / bend.length_ab};
  }
  const Vec3 across = u.cross(v);
  const double square_u = u.squaredNorm();
  const double square_v = v.squaredNorm();
  if (!(square_u > 0.0) || !(square_v > 0.0)) return {};
  if (dimension == 2) {
    const double turn_u = (u.x() * rate_u.y() - u.y() * rate_u.x()) / square_u;
    const double turn_v = (v.x() * rate_v.y() - v.y() * rate_v.x()) / square_v;
    return {direction_of(u.dot(v), across.z()), turn_v - turn_u};
  }
  const double size = across.norm();
  AngleAndRate found{direction_of(u.dot(v), size), 0.0};
  if (!(size > 0.0)) return found;
  const Vec3 axis = across / size;
  found.rate = axis.dot(v.cross(rate_v)) / square_v - axis.dot(u.cross(rate_u)) / square_u;
  return found;
}

double angle_beyond(double rest_angle, double angle, int dimension) noexcept {
  const double beyond = angle - rest_angle;
  if (dimension != 2 || std::abs(beyond) <= std::numbers::pi) return beyond;
  if (!(std::abs(beyond) < 2.0 * kTurn)) {
    return direction_of(OfDirection::cos(beyond), OfDirection::sin(beyond));
  }
  const double nearer = beyond > 0.0 ? beyond - kTurn : beyond + kTurn;
  return angle_beyond(0.0, nearer, dimension);
}

Vec3 moment_of(const Bend& bend, int dimension, const BendSides& sides) noexcept {
  const BendShape shape(bend, dimension);
  const auto bend_vector = [&](const Vec3& u, const Vec3& v) {
    return shape(Vec3::Zero(), u, u + v);
  };
  const Vec3 w = bend_vector(sides.u, sides.v);
  const Vec3 rate =
      bend_vector(sides.rate_u, sides.rate_v) - bend_vector(Vec3::Zero(), Vec3::Zero());
  const double square = dimension == 1 ? 0.0 : dot(w, w);
  const Vec3 along = square > 0.0 ? Vec3((dot(w, rate) / square) * w) : rate;
  return bend.stiffness * w + bend.viscosity * along;
}

double moment_about_middle(const Bend& bend, int dimension, const BendSides& sides,
                           const Vec3& moment) noexcept {
  if (dimension == 1) return moment.x();
  const Vec3 torque = sides.v.cross(moment) / bend.length_bc;
  if (dimension == 2) return torque.z();
  const Vec3 across = sides.u.cross(sides.v);
  const double size = across.norm();
  return size > 0.0 ? torque.dot(across) / size : 0.0;
}

}  // namespace cordis::engine
