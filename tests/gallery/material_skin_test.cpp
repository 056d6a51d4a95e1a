// tests/gallery/material_skin_test.cpp
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/gallery/gallery_session.h"

namespace cordis::test {
namespace {

std::vector<engine::Vec3> outline(const GallerySession& session) {
  const scene::NamedRange bag = session.mats("bag");
  std::vector<engine::Vec3> points;
  for (std::uint32_t i = 0; i < bag.count; ++i) points.push_back(session.position("bag", i));
  return points;
}

double area(const std::vector<engine::Vec3>& polygon) {
  double twice = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const engine::Vec3& a = polygon[i];
    const engine::Vec3& b = polygon[(i + 1) % polygon.size()];
    twice += a.x() * b.y() - b.x() * a.y();
  }
  return 0.5 * twice;
}

/// Width over height at half height: 1 for a circle.
double waist(const std::vector<engine::Vec3>& polygon) {
  engine::Vec3 low = polygon[0];
  engine::Vec3 high = polygon[0];
  for (const engine::Vec3& point : polygon) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  const double middle = 0.5 * (low.y() + high.y());
  double left = high.x();
  double right = low.x();
  for (const engine::Vec3& point : polygon) {
    if (std::abs(point.y() - middle) > 0.004) continue;
    left = std::min(left, point.x());
    right = std::max(right, point.x());
  }
  return (right - left) / (high.y() - low.y());
}

/// By the number of sides that a ray to the right crosses.
bool is_inside(const std::vector<engine::Vec3>& polygon, const engine::Vec3& point) {
  bool inside = false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const engine::Vec3& a = polygon[i];
    const engine::Vec3& b = polygon[(i + 1) % polygon.size()];
    if ((a.y() > point.y()) == (b.y() > point.y())) continue;
    const double x = a.x() + (point.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
    if (x > point.x()) inside = !inside;
  }
  return inside;
}

TEST(MaterialSkin, KeepsItsContentsAndComesBackToItsShape) {
  GallerySession session("material_skin.yaml");
  const scene::NamedRange marbles = session.mats("marbles");
  const auto play = [&](double until_s) {
    int tick = 0;
    session.play_until(until_s, [&] {
      if (++tick % 10 != 0) return;
      const std::vector<engine::Vec3> skin = outline(session);
      for (std::uint32_t i = 0; i < marbles.count; ++i) {
        ASSERT_TRUE(is_inside(skin, session.position("marbles", i)))
            << i << " at " << session.time_s();
      }
    });
  };

  play(1.4);  // it has fallen, and rests
  const std::vector<engine::Vec3> before = outline(session);
  play(3.0);  // pressed
  const std::vector<engine::Vec3> pressed = outline(session);
  const double force = -session.signal("press_force");
  play(4.6);  // let go
  const std::vector<engine::Vec3> after = outline(session);

  EXPECT_GT(force, 1.0);
  EXPECT_GT(waist(before), 1.0);  // its weight has flattened it
  EXPECT_LT(waist(pressed), 0.8);
  EXPECT_NEAR(waist(after), waist(before), 0.02);
  EXPECT_GT(area(pressed), 0.85 * area(before));  // what is pressed in here comes out there
  EXPECT_NEAR(area(after), area(before), 0.01 * area(before));
  EXPECT_LT(std::abs(session.energy_residual()), 1.0e-9);
}

}  // namespace
}  // namespace cordis::test
