// sim_node/scene/matter/ball.cpp -- a ball: a solid sphere of MATs in the order of a crystal.
#include "sim_node/scene/matter/crystal_piece.h"
#include "sim_node/scene/matter/generators.h"

namespace cordis::scene {

Piece read_ball(Source& source) {
  config::MappingReader& reader = source.reader;
  const engine::Vec3 center = required_point(reader, "center_m", source.space);
  const double radius = reader.required_number("radius_m", {0.0, kFarthest, true});
  const Structure* structure = read_structure(source, {"cubic", "fcc"}, "fcc");
  const CrystalKeys keys = read_crystal_keys(source);
  if (!reader.ok() || structure == nullptr) return {};

  Region region;
  region.round = true;
  region.lowest = center.array() - radius;
  region.highest = center.array() + radius;
  return crystal_piece(source, fill_region(source, *structure, keys, region, "radius_m"), keys);
}

}  // namespace cordis::scene
