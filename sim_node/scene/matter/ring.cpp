// sim_node/scene/matter/ring.cpp
#include "sim_node/scene/matter/ring.h"

#include <cmath>
#include <numbers>

namespace cordis::scene {

using engine::Vec3;

GeneratedMatter read_ring(Source& source) {
  GeneratedMatter matter;
  config::MappingReader& reader = source.reader;
  const long count = reader.required_integer("count", 3, kMaxMats);
  const PointSpec spec = read_point_spec(source);
  const bool flat = source.space == 1;  // all at one displacement; the circle is only the layout
  const Vec3 center = flat ? optional_point(reader, "at_m", Vec3::Zero(), 1)
                           : required_point(reader, "center_m", source.space);
  const double radius = flat ? 0.0 : reader.required_number("radius_m", {0.0, kFarthest, true});
  const Plane plane = read_plane(source);
  const std::optional<LinkLaw> law = read_neighbour_law(source);
  const Layout layout = flat ? read_layout(reader) : Layout{};
  if (!law || !reader.ok()) return matter;

  const double layout_radius =
      static_cast<double>(count) * layout.spacing / (2.0 * std::numbers::pi);
  std::vector<Edge> edges;
  matter.lines.push_back(line_of(static_cast<std::uint32_t>(count)));
  for (const std::uint32_t again : {0U, 1U}) matter.lines.back().push_back(again);
  for (std::uint32_t i = 0; i < count; ++i) {
    const double angle =
        2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(count);
    const double x = std::cos(angle);
    const double y = std::sin(angle);
    add_mass(matter, spec, flat ? center : center + radius * (x * plane.across + y * plane.along));
    if (flat)
      matter.layout.push_back(
          {layout.origin.x + layout_radius * x, layout.origin.z + layout_radius * y});
    edges.emplace_back(i, static_cast<std::uint32_t>((i + 1) % count));
  }
  join_all(source, matter, *law, edges);
  return matter;
}

}  // namespace cordis::scene
