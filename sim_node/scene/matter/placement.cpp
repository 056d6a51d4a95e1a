// sim_node/scene/matter/placement.cpp
#include "sim_node/scene/matter/placement.h"

#include <cmath>
#include <numbers>

#include "sim_node/scene/language/point.h"

namespace cordis::scene {

namespace {

using engine::Vec3;

/// Cosine and sine of an angle [degrees]; without rounding for a quarter turn.
std::pair<double, double> cosine_and_sine(double degrees) {
  const double rest = std::fmod(degrees, 360.0);
  const double quarters = rest / 90.0;
  if (quarters == std::round(quarters)) {
    const int quarter = (static_cast<int>(quarters) + 4) % 4;
    return {quarter == 0   ? 1.0
            : quarter == 2 ? -1.0
                           : 0.0,
            quarter == 1   ? 1.0
            : quarter == 3 ? -1.0
                           : 0.0};
  }
  const double angle = rest * std::numbers::pi / 180.0;
  return {std::cos(angle), std::sin(angle)};
}

/// Rodrigues' formula; the axis is of unit length.
Eigen::Matrix3d turn_about(const Vec3& axis, double degrees) {
  const auto [cosine, sine] = cosine_and_sine(degrees);
  Eigen::Matrix3d cross;
  cross << 0.0, -axis.z(), axis.y(), axis.z(), 0.0, -axis.x(), -axis.y(), axis.x(), 0.0;
  return cosine * Eigen::Matrix3d::Identity() + sine * cross +
         (1.0 - cosine) * axis * axis.transpose();
}

const config::Range kAngle = config::Range::between(-1.0e6, 1.0e6);

Eigen::Matrix3d read_turn_3d(config::MappingReader& outer, config::Problems& problems) {
  const config::Value section = outer.optional_mapping("rotate");
  config::MappingReader reader(section, "'rotate' of " + outer.what(), problems);
  const config::Value value = reader.required_value("axis");
  const double degrees = reader.required_number("deg", kAngle);
  reader.finish();
  if (!value.exists()) return Eigen::Matrix3d::Identity();
  const std::string what = "'axis' in " + reader.what();
  const std::vector<Vec3> axes = read_directions(value, what, 3, problems);
  if (axes.size() == 1) return turn_about(axes[0], degrees);
  if (!axes.empty()) problems.error(value.place(), what + " must be one direction");
  return Eigen::Matrix3d::Identity();
}

}  // namespace

Placement Placement::operator*(const Placement& inner) const {
  return {turn * inner.turn,
          (*this)(inner.shift),
          {layout_shift.x + inner.layout_shift.x, layout_shift.z + inner.layout_shift.z}};
}

Placement read_placement(config::MappingReader& reader, int space, config::Problems& problems) {
  Placement placement;
  placement.shift = optional_point(reader, "translate_m", Vec3::Zero(), space);
  if (space == 1) {
    const std::vector<double> shift = reader.optional_numbers("layout_translate_m", {0.0, 0.0}, 2);
    placement.layout_shift = {shift[0], shift[1]};
  }
  if (space == 2)
    placement.turn = turn_about(Vec3::UnitZ(), reader.optional_number("rotate_deg", 0.0, kAngle));
  if (space == 3) placement.turn = read_turn_3d(reader, problems);
  return placement;
}

}  // namespace cordis::scene
