// tests/gallery/workbench_test.cpp
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "tests/gallery/gallery_session.h"

namespace cordis::test {
namespace {

constexpr const char* kLaunch = "workbench.yaml";
constexpr double kGravity = 9.81;

/// How far the bottom row of the block is turned [rad].
double tilt_of_the_block(const GallerySession& session) {
  const engine::Vec3 row = session.position("block", 4) - session.position("block", 0);
  return std::abs(std::atan2(row.y(), row.x()));
}

double width_of_the_block(const GallerySession& session) {
  return (session.position("block", 4) - session.position("block", 0)).norm();
}

TEST(Workbench, APortOnAWholeBlockLiftsItWithoutTurningOrSqueezingIt) {
  constexpr double kLifted = 1.5;  // [s]
  GallerySession session(kLaunch);
  session.play_until(kLifted);
  EXPECT_GT(session.signal("block_y"), 0.015 + 0.025);
  EXPECT_LT(tilt_of_the_block(session), 1e-9);
  EXPECT_NEAR(width_of_the_block(session), 0.04, 1e-9);

  const ChangedScene changed(
      "workbench", {{"of: block}", "at_m: [-0.16, 0.055], mass_kg: 0.02}"},
                    {"links:\n", "links:\n  - {liaison: wire, between: [hand, \"block[14]\"]}\n"}});
  GallerySession by_a_corner(kLaunch, changed.overrides());
  by_a_corner.play_until(kLifted);
  EXPECT_GT(tilt_of_the_block(by_a_corner), 0.5);
  EXPECT_GT(std::abs(width_of_the_block(by_a_corner) - 0.04), 1e-4);
}

TEST(Workbench, AHandUpwardsAloneLeavesTheBlockToTheStream) {
  GallerySession session(kLaunch);
  session.play_until(3.8);
  EXPECT_NEAR(session.signal("block_x"), -0.18 + 0.02 * 3.8, 1e-6);

  GallerySession on_both(kLaunch, {"hand.mock.hand.axes=[0, 1]"});
  on_both.play_until(3.8);
  EXPECT_NEAR(on_both.signal("block_x"), -0.18, 1e-3);
}

TEST(Workbench, AThinWallKeepsTheMarbleOnEitherSide) {
  constexpr double kWall = 0.3;
  double left = -1.0;
  double right = 1.0;
  GallerySession session(kLaunch);
  session.play_until(5.0, [&] {
    left = std::max(left, session.signal("left_marble"));
    right = std::min(right, session.signal("right_marble"));
  });
  EXPECT_LT(left, kWall);
  EXPECT_GT(left, kWall - 0.011) << "it has touched the wall";
  EXPECT_GT(right, kWall);
  EXPECT_LT(right, kWall + 0.02);

  const ChangedScene changed("workbench", {{", sides: both", ""}});
  GallerySession one_sided(kLaunch, changed.overrides());
  one_sided.play_until(0.2);
  EXPECT_GT(one_sided.signal("left_marble"), kWall) << "pushed to the side of the normal";
}

/// Half of what a signal goes up and down from 3 s to 4 s.
double swing(GallerySession& session, const std::string& signal) {
  session.play_until(3.0);
  double lowest = std::numeric_limits<double>::max();
  double highest = std::numeric_limits<double>::lowest();
  session.play_until(4.0, [&] {
    lowest = std::min(lowest, session.signal(signal));
    highest = std::max(highest, session.signal(signal));
  });
  return 0.5 * (highest - lowest);
}

TEST(Workbench, ALoudspeakerSwingsByItsForceAndPushesWhatHoldsItWithNoMore) {
  constexpr double kPush = 0.1;
  const double w = 2.0 * std::numbers::pi * 10.0;
  const double amplitude = kPush / std::hypot(80.0 - 0.02 * w * w, 0.4 * w);
  GallerySession session(kLaunch);
  EXPECT_NEAR(swing(session, "cone"), amplitude, 0.01 * amplitude);

  const std::pair<std::string, std::string> held{"viscosity_n_s_per_m: 0.4, rest_m",
                                                 "viscosity_n_s_per_m: 40, rest_m"};
  const ChangedScene by_force("workbench", {held});
  GallerySession pushed(kLaunch, by_force.overrides());
  EXPECT_LT(swing(pushed, "magnet_force"), 1.02 * kPush);

  const ChangedScene by_way("workbench",
                            {held, {"force_n: [0, push_n", "displacement_m: [0, 0.04 * push_n"}});
  GallerySession moved(kLaunch, by_way.overrides());
  EXPECT_GT(swing(moved, "magnet_force"), 90.0 * kPush);
}

TEST(Workbench, ABentWireHoldsTheLampByItsAngleAtRest) {
  constexpr double kLength = 0.04;
  const double sinks = kLength * std::sin(std::atan(0.05 * kGravity * kLength / 0.2));
  GallerySession session(kLaunch);
  session.play_until(3.0);
  EXPECT_NEAR(0.1 - session.signal("lamp"), sinks, 0.01 * sinks);

  const ChangedScene changed("workbench", {{", rest_rad: -1.5707963268", ""}});
  GallerySession straight(kLaunch, changed.overrides());
  straight.play_until(3.0);
  EXPECT_GT(straight.signal("lamp"), 0.135) << "the wire springs up, straight";
}

/// How far the door is ever from its steady way in two seconds [m].
double error_of_the_door(GallerySession& session) {
  double error = 0.0;
  session.play_until(2.0, [&] {
    const double steady = 0.16 - 0.02 * session.time_s();
    error = std::max(error, std::abs(session.signal("door") - steady));
  });
  return error;
}

TEST(Workbench, ADoorCloserThatBeginsDrawnLetsTheDoorDownSteadily) {
  GallerySession session(kLaunch);
  EXPECT_LT(error_of_the_door(session), 1e-5);

  const ChangedScene changed("workbench", {{"start_force_n: 0.981", "start_force_n: 0"}});
  GallerySession slack(kLaunch, changed.overrides());
  EXPECT_GT(error_of_the_door(slack), 0.015) << "it drops first, by up to 2 m g / K";
}

TEST(Workbench, ParachutesFallAsTheRootOfTheirWeight) {
  GallerySession session(kLaunch);
  session.play_until(0.5);
  const double light = std::sqrt(0.01 * kGravity / 1.5696);
  EXPECT_NEAR(session.signal("light"), -light, 1e-3 * light);
  EXPECT_NEAR(session.signal("heavy") / session.signal("light"), std::numbers::sqrt2, 1e-3);

  const ChangedScene changed("workbench",
                             {{"dissipation: {kind: power, coefficient: 1.5696, exponent: 2}",
                               "viscosity_n_s_per_m: 0.3924"}});
  GallerySession linear(kLaunch, changed.overrides());
  linear.play_until(0.5);
  EXPECT_NEAR(linear.signal("heavy") / linear.signal("light"), 2.0, 1e-3);
}

}  // namespace
}  // namespace cordis::test
