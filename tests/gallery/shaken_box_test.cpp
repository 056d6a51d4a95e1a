// tests/gallery/shaken_box_test.cpp
#include <cmath>

#include <gtest/gtest.h>

#include "tests/gallery/gallery_session.h"

namespace cordis::test {
namespace {

TEST(ShakenBox, LiesUntilItIsShakenAndThenTheLargeBallRises) {
  GallerySession session("shaken_box.yaml");
  const double weight = (180 * 0.001 + 0.01) * 9.81;
  session.play_until(0.9);
  // It has settled before it starts: the floor carries what the walls do not, by friction.
  EXPECT_LT(session.signal("nut_y"), 0.017);
  EXPECT_LT(session.signal("floor_force"), -0.8 * weight);
  EXPECT_GT(session.signal("floor_force"), -1.001 * weight);

  session.play_until(9.0);
  EXPECT_GT(session.signal("nut_y"), 1.5 * session.signal("mean_y"));
  // What the shaking brings in, the grains turn to heat.
  EXPECT_GT(session.signal("port_work"), 0.1);
  EXPECT_NEAR(session.signal("dissipated_energy"), session.signal("port_work"),
              0.1 * session.signal("port_work"));
  EXPECT_LT(std::abs(session.energy_residual()), 1.0e-9);
}

}  // namespace
}  // namespace cordis::test
