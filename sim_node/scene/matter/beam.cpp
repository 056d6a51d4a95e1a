// sim_node/scene/matter/beam.cpp
#include "sim_node/scene/matter/beam.h"

namespace cordis::scene {

namespace {

using engine::Vec3;

/// A beam before it is built: stations along its axis, with the same MATs at each.
struct BeamShape {
  Vec3 from = Vec3::Zero();
  Vec3 to = Vec3::Zero();
  std::uint32_t cells = 1;
  std::vector<Vec3> section;            // from the axis [m]: 2 corners in 2-D, 4 in 3-D
  std::vector<Edge> sides;              // of the section
  std::vector<Edge> section_diagonals;  // of the section

  std::uint32_t corners() const { return static_cast<std::uint32_t>(section.size()); }
  std::uint32_t index(std::uint32_t station, std::uint32_t corner) const {
    return station * corners() + corner;
  }
};

/// The direction of the height of a beam in 3-D: `up` made square to the axis, z unless written, or
/// y for a beam along z. Zero after a problem.
Vec3 read_up(Source& source, const Vec3& axis) {
  constexpr double kSmallestSine = 1.0e-6;
  const auto square_to_axis = [&](const Vec3& up) -> Vec3 { return up - up.dot(axis) * axis; };
  config::MappingReader& reader = source.reader;
  const config::Value value = reader.optional_value("up");
  const std::string what = "'up' in " + reader.what();
  Vec3 up = square_to_axis(Vec3::UnitZ());
  if (!value.exists()) {
    if (up.norm() < kSmallestSine) up = square_to_axis(Vec3::UnitY());
    return up.normalized();
  }
  const std::vector<Vec3> directions = read_directions(value, what, 3, source.problems);
  if (directions.size() == 1) up = square_to_axis(directions[0]);
  if (directions.size() == 1 && up.norm() >= kSmallestSine) return up.normalized();
  if (!directions.empty())
    reader.error_at("up", what + " must be one direction that is not along the beam");
  return Vec3::Zero();
}

BeamShape read_shape(Source& source) {
  BeamShape shape;
  config::MappingReader& reader = source.reader;
  shape.from = required_point(reader, "from_m", source.space);
  shape.to = required_point(reader, "to_m", source.space);
  const long most = kMaxMats / (source.space == 2 ? 2 : 4) - 1;
  shape.cells = static_cast<std::uint32_t>(reader.required_integer("cells", 1, most));
  const double height = reader.required_number("height_m", {0.0, kFarthest, true});
  const double length = (shape.to - shape.from).norm();
  if (reader.ok() && length == 0.0)
    reader.error_at("to_m", "the ends of " + reader.what() + " are one point");
  const Vec3 axis = length > 0.0 ? Vec3((shape.to - shape.from) / length) : Vec3::UnitX();
  if (source.space == 2) {
    const Vec3 up(-axis.y(), axis.x(), 0.0);
    shape.section = {-0.5 * height * up, 0.5 * height * up};
    shape.sides = {{0, 1}};
    return shape;
  }
  const double width = reader.optional_number("width_m", height, {0.0, kFarthest, true});
  const Vec3 up = read_up(source, axis);
  const Vec3 h = 0.5 * height * up;
  const Vec3 w = 0.5 * width * cross(axis, up);
  shape.section = {-h - w, -h + w, h + w, h - w};
  shape.sides = {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
  shape.section_diagonals = {{0, 2}, {1, 3}};
  return shape;
}

/// The links of a section at every station, then those of every cell: along it, and crosswise in
/// each of its faces.
std::vector<Edge> joints_of(const BeamShape& shape) {
  std::vector<Edge> edges;
  for (std::uint32_t s = 0; s <= shape.cells; ++s) {
    for (const auto& all : {shape.sides, shape.section_diagonals}) {
      for (const auto& [a, b] : all) edges.emplace_back(shape.index(s, a), shape.index(s, b));
    }
  }
  for (std::uint32_t s = 0; s < shape.cells; ++s) {
    for (std::uint32_t c = 0; c < shape.corners(); ++c)
      edges.emplace_back(shape.index(s, c), shape.index(s + 1, c));
    for (const auto& [a, b] : shape.sides) {
      edges.emplace_back(shape.index(s, a), shape.index(s + 1, b));
      edges.emplace_back(shape.index(s, b), shape.index(s + 1, a));
    }
  }
  return edges;
}

}  // namespace

GeneratedMatter read_beam(Source& source) {
  GeneratedMatter matter;
  config::MappingReader& reader = source.reader;
  const std::size_t errors_before = source.problems.error_count();
  const BeamShape shape = read_shape(source);
  const PointSpec spec = read_point_spec(source);
  const FixedEnds ends = read_ends(reader);
  const std::optional<LinkLaw> law = read_neighbour_law(source);
  if (!law || source.problems.error_count() != errors_before) return matter;

  for (std::uint32_t s = 0; s <= shape.cells; ++s) {
    const Vec3 station =
        shape.from + (static_cast<double>(s) / shape.cells) * (shape.to - shape.from);
    for (const Vec3& corner : shape.section) {
      add_mass(matter, spec, station + corner);
      if ((s == 0 && ends.first) || (s == shape.cells && ends.last)) fix(matter.mats.back());
    }
  }
  join_all(source, matter, *law, joints_of(shape));
  return matter;
}

}  // namespace cordis::scene
