// sim_node/scene/matter/pack.cpp
#include "sim_node/scene/matter/pack.h"

#include <cmath>
#include <numbers>

#include "sim_node/scene/matter/packing.h"

namespace cordis::scene {

namespace {

/// Area of a disc or volume of a ball.
double measure_of_ball(double radius, int space) {
  constexpr double kPi = std::numbers::pi;
  return space == 2 ? kPi * radius * radius : 4.0 / 3.0 * kPi * radius * radius * radius;
}

/// `count`, or `fill` of the region. 0 after a problem.
std::size_t read_count(Source& source, const Region& region, double ball) {
  config::MappingReader& reader = source.reader;
  if (!reader.optional_value("fill").exists()) {
    if (reader.has("count"))
      return static_cast<std::size_t>(reader.required_integer("count", 1, kMaxMats));
    reader.error_at("count", "missing key 'count' in " + reader.what(), "give 'count' or 'fill'");
    return 0;
  }
  const double fill = reader.required_number("fill", {0.0, 1.0, true});
  if (reader.optional_value("count").exists())
    reader.error_at("count", "either 'count' or 'fill' can be given in " + reader.what());
  if (!reader.ok()) return 0;
  const double count = std::round(fill * region.measure() / ball);
  if (count >= 1.0 && count <= static_cast<double>(kMaxMats))
    return static_cast<std::size_t>(count);
  reader.error_at("fill", "'fill' in " + reader.what() + " asks for " + config::number_text(count) +
                              " balls, which must be between 1 and " + std::to_string(kMaxMats));
  return 0;
}

/// The largest part of a region that can be filled. No packing at all is denser than the triangular
/// lattice, or than fcc; many balls without order never come near them.
double densest(int space, std::size_t count) {
  constexpr std::size_t kMany = 1000;
  if (count < kMany) return space == 2 ? 0.9069 : 0.7405;
  return space == 2 ? 0.86 : 0.65;
}

/// @param rounds of pushing apart that did not help; 0 where it is known without
void report_no_room(Source& source, const Region& region, double ball, std::size_t count,
                    int rounds) {
  const bool flat = source.space == 2;
  const double share = static_cast<double>(count) * ball / region.measure();
  const double percent = std::round(100.0 * share);
  source.reader.error_at(
      "region",
      std::to_string(count) + (count == 1 ? " ball of " : " balls of ") + source.reader.what() +
          (rounds > 0
               ? " still overlap after " + std::to_string(rounds) + " rounds of pushing them apart"
               : std::string(count == 1 ? " does" : " do") + " not fit into the region"),
      "they are " + config::number_text(percent) + " % of it; without order, at most about " +
          (flat ? "84 % of an area" : "64 % of a volume") + " can be filled, less at its border");
}

}  // namespace

GeneratedMatter read_pack(Source& source) {
  GeneratedMatter matter;
  config::MappingReader& reader = source.reader;
  const std::size_t errors_before = source.problems.error_count();
  if (!reader.has("ball")) reader.required_value("ball");
  const std::optional<PointSpec> ball =
      optional_ball(reader, mass_of_ball(source), source.problems);
  const Region region = read_region(reader.required_mapping("region"), source);
  const long seed = reader.optional_integer("seed", 1, 0, 1'000'000'000);
  const bool sound = ball && source.problems.error_count() == errors_before;
  const double measure = measure_of_ball(sound ? ball->radius : 1.0, source.space);
  const std::size_t count = read_count(source, region, measure);
  if (!sound || !reader.ok()) return matter;

  PackedBalls packed;
  if (static_cast<double>(count) * measure <= densest(source.space, count) * region.measure()) {
    packed = pack_balls(region, ball->radius, count, static_cast<std::uint64_t>(seed));
  }
  if (!packed.centers) {
    report_no_room(source, region, measure, count, packed.rounds);
    return matter;
  }
  for (const engine::Vec3& center : *packed.centers) add_mass(matter, *ball, center);
  return matter;
}

}  // namespace cordis::scene
