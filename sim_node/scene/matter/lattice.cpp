// A lattice: MATs in the order of a crystal.
#include "sim_node/scene/matter/crystal.h"
#include "sim_node/scene/matter/generators.h"

namespace cordis::scene {

namespace {

using engine::Vec3;

/// nullptr after a problem.
const Structure* read_structure(Source& source) {
  const std::vector<std::string> words{"square", "triangular", "cubic", "fcc"};
  const bool sound_before = source.reader.ok();
  const std::string word = source.reader.required_choice("structure", words);
  if (sound_before && !source.reader.ok()) return nullptr;
  const Structure* structure = structure_named(word);
  if (structure->space == source.space) return structure;
  source.reader.error_at("structure", "a " + word + " lattice needs a scene of space " +
                                          std::to_string(structure->space) + ", this one has " +
                                          std::to_string(source.space));
  return nullptr;
}

void report_size(Source& source, const std::string& key) {
  source.reader.error_at(
      key, source.reader.what() + " has more than " + std::to_string(kMostMats) + " MATs");
}

Crystal read_block(Source& source, const Structure* structure, double spacing) {
  config::MappingReader& reader = source.reader;
  const Vec3 corner = required_point(reader, "corner_m", source.space);
  const std::vector<long> numbers = reader.required_integers("counts", 1, kMostMats);
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
  if (total > static_cast<double>(kMostMats)) {
    report_size(source, "counts");
    return {};
  }
  return crystal_block(*structure, spacing, corner, counts);
}

Crystal read_filled_region(Source& source, const Structure* structure, double spacing,
                           double ball_radius) {
  config::MappingReader& reader = source.reader;
  const std::size_t errors_before = source.problems.error_count();
  const Region region = read_region(reader.required_mapping("region"), source);
  for (const char* key : {"counts", "corner_m"}) {
    if (reader.optional_value(key).exists())
      reader.error_at(
          key, "either 'region' or '" + std::string(key) + "' can be given in " + reader.what());
  }
  if (!reader.ok() || structure == nullptr || source.problems.error_count() != errors_before)
    return {};
  const Region room = region.without_margin(ball_radius);
  std::optional<Crystal> crystal;
  if (room.is_possible()) crystal = crystal_in(*structure, spacing, room);
  if (room.is_possible() && (!crystal || crystal->points.size() > kMostMats)) {
    report_size(source, "region");
  } else if (!crystal || crystal->points.empty()) {
    reader.error_at("region", "no ball of " + reader.what() + " fits into the region");
  }
  return crystal.value_or(Crystal{});
}

}  // namespace

Piece read_lattice(Source& source) {
  config::MappingReader& reader = source.reader;
  const Structure* structure = read_structure(source);
  const Grain grain = read_grain(source);
  const config::Range range{0.0, kFarthest, true};
  const double spacing = grain.radius > 0.0
                             ? reader.optional_number("spacing_m", 2.0 * grain.radius, range)
                             : reader.required_number("spacing_m", range);
  const Crystal crystal = reader.optional_value("region").exists()
                              ? read_filled_region(source, structure, spacing, grain.radius)
                              : read_block(source, structure, spacing);
  const std::optional<LinkLaw> law = optional_neighbour_law(source);
  const std::optional<LinkLaw> shear = read_shear_law(reader);

  Piece piece;
  if (!reader.ok() || structure == nullptr) return piece;
  for (const Vec3& point : crystal.points) add_mass(piece, grain, point);
  if (law) join_all(source, piece, *law, crystal.neighbours);
  if (shear) join_all(source, piece, *shear, crystal.second_neighbours);
  return piece;
}

}  // namespace cordis::scene
