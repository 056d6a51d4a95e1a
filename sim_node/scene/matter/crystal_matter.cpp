// sim_node/scene/matter/crystal_matter.cpp
#include "sim_node/scene/matter/crystal_matter.h"

namespace cordis::scene {

CrystalKeys read_crystal_keys(Source& source) {
  CrystalKeys keys;
  const config::Range range{0.0, kFarthest, true};
  keys.spec = read_point_spec(source);
  keys.spacing = keys.spec.radius > 0.0
                     ? source.reader.optional_number("spacing_m", 2.0 * keys.spec.radius, range)
                     : source.reader.required_number("spacing_m", range);
  keys.law = optional_neighbour_law(source);
  keys.shear = read_shear_law(source.reader);
  return keys;
}

const Structure* read_structure(Source& source, const std::vector<std::string>& words,
                                const std::string& fallback) {
  config::MappingReader& reader = source.reader;
  const std::size_t errors_before = source.problems.error_count();
  const std::string word = fallback.empty() ? reader.required_choice("structure", words)
                                            : reader.optional_choice("structure", fallback, words);
  const Structure* structure = structure_named(word);
  if (source.problems.error_count() != errors_before || structure == nullptr) return nullptr;
  if (structure->space == source.space || !fallback.empty()) return structure;
  reader.error_at("structure", "a " + word + " lattice needs a scene of space " +
                                   std::to_string(structure->space) + ", this one has " +
                                   std::to_string(source.space));
  return nullptr;
}

Crystal fill_region(Source& source, const Structure& structure, const CrystalKeys& keys,
                    const Region& region, const std::string& key) {
  config::MappingReader& reader = source.reader;
  const Region room = region.without_margin(keys.spec.radius);
  std::optional<Crystal> crystal;
  if (room.is_possible()) crystal = crystal_in(structure, keys.spacing, room);
  if (room.is_possible() && (!crystal || crystal->points.size() > kMaxMats)) {
    reader.error_at(key, reader.what() + " has more than " + std::to_string(kMaxMats) + " MATs");
  } else if (!crystal || crystal->points.empty()) {
    reader.error_at(key, "no ball of " + reader.what() + " fits into it");
  }
  return crystal.value_or(Crystal{});
}

GeneratedMatter crystal_matter(Source& source, const Crystal& crystal, const CrystalKeys& keys) {
  GeneratedMatter matter;
  for (const engine::Vec3& point : crystal.points) add_mass(matter, keys.spec, point);
  if (keys.law) join_all(source, matter, *keys.law, crystal.neighbours);
  if (keys.shear) join_all(source, matter, *keys.shear, crystal.second_neighbours);
  return matter;
}

}  // namespace cordis::scene
