// tests/gallery/thrown_balls_test.cpp
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/gallery/gallery_session.h"

namespace cordis::test {
namespace {

TEST(ThrownBalls, ComeBackWithABackspinAlone) {
  GallerySession session("thrown_balls.yaml");
  session.play_until(0.05);
  // In the air nothing turns it: I w of 162 balls on a sphere of 45 mm, and a core.
  const double spin = 2.0 / 3.0 * 162 * 0.0002 * 0.045 * 0.045 * 40.0;
  EXPECT_NEAR(session.signal("hollow_spin"), spin, 0.01 * spin);
  const double push = (162 * 0.0002 + 0.002) * 0.6;
  EXPECT_NEAR(session.signal("hollow_push"), push, 1e-9);

  double highest = 0.0;
  session.play_until(0.3, [&] { highest = std::max(highest, session.signal("jumper_y")); });
  EXPECT_LT(session.signal("hollow_push"), -0.5 * push) << "friction turns it back";
  EXPECT_GT(session.signal("solid_push"), 0.02) << "what has no spin goes on";
  EXPECT_GT(highest, 0.2) << "the board has thrown the third ball";
}

TEST(ThrownBalls, AHoopRollsOverTheFloor) {
  GallerySession session("thrown_balls.yaml");
  session.play_until(0.3);
  // Rolling, its lowest point does not slide: it goes as fast as it turns, w r = 11 * 0.0455 m/s.
  const double before = session.signal("hoop_x");
  session.play_until(0.8);
  EXPECT_NEAR((session.signal("hoop_x") - before) / 0.5, 0.5, 0.15);
  EXPECT_LT(std::abs(session.energy_residual()), 1.0e-9);
}

}  // namespace
}  // namespace cordis::test
