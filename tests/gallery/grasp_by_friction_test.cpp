// tests/gallery/grasp_by_friction_test.cpp
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/gallery/gallery_session.h"

namespace cordis::test {
namespace {

TEST(GraspByFriction, CarriesWhatItHoldsWithoutSliding) {
  GallerySession session("grasp_by_friction.yaml");
  session.play_until(3.4);  // lifted
  EXPECT_GT(session.signal("light_y"), 0.065);
  const auto in_the_hand = [&] {
    const engine::Vec3 middle = 0.5 * (session.position("left") + session.position("right"));
    return engine::Vec3(session.position("light") - middle);
  };
  const engine::Vec3 held = in_the_hand();
  const double from = session.signal("light_x");
  double slip = 0.0;
  session.play_until(4.8, [&] { slip = std::max(slip, (in_the_hand() - held).norm()); });
  EXPECT_LT(slip, 0.0003);
  EXPECT_NEAR(session.signal("light_x") - from, 0.14, 0.0005);

  session.play_until(8.0);  // it lies where it was put
  EXPECT_NEAR(session.signal("light_x"), 0.07, 0.001);
  EXPECT_NEAR(session.signal("light_y"), 0.02 - 0.04 * 9.81 / 1000.0, 1e-5);
}

TEST(GraspByFriction, SlidesOffWhatIsTooHeavy) {
  GallerySession session("grasp_by_friction.yaml");
  double highest = 0.0;
  double squeeze = 0.0;
  session.play_until(11.5, [&] {
    highest = std::max(highest, session.signal("heavy_y"));
    if (session.time_s() > 9.4) squeeze = std::max(squeeze, std::abs(session.signal("squeeze")));
  });
  EXPECT_GT(squeeze, 0.5);
  EXPECT_LT(squeeze,
            0.12 * 9.81);  // both together would have to hold its weight: 2 * 0.5 * squeeze
  EXPECT_LT(highest, 0.0205);
  EXPECT_NEAR(session.signal("heavy_y"), 0.02 - 0.12 * 9.81 / 1000.0, 1e-5);
  EXPECT_LT(std::abs(session.energy_residual()), 1.0e-9);
}

}  // namespace
}  // namespace cordis::test
