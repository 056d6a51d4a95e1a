// sim_node/scene/matter/source.cpp
#include "sim_node/scene/matter/source.h"

#include <algorithm>
#include <numeric>

namespace cordis::scene {

using config::Range;
using engine::MatKind;
using engine::Vec3;

std::optional<PointSpec> optional_ball(config::MappingReader& reader, MassOfBall mass,
                                       config::Problems& problems) {
  const config::Value section = reader.optional_mapping("ball");
  if (!section.exists()) return std::nullopt;
  config::MappingReader ball(section, "'ball' of " + reader.what(), problems);
  PointSpec spec;
  if (mass == MassOfBall::kRequired) {
    spec.mass = ball.required_number("mass_kg", Range::positive());
  } else if (mass == MassOfBall::kOptional) {
    spec.mass = ball.optional_number("mass_kg", 1.0, Range::positive());
  }
  spec.radius = ball.required_number("radius_m", {0.0, kFarthest, true});
  ball.finish();
  return spec;
}

std::vector<Vec3> read_places(Source& source) {
  source.reader.describe({.key = "at_m",
                          .kind = config::KeyKind::kVectors,
                          .required = true,
                          .alternatives = {"driven"}});
  if (source.driven_start != nullptr && !source.reader.has("at_m")) {
    source.reader.optional_value("at_m");
    return {*source.driven_start};
  }
  return required_points(source.reader, "at_m", source.space, source.problems);
}

PointSpec read_point_spec(Source& source) {
  config::MappingReader& reader = source.reader;
  const config::Value mass = reader.optional_value("mass_kg");
  const std::optional<PointSpec> ball =
      optional_ball(reader, mass_of_ball(source), source.problems);
  if (!reader.has("ball")) {
    const Range range = source.may_be_massless ? Range::not_negative() : Range::positive();
    if (source.needs_no_mass) return {reader.optional_number("mass_kg", 1.0, range), 0.0};
    return {reader.required_number("mass_kg", range), 0.0};
  }
  if (mass.exists()) {
    reader.error_at("mass_kg", "either 'mass_kg' or 'ball' can be given in " + reader.what());
  }
  return ball.value_or(PointSpec{});
}

void add_mass(GeneratedMatter& matter, const PointSpec& spec, const Vec3& position) {
  matter.mats.push_back({MatKind::kMass, spec.mass, position, Vec3::Zero()});
  matter.radius_m.push_back(spec.radius);
}

void fix(engine::Mat& mat) {
  mat.kind = MatKind::kFixed;
  mat.mass = 0.0;
}

std::vector<std::uint32_t> line_of(std::uint32_t count) {
  std::vector<std::uint32_t> line(count);
  std::iota(line.begin(), line.end(), 0U);
  return line;
}

void join_all(Source& source, GeneratedMatter& matter, const LinkLaw& law,
              const std::vector<Edge>& edges) {
  if (source.is_unjoined) return;
  matter.law = matter.links.count() == 0 ? std::optional(law) : std::nullopt;
  bool possible = true;
  double shortest = kFarthest;
  for (const auto& [a, b] : edges) {
    const Vec3& position_a = matter.mats[a].position;
    const Vec3& position_b = matter.mats[b].position;
    const double radii = matter.radius_m[a] + matter.radius_m[b];
    possible =
        matter.links.join(law, a, b, position_a, position_b, source.space, radii) && possible;
    shortest = std::min(shortest, (position_b - position_a).norm());
  }
  if (possible) return;
  source.reader.error_at(
      "tension_n", "'tension_n' in " + source.reader.what() + " asks for a negative rest length",
      "with this stiffness and these distances it is at most " +
          config::number_text(shortest * law.stiffness) + " N");
}

std::optional<LinkLaw> read_neighbour_law(Source& source) {
  if (!source.needs_no_mass)
    return read_law(source.reader, LawPlace::kMatter, source.liaisons, source.space);
  const std::optional<LinkLaw> written = optional_neighbour_law(source);
  source.is_unjoined = !written && source.reader.ok();
  return source.is_unjoined ? LinkLaw{} : written;
}

std::optional<LinkLaw> optional_neighbour_law(Source& source) {
  const std::vector<std::string> keys = source.reader.present_keys();
  const bool written = std::any_of(keys.begin(), keys.end(), [](const std::string& key) {
    return key == "liaison" || key == "stiffness_n_per_m" || key == "viscosity_n_s_per_m" ||
           key == "rest_m" || key == "tension_n";
  });
  if (written) return read_law(source.reader, LawPlace::kMatter, source.liaisons, source.space);
  for (const char* key :
       {"liaison", "stiffness_n_per_m", "viscosity_n_s_per_m", "rest_m", "tension_n"})
    source.reader.optional_value(key);  // known, for the hints to unknown ones
  return std::nullopt;
}

std::optional<LinkLaw> read_shear_law(config::MappingReader& reader) {
  LinkLaw law;
  law.stiffness = reader.optional_number("shear_stiffness_n_per_m", 0.0, Range::not_negative());
  law.viscosity = reader.optional_number("shear_viscosity_n_s_per_m", 0.0, Range::not_negative());
  if (law.stiffness > 0.0 || law.viscosity > 0.0) return law;
  return std::nullopt;
}

std::vector<LayoutPoint> row_layout(Source& source, std::size_t count) {
  std::vector<LayoutPoint> points;
  if (source.space != 1) return points;
  const Layout layout = read_layout(source.reader);
  for (std::size_t i = 0; i < count; ++i) {
    points.push_back({layout.origin.x + static_cast<double>(i) * layout.spacing, layout.origin.z});
  }
  return points;
}

Vec3 read_place(Source& source, const char* key) {
  if (source.space == 1) return optional_point(source.reader, key, Vec3::Zero(), 1);
  return required_point(source.reader, key, source.space);
}

Plane read_plane(Source& source) {
  Plane plane;
  if (source.space != 3) return plane;
  const std::string word = source.reader.optional_choice("plane", "xy", {"xy", "xz", "yz"});
  if (word == "xz") plane.along = Vec3::UnitZ();
  if (word == "yz") plane = {Vec3::UnitY(), Vec3::UnitZ()};
  return plane;
}

FixedEnds read_ends(config::MappingReader& reader) {
  const std::string ends =
      reader.optional_choice("ends", "free", {"free", "fixed", "first_fixed", "last_fixed"});
  return {ends == "fixed" || ends == "first_fixed", ends == "fixed" || ends == "last_fixed"};
}

}  // namespace cordis::scene
