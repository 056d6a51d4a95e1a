// sim_node/scene/matter/points.cpp
#include "sim_node/scene/matter/points.h"

namespace cordis::scene {

using engine::MatKind;
using engine::Vec3;

namespace {

/// One value for all, or one for each.
template <class Item>
void spread(Source& source, const char* key, std::size_t count, std::vector<Item>& values) {
  if (values.size() == 1) values.resize(count, values.front());
  if (values.size() == count) return;
  source.reader.error_at(key, std::string("'") + key + "' in " + source.reader.what() +
                                  " must be one for all or one for each of the " +
                                  std::to_string(count) + ", got " + std::to_string(values.size()));
  values.resize(count, values.front());
}

/// True if `fixed` is a truth and no list.
bool is_truth(const config::Value& value) {
  return !value.quoted() && (value.text() == "true" || value.text() == "false");
}

/// `fixed`: numbers of the MATs that never move, or true.
std::vector<bool> read_fixed_ones(config::MappingReader& reader, std::size_t count) {
  const config::Value written = reader.optional_value("fixed");
  if (is_truth(written)) return std::vector<bool>(count, reader.optional_truth("fixed", false));
  std::vector<bool> fixed(count);
  const bool any = written.exists();
  const auto last = static_cast<long>(count) - 1;
  for (const long index : any ? reader.required_integers("fixed", 0, last) : std::vector<long>{}) {
    fixed[static_cast<std::size_t>(index)] = true;
  }
  return fixed;
}

/// Where the MATs of a 1-D scene are shown unless they say it.
std::vector<Vec3> in_a_row(std::size_t count) {
  std::vector<Vec3> row;
  for (std::size_t i = 0; i < count; ++i) {
    row.emplace_back(Layout{}.spacing * static_cast<double>(i), 0.0, 0.0);
  }
  return row;
}

/// Checks that masses and radii are possible.
void check_points(Source& source, const GeneratedMatter& matter) {
  config::MappingReader& reader = source.reader;
  for (const engine::Mat& mat : matter.mats) {
    const bool is_possible = mat.mass > 0.0 || (mat.mass == 0.0 && source.may_be_massless);
    if (mat.kind == MatKind::kFixed || is_possible) continue;
    reader.error_at("mass_kg", "'mass_kg' in " + reader.what() + " must be > 0, got " +
                                   config::number_text(mat.mass));
  }
  for (const double radius : matter.radius_m) {
    if (radius >= 0.0 && radius <= kFarthest) continue;
    reader.error_at("radius_m", "'radius_m' in " + reader.what() + " must be >= 0, got " +
                                    config::number_text(radius));
  }
}

}  // namespace

GeneratedMatter read_points(Source& source) {
  GeneratedMatter matter;
  config::MappingReader& reader = source.reader;
  const std::vector<Vec3> points = required_points(reader, "at_m", source.space, source.problems);
  const std::size_t count = points.size();
  const config::Value all_fixed = reader.optional_value("fixed");
  const bool is_fixed = is_truth(all_fixed) && reader.optional_truth("fixed", false);
  std::vector<double> mass = is_fixed || source.needs_no_mass
                                 ? reader.optional_numbers("mass_kg", {1.0})
                                 : reader.required_numbers("mass_kg");
  if (!reader.has("mass_kg")) mass = {1.0};  // also after the problem that it is missing
  std::vector<double> radius = reader.optional_numbers("radius_m", {0.0});
  spread(source, "mass_kg", count, mass);
  spread(source, "radius_m", count, radius);
  const std::vector<bool> fixed = read_fixed_ones(reader, count);
  for (std::size_t i = 0; i < count; ++i) {
    matter.mats.push_back({MatKind::kMass, mass[i], points[i], Vec3::Zero()});
    if (fixed[i]) matter.mats.back() = {MatKind::kFixed, 0.0, points[i], Vec3::Zero()};
  }
  matter.lines.push_back(line_of(static_cast<std::uint32_t>(count)));
  matter.radius_m = radius;
  check_points(source, matter);
  if (source.space > 1) return matter;
  reader.describe({.key = "layout_at_m", .kind = config::KeyKind::kVectors});
  const bool has_layout = reader.optional_value("layout_at_m").exists();
  std::vector<Vec3> layout =
      has_layout ? required_points(reader, "layout_at_m", 2, source.problems) : in_a_row(count);
  spread(source, "layout_at_m", count, layout);
  for (const Vec3& point : layout) matter.layout.push_back({point.x(), point.y()});
  return matter;
}

}  // namespace cordis::scene
