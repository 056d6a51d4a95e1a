// sim_node/scene/matter/skin.cpp
#include "sim_node/scene/matter/skin.h"

#include <cmath>
#include <numbers>

#include "sim_node/scene/matter/icosphere.h"

namespace cordis::scene {

namespace {

using engine::Vec3;

/// The points of a closed surface and how they lie to each other.
struct ClosedSurface {
  std::vector<Vec3> points;
  std::vector<Edge> edges;
  std::vector<Edge> across;  // second neighbours
};

ClosedSurface closed_line(std::vector<Vec3> points) {
  ClosedSurface surface{std::move(points), {}, {}};
  const auto count = static_cast<std::uint32_t>(surface.points.size());
  for (std::uint32_t i = 0; i < count; ++i) {
    surface.edges.emplace_back(i, (i + 1) % count);
    if (count > 4 || (count == 4 && i < 2)) surface.across.emplace_back(i, (i + 2) % count);
  }
  return surface;
}

ClosedSurface read_circle(Source& source) {
  config::MappingReader& reader = source.reader;
  const Vec3 center = required_point(reader, "center_m", 2);
  const double radius = reader.required_number("radius_m", {0.0, kFarthest, true});
  const long count = reader.required_integer("count", 3, kMaxMats - 1);
  std::vector<Vec3> points;
  for (long i = 0; i < count && reader.ok(); ++i) {
    const double angle =
        2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(count);
    points.push_back(center + radius * Vec3(std::cos(angle), std::sin(angle), 0.0));
  }
  return closed_line(std::move(points));
}

/// Every side of a polygon in equal pieces of about the spacing.
ClosedSurface read_polygon(Source& source) {
  config::MappingReader& reader = source.reader;
  const std::vector<Vec3> corners = required_points(reader, "corners_m", 2, source.problems);
  const double spacing = reader.required_number("spacing_m", {0.0, kFarthest, true});
  if (reader.ok() && corners.size() < 3) {
    reader.error_at("corners_m", "'corners_m' in " + reader.what() +
                                     " must be at least 3 points, got " +
                                     std::to_string(corners.size()));
  }
  if (!reader.ok()) return {};
  std::vector<Vec3> points;
  for (std::size_t c = 0; c < corners.size(); ++c) {
    const Vec3 side = corners[(c + 1) % corners.size()] - corners[c];
    const double pieces = std::max(1.0, std::round(side.norm() / spacing));
    if (static_cast<double>(points.size()) + pieces >= static_cast<double>(kMaxMats)) {
      reader.error_at("spacing_m",
                      reader.what() + " has more than " + std::to_string(kMaxMats) + " MATs");
      return {};
    }
    for (double i = 0.0; i < pieces; i += 1.0) points.push_back(corners[c] + (i / pieces) * side);
  }
  return closed_line(std::move(points));
}

ClosedSurface read_sphere(Source& source) {
  config::MappingReader& reader = source.reader;
  constexpr long kMaxSubdivisions = 8;  // 655,362 MATs
  const Vec3 center = required_point(reader, "center_m", 3);
  const double radius = reader.required_number("radius_m", {0.0, kFarthest, true});
  const long subdivisions = reader.required_integer("subdivisions", 0, kMaxSubdivisions);
  if (!reader.ok()) return {};
  Icosphere sphere = icosphere(static_cast<int>(subdivisions));
  for (Vec3& point : sphere.points) point = center + radius * point;
  return {std::move(sphere.points), std::move(sphere.edges), std::move(sphere.across)};
}

ClosedSurface read_surface(Source& source) {
  if (source.space == 3) return read_sphere(source);
  return source.reader.has("corners_m") ? read_polygon(source) : read_circle(source);
}

/// One MAT in the middle, the last of the matter, joined to all of the skin.
void add_core(Source& source, GeneratedMatter& matter, const config::Value& section) {
  config::MappingReader reader(section, "'core' of " + source.reader.what(), source.problems);
  Source inner{reader, source.liaisons, source.space, false, source.problems};
  inner.needs_no_mass = source.needs_no_mass;
  const PointSpec spec = read_point_spec(inner);
  const std::optional<LinkLaw> law = read_neighbour_law(inner);
  reader.finish();
  if (!law || !reader.ok() || matter.mats.empty()) return;

  const auto count = static_cast<std::uint32_t>(matter.mats.size());
  Vec3 sum = Vec3::Zero();
  std::vector<Edge> spokes;
  for (std::uint32_t i = 0; i < count; ++i) {
    sum += matter.mats[i].position;
    spokes.emplace_back(count, i);
  }
  add_mass(matter, spec, sum / static_cast<double>(count));
  join_all(inner, matter, *law, spokes);
  matter.names = {{"skin", 0, count}, {"core", count, 1}};
}

}  // namespace

GeneratedMatter read_skin(Source& source) {
  config::MappingReader& reader = source.reader;
  const ClosedSurface surface = read_surface(source);
  const PointSpec spec = read_point_spec(source);
  const std::optional<LinkLaw> law = read_neighbour_law(source);
  const std::optional<LinkLaw> shear = read_shear_law(reader);
  const config::Value core = reader.optional_mapping("core");

  GeneratedMatter matter;
  if (law && reader.ok()) {
    for (const Vec3& point : surface.points) add_mass(matter, spec, point);
    join_all(source, matter, *law, surface.edges);
    if (shear) join_all(source, matter, *shear, surface.across);
  }
  if (core.exists()) add_core(source, matter, core);
  return matter;
}

}  // namespace cordis::scene
