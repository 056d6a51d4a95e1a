// sim_node/scene/matter/region.cpp
#include "sim_node/scene/matter/region.h"

#include <numbers>

namespace cordis::scene {

using engine::Vec3;

double Region::measure() const {
  constexpr double kPi = std::numbers::pi;
  if (round)
    return space == 2 ? kPi * radius() * radius()
                      : 4.0 / 3.0 * kPi * radius() * radius() * radius();
  const Vec3 size = highest - lowest;
  return space == 2 ? size.x() * size.y() : size.prod();
}

bool Region::holds(const Vec3& point, double tolerance) const {
  if (round) return (point - center()).norm() <= radius() + tolerance;
  return (point - lowest).minCoeff() >= -tolerance && (highest - point).minCoeff() >= -tolerance;
}

Vec3 Region::nearest(const Vec3& point) const {
  if (!round) return point.cwiseMax(lowest).cwiseMin(highest);
  const Vec3 from_center = point - center();
  const double distance = from_center.norm();
  return distance <= radius() ? point : Vec3(center() + from_center * (radius() / distance));
}

Region Region::without_margin(double margin) const {
  Region inner = *this;
  for (int axis = 0; axis < space; ++axis) {
    inner.lowest[axis] += margin;
    inner.highest[axis] -= margin;
  }
  return inner;
}

Region read_region(const config::Value& section, Source& source) {
  Region region;
  region.space = source.space;
  config::MappingReader reader(section, "'region' of " + source.reader.what(), source.problems);
  region.round = reader.has("center_m") || reader.has("radius_m");
  if (region.round) {
    const Vec3 center = required_point(reader, "center_m", source.space);
    const double radius = reader.required_number("radius_m", {0.0, kFarthest, true});
    for (int axis = 0; axis < source.space; ++axis) {
      region.lowest[axis] = center[axis] - radius;
      region.highest[axis] = center[axis] + radius;
    }
  } else {
    const Vec3 from = required_point(reader, "from_m", source.space);
    const Vec3 to = required_point(reader, "to_m", source.space);
    region.lowest = from.cwiseMin(to);
    region.highest = from.cwiseMax(to);
  }
  reader.finish();
  return region;
}

}  // namespace cordis::scene
