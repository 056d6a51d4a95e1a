// sim_node/scene/matter/string.cpp -- a string: MATs in a row, each joined to the next.
#include "sim_node/scene/matter/generators.h"

namespace cordis::scene {

using engine::Vec3;

Piece read_string(Source& source) {
  Piece piece;
  config::MappingReader& reader = source.reader;
  const long count = reader.required_integer("count", 2, kMaxMats);
  const PointSpec grain = read_grain(source);
  const Vec3 from = read_place(source, "from_m");
  const Vec3 to = read_place(source, "to_m");
  const FixedEnds ends = read_ends(reader);
  const std::optional<LinkLaw> law = read_neighbour_law(source);
  piece.layout = row_layout(source, static_cast<std::size_t>(count));
  if (!law || !reader.ok()) return piece;

  std::vector<Edge> joints;
  for (std::uint32_t i = 0; i < count; ++i) {
    const double part = static_cast<double>(i) / static_cast<double>(count - 1);
    add_mass(piece, grain, from + part * (to - from));
    if (i > 0) joints.emplace_back(i - 1, i);
  }
  if (ends.first) fix(piece.mats.front());
  if (ends.last) fix(piece.mats.back());
  join_all(source, piece, *law, joints);
  return piece;
}

}  // namespace cordis::scene
