// sim_node/scene/matter/lattice.cpp
#include "sim_node/scene/matter/lattice.h"

#include "sim_node/scene/matter/crystal_matter.h"

namespace cordis::scene {

namespace {

using engine::Vec3;

/// `corner_m` and `counts`.
Crystal read_block(Source& source, const Structure* structure, double spacing) {
  config::MappingReader& reader = source.reader;
  const Vec3 corner = required_point(reader, "corner_m", source.space);
  const std::vector<long> numbers = reader.required_integers("counts", 1, kMaxMats);
  const auto space = static_cast<std::size_t>(source.space);
  if (reader.has("counts") && reader.ok() && numbers.size() != space) {
    reader.error_at("counts", "'counts' in " + reader.what() + " must have " +
                                  std::to_string(space) + " numbers, got " +
                                  std::to_string(numbers.size()));
  }
  if (!reader.ok() || structure == nullptr) return {};
  std::array<long, 3> counts{1, 1, 1};
  double total = 1.0;
  for (std::size_t axis = 0; axis < space; ++axis) {
    counts[axis] = numbers[axis];
    total *= static_cast<double>(numbers[axis]);
  }
  if (total <= static_cast<double>(kMaxMats))
    return crystal_block(*structure, spacing, corner, counts);
  reader.error_at("counts", reader.what() + " has more than " + std::to_string(kMaxMats) + " MATs");
  return {};
}

Crystal read_filled_region(Source& source, const Structure* structure, const CrystalKeys& keys) {
  config::MappingReader& reader = source.reader;
  const std::size_t errors_before = source.problems.error_count();
  const Region region = read_region(reader.required_mapping("region"), source);
  for (const std::string key : {"counts", "corner_m"}) {
    if (reader.optional_value(key).exists())
      reader.error_at(key, "either 'region' or '" + key + "' can be given in " + reader.what());
  }
  if (!reader.ok() || structure == nullptr || source.problems.error_count() != errors_before)
    return {};
  return fill_region(source, *structure, keys, region, "region");
}

}  // namespace

GeneratedMatter read_lattice(Source& source) {
  config::MappingReader& reader = source.reader;
  const Structure* structure = read_structure(source, {"square", "triangular", "cubic", "fcc"}, "");
  const CrystalKeys keys = read_crystal_keys(source);
  const Crystal crystal = reader.optional_value("region").exists()
                              ? read_filled_region(source, structure, keys)
                              : read_block(source, structure, keys.spacing);
  if (!reader.ok() || structure == nullptr) return {};
  return crystal_matter(source, crystal, keys);
}

}  // namespace cordis::scene
