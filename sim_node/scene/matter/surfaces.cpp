// sim_node/scene/matter/surfaces.cpp
#include "sim_node/scene/matter/surfaces.h"

#include <cmath>
#include <limits>

namespace cordis::scene {

using config::Range;
using engine::Surface;
using engine::SurfaceKind;
using engine::Vec3;

namespace {

constexpr double kNoEnd = std::numeric_limits<double>::infinity();

GeneratedMatter matter_of(Source& source, const std::vector<Surface>& surfaces, const Vec3& place) {
  GeneratedMatter matter;
  for (const Surface& surface : surfaces) {
    matter.surfaces.push_back(surface);
    matter.surfaces.back().mat = static_cast<std::uint32_t>(matter.mats.size());
    matter.mats.push_back({engine::MatKind::kFixed, 0.0, place, Vec3::Zero()});
    matter.radius_m.push_back(0.0);
  }
  matter.layout = row_layout(source, matter.mats.size());
  return matter;
}

bool has_both_sides(Source& source) {
  return source.reader.optional_choice("sides", "one", {"one", "both"}) == "both";
}

/// A body that is solid, or hollow: of both sides.
GeneratedMatter body_of(Source& source, const Surface& body, const Vec3& place) {
  if (!has_both_sides(source) || !source.reader.ok()) return matter_of(source, {body}, place);
  return matter_of(source, engine::hollow_surfaces(body), place);
}

/// One direction; the first axis after a problem.
Vec3 required_direction(Source& source, const std::string& key) {
  const config::Value value = source.reader.required_value(key);
  if (!value.exists()) return Vec3::UnitX();
  const std::string what = "'" + key + "' in " + source.reader.what();
  const std::vector<Vec3> directions = read_directions(value, what, source.space, source.problems);
  if (directions.size() == 1) return directions[0];
  if (!directions.empty()) source.reader.error_at(key, what + " must be one direction");
  return Vec3::UnitX();
}

/// Reads a box between two opposite corners.
void take_corners(Source& source, Surface& box, Vec3& centre) {
  config::MappingReader& reader = source.reader;
  for (const char* other : {"center_m", "size_m"}) {
    if (reader.has(other))
      reader.error_at(other, "a box has two corners, or a center and a size: one of them");
    reader.optional_value(other);
  }
  const Vec3 from = required_point(reader, "from_m", source.space);
  const Vec3 to = required_point(reader, "to_m", source.space);
  centre = 0.5 * (from + to);
  for (int axis = 0; axis < source.space; ++axis) {
    box.half_size[axis] = 0.5 * std::abs(to[axis] - from[axis]);
    if (box.half_size[axis] > 0.0) continue;
    reader.error_at("to_m", "the corners of a box must differ along every axis");
    return;
  }
}

/// Reads the center and the size of a box; along an axis of size 0 it has no end.
void take_size(Source& source, Surface& box, Vec3& centre) {
  config::MappingReader& reader = source.reader;
  centre = required_point(reader, "center_m", source.space);
  const Vec3 size = required_point(reader, "size_m", source.space);
  bool has_end = false;
  for (int axis = 0; axis < source.space; ++axis) {
    if (size[axis] < 0.0)
      reader.error_at("size_m", "'size_m' in " + reader.what() + " must be >= 0");
    if (size[axis] <= 0.0) continue;
    box.half_size[axis] = 0.5 * size[axis];
    has_end = true;
  }
  if (!has_end && reader.ok())
    reader.error_at("size_m", "a box must have a size along one axis at least");
}

}  // namespace

GeneratedMatter read_plane_surface(Source& source) {
  Surface plane;
  plane.kind = SurfaceKind::kPlane;
  const Vec3 place = required_point(source.reader, "at_m", source.space);
  plane.axis = required_direction(source, "normal");
  plane.both_sides = has_both_sides(source);
  return matter_of(source, {plane}, place);
}

GeneratedMatter read_box(Source& source) {
  Surface box;
  box.kind = SurfaceKind::kBox;
  box.half_size = Vec3::Constant(kNoEnd);
  Vec3 centre = Vec3::Zero();
  const bool has_corners = source.reader.has("from_m") || source.reader.has("to_m");
  if (has_corners) {
    take_corners(source, box, centre);
  } else {
    take_size(source, box, centre);
  }
  return body_of(source, box, centre);
}

GeneratedMatter read_cylinder(Source& source) {
  Surface cylinder;
  cylinder.kind = SurfaceKind::kCylinder;
  cylinder.axis = Vec3::UnitZ();
  const Vec3 centre = required_point(source.reader, "center_m", source.space);
  cylinder.half_size =
      Vec3(source.reader.required_number("radius_m", {0.0, kFarthest, true}), kNoEnd, 0.0);
  if (source.space == 3) {
    cylinder.axis = required_direction(source, "axis");
    if (source.reader.has("length_m")) {
      cylinder.half_size[1] =
          0.5 * source.reader.required_number("length_m", {0.0, kFarthest, true});
    }
  }
  return body_of(source, cylinder, centre);
}

GeneratedMatter read_polyline(Source& source) {
  config::MappingReader& reader = source.reader;
  std::vector<Vec3> corners = required_points(reader, "corners_m", source.space, source.problems);
  const bool is_closed = reader.optional_truth("closed", false);
  const std::size_t least = is_closed ? 3 : 2;
  if (reader.ok() && corners.size() < least) {
    reader.error_at("corners_m", "'corners_m' in " + reader.what() + " must be at least " +
                                     std::to_string(least) + " points, got " +
                                     std::to_string(corners.size()));
  }
  if (!reader.ok()) return {};
  if (is_closed) corners.push_back(corners.front());
  GeneratedMatter matter;
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
    const Vec3 side = corners[i + 1] - corners[i];
    Surface segment;
    segment.kind = SurfaceKind::kSegment;
    segment.mat = static_cast<std::uint32_t>(i);
    segment.half_size = Vec3(0.5 * side.norm(), 0.0, 0.0);
    if (!(segment.half_size[0] > 0.0)) {
      reader.error_at("corners_m", "two corners of " + reader.what() +
                                       " that follow each other are the same point");
      return {};
    }
    segment.axis = side.normalized();
    matter.mats.push_back({engine::MatKind::kFixed, 0.0, corners[i] + 0.5 * side, Vec3::Zero()});
    matter.radius_m.push_back(0.0);
    matter.surfaces.push_back(segment);
  }
  const auto join = [](Surface& before, Surface& after) {
    constexpr double kRightAngle = -1e-9;
    if (engine::dot(before.axis, after.axis) < kRightAngle) return;
    before.leads_to = after.axis;
    after.comes_from = before.axis;
  };
  for (std::size_t i = 1; i < matter.surfaces.size(); ++i)
    join(matter.surfaces[i - 1], matter.surfaces[i]);
  if (is_closed) join(matter.surfaces.back(), matter.surfaces.front());
  return matter;
}

bool turn_surface(const Placement& placement, int space, Surface& surface) {
  if (surface.kind != SurfaceKind::kBox && surface.kind != SurfaceKind::kBoxFace) {
    const bool is_round =
        surface.kind == SurfaceKind::kCylinder || surface.kind == SurfaceKind::kCylinderWall;
    if (is_round && space == 2) return true;
    for (Vec3* axis : {&surface.axis, &surface.comes_from, &surface.leads_to})
      *axis = (placement.turn * *axis).normalized();
    return true;
  }
  Vec3 turned = Vec3::Zero();
  Vec3 normal = Vec3::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    for (int from = 0; from < 3; ++from) {
      const double share = std::abs(placement.turn(axis, from));
      if (share != 1.0) continue;
      turned[axis] = surface.half_size[from];
      normal[axis] = placement.turn(axis, from) * surface.axis[from];
    }
    if (turned[axis] == 0.0) return false;
  }
  surface.half_size = turned;
  if (surface.kind == SurfaceKind::kBoxFace) surface.axis = normal;
  return true;
}

}  // namespace cordis::scene
