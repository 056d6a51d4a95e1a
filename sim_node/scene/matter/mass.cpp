// sim_node/scene/matter/mass.cpp -- single masses and fixed points.
#include "sim_node/scene/matter/generators.h"

namespace cordis::scene {

using engine::MatKind;
using engine::Vec3;

Piece read_mass(Source& source) {
  Piece piece;
  const std::vector<Vec3> points =
      required_points(source.reader, "at_m", source.space, source.problems);
  const PointSpec grain = read_grain(source);
  const Vec3 velocity =
      optional_point(source.reader, "velocity_m_per_s", Vec3::Zero(), source.space);
  for (const Vec3& point : points) {
    add_mass(piece, grain, point);
    piece.mats.back().velocity = velocity;
  }
  piece.layout = row_layout(source, points.size());
  return piece;
}

Piece read_fixed(Source& source) {
  Piece piece;
  const std::vector<Vec3> points =
      required_points(source.reader, "at_m", source.space, source.problems);
  const std::optional<PointSpec> ball = optional_ball(source.reader, false, source.problems);
  for (const Vec3& point : points) {
    piece.mats.push_back({MatKind::kFixed, 0.0, point, Vec3::Zero()});
    piece.radius_m.push_back(ball.value_or(PointSpec{}).radius);
  }
  piece.layout = row_layout(source, piece.mats.size());
  return piece;
}

}  // namespace cordis::scene
