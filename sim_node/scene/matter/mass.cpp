// sim_node/scene/matter/mass.cpp
#include "sim_node/scene/matter/mass.h"

namespace cordis::scene {

using engine::MatKind;
using engine::Vec3;

GeneratedMatter read_mass(Source& source) {
  GeneratedMatter matter;
  const std::vector<Vec3> points = read_places(source);
  const PointSpec spec = read_point_spec(source);
  for (const Vec3& point : points) add_mass(matter, spec, point);
  matter.layout = row_layout(source, points.size());
  return matter;
}

GeneratedMatter read_fixed(Source& source) {
  GeneratedMatter matter;
  const std::vector<Vec3> points = read_places(source);
  const std::optional<PointSpec> ball =
      optional_ball(source.reader, MassOfBall::kNone, source.problems);
  for (const Vec3& point : points) {
    matter.mats.push_back({MatKind::kFixed, 0.0, point, Vec3::Zero()});
    matter.radius_m.push_back(ball.value_or(PointSpec{}).radius);
  }
  matter.layout = row_layout(source, matter.mats.size());
  return matter;
}

}  // namespace cordis::scene
