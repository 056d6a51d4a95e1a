// viz_node/render/vectors.h -- places and directions, with + - * / and square roots alone
#pragma once

#include <array>
#include <cmath>

#include "node/assert.h"

namespace cordis::viz {

using Point = std::array<double, 3>;  ///< x, y, z [m]

inline Point operator+(const Point& a, const Point& b) noexcept {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

inline Point operator-(const Point& a, const Point& b) noexcept {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

inline Point operator*(double factor, const Point& a) noexcept {
  return {factor * a[0], factor * a[1], factor * a[2]};
}

inline double dot(const Point& a, const Point& b) noexcept {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

inline Point cross(const Point& a, const Point& b) noexcept {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// The unit vector along `a`. Precondition: `a` is not zero.
inline Point normalized(const Point& a) noexcept {
  const double length = std::sqrt(dot(a, a));
  CORDIS_ASSERT(length > 0.0);
  return {a[0] / length, a[1] / length, a[2] / length};
}

}  // namespace cordis::viz
