// sim_node/engine/description/surface.cpp
#include "sim_node/engine/description/surface.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "node/assert.h"
#include "sim_node/engine/description/network.h"

namespace cordis::engine {
namespace {

/// The distance from what has no inside, at this height over it on the side of `normal`.
SurfaceDistance without_sign(double height, const Vec3& normal, bool is_beyond) noexcept {
  if (height > 0.0) return {height, normal, is_beyond};
  return {-height, height < 0.0 ? Vec3(-normal) : Vec3(Vec3::Zero()), is_beyond};
}

SurfaceDistance from_plane(const Surface& plane, const Vec3& from_centre) noexcept {
  const double height = dot(plane.axis, from_centre);
  if (!plane.both_sides) return {height, plane.axis};
  return without_sign(height, plane.axis, /*is_beyond=*/false);
}

SurfaceDistance from_box(const Surface& box, const Vec3& from_centre) noexcept {
  double square = 0.0;
  double nearest = -std::numeric_limits<double>::infinity();
  int face = 0;
  Vec3 beyond = Vec3::Zero();
  for (int k = 0; k < 3; ++k) {
    const double height = std::abs(from_centre[k]) - box.half_size[k];
    if (height > nearest) {
      nearest = height;
      face = k;
    }
    if (!(height > 0.0)) continue;
    beyond[k] = std::copysign(height, from_centre[k]);
    square += height * height;
  }
  if (nearest > 0.0) {
    const double distance = std::sqrt(square);
    return {distance, beyond / distance};
  }
  Vec3 normal = Vec3::Zero();
  normal[face] = from_centre[face] < 0.0 ? -1.0 : 1.0;
  return {nearest, normal};
}

/// A unit vector across another.
Vec3 across(const Vec3& axis) noexcept {
  int least = 0;
  for (int k = 1; k < 3; ++k) {
    if (std::abs(axis[k]) < std::abs(axis[least])) least = k;
  }
  Vec3 along = Vec3::Zero();
  along[least] = 1.0;
  along -= axis[least] * axis;
  return along / std::sqrt(dot(along, along));
}

SurfaceDistance from_cylinder(const Surface& cylinder, const Vec3& from_centre) noexcept {
  const double along = dot(cylinder.axis, from_centre);
  const Vec3 radial = from_centre - along * cylinder.axis;
  const double radius = std::sqrt(dot(radial, radial));
  const Vec3 outwards = radius > 0.0 ? Vec3(radial / radius) : across(cylinder.axis);
  const Vec3 to_end = along < 0.0 ? Vec3(-cylinder.axis) : cylinder.axis;
  const double from_side = radius - cylinder.half_size[0];
  const double from_end = std::abs(along) - cylinder.half_size[1];
  if (!(from_end > 0.0)) {
    return from_end > from_side ? SurfaceDistance{from_end, to_end}
                                : SurfaceDistance{from_side, outwards};
  }
  if (!(from_side > 0.0)) return {from_end, to_end};
  const double distance = std::sqrt(from_side * from_side + from_end * from_end);
  return {distance, (from_side / distance) * outwards + (from_end / distance) * to_end};
}

/// Twice the area between two vectors of the plane, > 0 if the second one points to the left of the first.
double area(const Vec3& a, const Vec3& b) noexcept {
  return a.x() * b.y() - a.y() * b.x();
}

/// True if another segment acts alone on a place beyond an end of this one. The neighbour before this one owns the outer
/// side of their corner, this one that of its end, but for what lies beside the neighbour. On the inner side both act.
bool is_left_to_neighbour(const Surface& segment, double along, const Vec3& from_centre) noexcept {
  const double half = segment.half_size[0];
  if (!(along > -half)) {
    const Vec3& before = segment.comes_from;
    const Vec3 from_corner = from_centre + half * segment.axis;
    return !before.isZero(0.0) && !(area(before, segment.axis) * area(before, from_corner) > 0.0);
  }
  if (!(along > half)) return false;
  const Vec3& after = segment.leads_to;
  const Vec3 from_corner = from_centre - half * segment.axis;
  return dot(after, from_corner) > 0.0 &&
         !(area(segment.axis, after) * area(after, from_corner) > 0.0);
}

SurfaceDistance from_segment(const Surface& segment, const Vec3& from_centre) noexcept {
  const double half = segment.half_size[0];
  const double along = dot(segment.axis, from_centre);
  const Vec3 apart = from_centre - std::clamp(along, -half, half) * segment.axis;
  const double distance = std::sqrt(dot(apart, apart));
  const bool is_beyond = is_left_to_neighbour(segment, along, from_centre);
  if (!(distance > 0.0)) return {0.0, Vec3::Zero(), is_beyond};
  return {distance, apart / distance, is_beyond};
}

/// The outside of a hollow body, from that of a solid one.
SurfaceDistance outside_of(const Surface& body, const SurfaceDistance& solid) noexcept {
  if (!body.both_sides) return solid;
  return without_sign(solid.distance, solid.normal, solid.distance < 0.0);
}

/// The axis that a face of a box is across.
int axis_across(const Surface& face) noexcept {
  for (int k = 0; k < 2; ++k) {
    if (face.axis[k] != 0.0) return k;
  }
  return 2;
}

SurfaceDistance from_box_face(const Surface& face, const Vec3& from_centre) noexcept {
  const int k = axis_across(face);
  const double height = face.axis[k] * from_centre[k] + face.half_size[k];
  const bool is_beyond = (from_centre.cwiseAbs().array() > face.half_size.array()).any();
  return without_sign(height, face.axis, is_beyond);
}

/// Where a place is in a cylinder.
struct Cylindrical {
  Cylindrical(const Surface& cylinder, const Vec3& from_centre) noexcept
      : along(dot(cylinder.axis, from_centre)),
        radial(from_centre - along * cylinder.axis),
        radius(std::sqrt(dot(radial, radial))),
        is_outside(radius > cylinder.half_size[0] || std::abs(along) > cylinder.half_size[1]) {}

  double along;
  Vec3 radial;
  double radius;
  bool is_outside;
};

SurfaceDistance from_cylinder_wall(const Surface& wall, const Vec3& from_centre) noexcept {
  const Cylindrical place(wall, from_centre);
  const double height = wall.half_size[0] - place.radius;
  if (!(place.radius > 0.0)) return {height, Vec3::Zero(), place.is_outside};
  return without_sign(height, Vec3(-place.radial / place.radius), place.is_outside);
}

SurfaceDistance from_cylinder_end(const Surface& end, const Vec3& from_centre) noexcept {
  const Cylindrical place(end, from_centre);
  return without_sign(place.along + end.half_size[1], end.axis, place.is_outside);
}

}  // namespace

SurfaceDistance distance_from(const Surface& surface, const Vec3& centre,
                              const Vec3& place) noexcept {
  const Vec3 from_centre = place - centre;
  switch (surface.kind) {
    case SurfaceKind::kPlane:
      return from_plane(surface, from_centre);
    case SurfaceKind::kBox:
      return outside_of(surface, from_box(surface, from_centre));
    case SurfaceKind::kCylinder:
      return outside_of(surface, from_cylinder(surface, from_centre));
    case SurfaceKind::kSegment:
      return from_segment(surface, from_centre);
    case SurfaceKind::kBoxFace:
      return from_box_face(surface, from_centre);
    case SurfaceKind::kCylinderWall:
      return from_cylinder_wall(surface, from_centre);
    case SurfaceKind::kCylinderEnd:
      return from_cylinder_end(surface, from_centre);
  }
  return {};
}

std::vector<Surface> hollow_surfaces(const Surface& body) {
  CORDIS_ASSERT(body.kind == SurfaceKind::kBox || body.kind == SurfaceKind::kCylinder);
  std::vector<Surface> surfaces{body};
  surfaces[0].both_sides = true;
  const auto add = [&](SurfaceKind kind, const Vec3& axis) {
    surfaces.push_back(body);
    surfaces.back().kind = kind;
    surfaces.back().axis = axis;
  };
  const auto has_ends = [&body](int k) { return std::isfinite(body.half_size[k]); };
  if (body.kind == SurfaceKind::kCylinder) {
    add(SurfaceKind::kCylinderWall, body.axis);
    if (!has_ends(1)) return surfaces;
    add(SurfaceKind::kCylinderEnd, body.axis);
    add(SurfaceKind::kCylinderEnd, -body.axis);
    return surfaces;
  }
  for (int k = 0; k < 3; ++k) {
    if (!has_ends(k)) continue;
    add(SurfaceKind::kBoxFace, Vec3::Unit(k));
    add(SurfaceKind::kBoxFace, -Vec3::Unit(k));
  }
  return surfaces;
}

const Surface* surface_of(const NetworkDescription& network, std::uint32_t mat) noexcept {
  for (const Surface& surface : network.surfaces) {
    if (surface.mat == mat) return &surface;
  }
  return nullptr;
}

bool acts_on_surfaces(const NetworkDescription& network, const SetLiaison& set) noexcept {
  return !network.surfaces.empty() && !set.set_p.empty() &&
         surface_of(network, set.set_p.front()) != nullptr;
}

}  // namespace cordis::engine
