// sim_node/scene/matter/ball.cpp
#include "sim_node/scene/matter/ball.h"

#include "sim_node/scene/matter/crystal_matter.h"

namespace cordis::scene {

GeneratedMatter read_ball(Source& source) {
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
  return crystal_matter(source, fill_region(source, *structure, keys, region, "radius_m"), keys);
}

}  // namespace cordis::scene
