// sim_node/engine/laws/rings.cpp
#include "sim_node/engine/laws/rings.h"

#include <algorithm>
#include <cmath>

#include "sim_node/engine/core/require.h"

namespace cordis::engine {

void Rings::check(const std::string& name) const {
  require(!rings.empty(), name + ": number of rings", "at least 1");
  for (const Ring& ring : rings) {
    require(std::isfinite(ring.stiffness), name + ": stiffness of a ring", "finite");
    require(std::isfinite(ring.radius) && ring.radius > 0.0, name + ": radius of a ring",
            "finite and > 0");
  }
}

double Rings::potential(double distance, double /*elongation*/) const noexcept {
  double sum = 0.0;
  for (const Ring& ring : rings) {
    if (distance < ring.radius) {
      sum += 0.5 * ring.stiffness * (ring.radius - distance) * (ring.radius - distance);
    }
  }
  return sum;
}

/// Between two radii the slope is constant, and tension / distance is monotone.
double Rings::slope_beyond(double distance, bool turns) const noexcept {
  double largest = 0.0;
  const auto consider_across = [&](double length) {
    double tension = 0.0;
    for (const Ring& ring : rings) tension -= ring.stiffness * std::max(ring.radius - length, 0.0);
    if (tension > 0.0) largest = std::max(largest, tension / length);
  };
  if (turns) consider_across(distance);
  for (const Ring& inner : rings) {  // just inside this ring
    if (inner.radius <= distance) continue;
    double stiffness = 0.0;
    for (const Ring& ring : rings) {
      if (ring.radius >= inner.radius) stiffness += ring.stiffness;
    }
    largest = std::max(largest, stiffness);
    if (turns) consider_across(inner.radius);
  }
  return largest;
}

LawSlope Rings::largest_slope(const LawRange& range) const noexcept {
  const double slope = slope_beyond(0.0, range.turns);
  if (std::isfinite(slope)) return {slope, true};
  // Rings that pull at the distance 0 turn ever faster there. Nearer than a hundredth of the
  // smallest radius they are not followed.
  constexpr double kNearest = 0.01;
  double smallest = rings.front().radius;
  for (const Ring& ring : rings) smallest = std::min(smallest, ring.radius);
  return {std::max(slope_beyond(kNearest * smallest, range.turns), slope_beyond(0.0, false)),
          false};
}

double Rings::smallest_slope(double /*elongation*/) const noexcept {
  double smallest = 0.0;
  for (const Ring& ring : rings) {
    const double size = std::abs(ring.stiffness);
    if (size != 0.0 && (smallest == 0.0 || size < smallest)) smallest = size;
  }
  return smallest;
}

double Rings::range() const noexcept {
  double range = 0.0;
  for (const Ring& ring : rings) range = std::max(range, ring.radius);
  return range;
}

}  // namespace cordis::engine
