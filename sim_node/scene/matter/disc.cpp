// sim_node/scene/matter/disc.cpp
#include "sim_node/scene/matter/disc.h"

#include <cmath>
#include <numbers>

#include "sim_node/scene/matter/crystal_matter.h"

namespace cordis::scene {

namespace {

using engine::Vec3;

/// A flat region around the origin.
Region circle(double radius) {
  Region region;
  region.space = 2;
  region.round = true;
  region.lowest = {-radius, -radius, 0.0};
  region.highest = {radius, radius, 0.0};
  return region;
}

constexpr std::uint32_t first_of_ring(std::uint32_t ring) {
  return ring == 0 ? 0 : 1 + 3 * ring * (ring - 1);
}

/// Joins of a ring to itself and to the one within, so that all meshes are triangles.
void join_ring(std::uint32_t ring, std::vector<Edge>& edges) {
  const std::uint32_t first = first_of_ring(ring);
  const std::uint32_t first_within = first_of_ring(ring - 1);
  const std::uint32_t count = 6 * ring;
  const std::uint32_t count_within = ring == 1 ? 1 : 6 * (ring - 1);
  for (std::uint32_t i = 0; i < count; ++i) {
    edges.emplace_back(first + i, first + (i + 1) % count);
    const std::uint32_t sector = i / ring;
    const std::uint32_t along = i % ring;  // 0 at the corner of a sector: it has one MAT within
    const std::uint32_t within = sector * (ring - 1) + along;
    if (along > 0) edges.emplace_back(first + i, first_within + within - 1);
    edges.emplace_back(first + i, first_within + within % count_within);
  }
}

/// One MAT in the centre, and 6 k in ring k; the second neighbours of rings are not joined.
Crystal rings(double spacing, double radius) {
  Crystal crystal;
  crystal.points.push_back(Vec3::Zero());
  const auto count = static_cast<std::uint32_t>(radius / spacing + 1.0e-9);
  for (std::uint32_t ring = 1; ring <= count; ++ring) {
    for (std::uint32_t i = 0; i < 6 * ring; ++i) {
      const double angle = std::numbers::pi * i / (3.0 * ring);
      crystal.points.push_back(ring * spacing * Vec3(std::cos(angle), std::sin(angle), 0.0));
    }
    join_ring(ring, crystal.neighbours);
  }
  return crystal;
}

Crystal read_rings(Source& source, const CrystalKeys& keys, double radius) {
  config::MappingReader& reader = source.reader;
  const double inner = radius - keys.spec.radius;
  if (inner < 0.0) {
    reader.error_at("radius_m", "no ball of " + reader.what() + " fits into it");
    return {};
  }
  const double count = inner / keys.spacing;
  if (3.0 * count * (count + 1.0) < static_cast<double>(kMaxMats))
    return rings(keys.spacing, inner);
  reader.error_at("radius_m",
                  reader.what() + " has more than " + std::to_string(kMaxMats) + " MATs");
  return {};
}

}  // namespace

GeneratedMatter read_disc(Source& source) {
  config::MappingReader& reader = source.reader;
  const Vec3 center = required_point(reader, "center_m", source.space);
  const double radius = reader.required_number("radius_m", {0.0, kFarthest, true});
  const Plane plane = read_plane(source);
  const std::string order =
      reader.optional_choice("structure", "triangular", {"triangular", "rings"});
  const CrystalKeys keys = read_crystal_keys(source);
  if (order == "rings" && keys.shear) {
    reader.error_at(reader.has("shear_stiffness_n_per_m") ? "shear_stiffness_n_per_m"
                                                          : "shear_viscosity_n_s_per_m",
                    "a disc of rings has no second neighbours that could be joined");
  }
  if (!reader.ok()) return {};

  Crystal crystal = order == "rings" ? read_rings(source, keys, radius)
                                     : fill_region(source, *structure_named("triangular"), keys,
                                                   circle(radius), "radius_m");
  for (Vec3& point : crystal.points)
    point = center + point.x() * plane.across + point.y() * plane.along;
  return crystal_matter(source, crystal, keys);
}

}  // namespace cordis::scene
