// tests/gallery/block_on_an_incline_test.cpp
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/gallery/gallery_session.h"

namespace cordis::test {
namespace {

TEST(BlockOnAnIncline, SticksWhereItIsLeftAndSlidesWhereItIsSmooth) {
  constexpr double kAngle = 20.0 * std::numbers::pi / 180.0;
  constexpr double kGravity = 9.81;
  GallerySession session("block_on_an_incline.yaml");

  session.play_until(0.1);
  const double start = session.signal("smooth_x");
  session.play_until(0.2);
  const double middle = session.signal("smooth_x");
  session.play_until(0.3);
  const double end = session.signal("smooth_x");
  const double acceleration = (end - 2.0 * middle + start) / (0.1 * 0.1) / std::cos(kAngle);
  const double expected = kGravity * (std::sin(kAngle) - 0.15 * std::cos(kAngle));
  EXPECT_NEAR(acceleration, expected, 0.02 * expected);

  session.play_until(0.95);
  const double rough = session.signal("rough_x");
  session.play_until(3.5);
  const double left = session.signal("rough_x");
  EXPECT_GT(left - rough, 0.03);
  session.play_until(10.0);
  EXPECT_NEAR(session.signal("rough_x"), left, 1e-6);
  // the slope carries the rough block, and of the smooth one all that does not lean on the wall
  const double weight = 30.0 * 0.002 * kGravity;
  EXPECT_LT(session.signal("slope_force_y"), -0.8 * weight);
  EXPECT_LT(std::abs(session.energy_residual()), 1.0e-9);
}

}  // namespace
}  // namespace cordis::test
