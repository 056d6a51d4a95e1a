// sim_node/scene/matter/string.cpp
#include "sim_node/scene/matter/string.h"

namespace cordis::scene {

using engine::Vec3;

GeneratedMatter read_string(Source& source) {
  GeneratedMatter matter;
  config::MappingReader& reader = source.reader;
  const long count = reader.required_integer("count", 2, kMaxMats);
  const PointSpec spec = read_point_spec(source);
  const Vec3 from = read_place(source, "from_m");
  const Vec3 to = read_place(source, "to_m");
  const FixedEnds ends = read_ends(reader);
  const std::optional<LinkLaw> law = read_neighbour_law(source);
  matter.layout = row_layout(source, static_cast<std::size_t>(count));
  if (!law || !reader.ok()) return matter;

  std::vector<Edge> edges;
  matter.lines.push_back(line_of(static_cast<std::uint32_t>(count)));
  for (std::uint32_t i = 0; i < count; ++i) {
    const double part = static_cast<double>(i) / static_cast<double>(count - 1);
    add_mass(matter, spec, from + part * (to - from));
    if (i > 0) edges.emplace_back(i - 1, i);
  }
  if (ends.first) fix(matter.mats.front());
  if (ends.last) fix(matter.mats.back());
  join_all(source, matter, *law, edges);
  return matter;
}

}  // namespace cordis::scene
