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

LawSlope Rings::largest_slope(const LawRange& range) const noexcept {
  LawSlope slope;
  for (const Ring& inner : rings) {  // just inside this ring
    double stiffness = 0.0;
    double pull = 0.0;
    for (const Ring& ring : rings) {
      if (ring.radius >= inner.radius) stiffness += ring.stiffness;
      if (ring.radius > inner.radius) pull -= ring.stiffness * (ring.radius - inner.radius);
    }
    slope.value = std::max(slope.value, stiffness);
    if (range.turns) slope.value = std::max(slope.value, pull / inner.radius);
  }
  return slope;
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
