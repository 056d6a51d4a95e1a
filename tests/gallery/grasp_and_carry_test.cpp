// tests/gallery/grasp_and_carry_test.cpp
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/gallery/gallery_session.h"

namespace cordis::test {
namespace {

constexpr std::size_t kPinch = 0;  // the sets of the scene
constexpr std::size_t kHooks = 1;
constexpr double kBallMass = 0.001;
constexpr double kMediumViscosity = 0.0005;
constexpr double kGravity = 9.81;

struct Motion {
  engine::Vec3 position;
  engine::Vec3 velocity;
};

/// Motion of the centre of mass; all balls have one mass.
Motion motion_of(const GallerySession& session, const std::string& name) {
  const scene::NamedRange body = session.mats(name);
  Motion sum{engine::Vec3::Zero(), engine::Vec3::Zero()};
  for (std::uint32_t i = body.first; i < body.first + body.count; ++i) {
    sum.position += session.world().position(i) / body.count;
    sum.velocity += session.world().velocity(i) / body.count;
  }
  return sum;
}

engine::Vec3 between_fingers(const GallerySession& session) {
  return 0.5 * (session.position("left") + session.position("right"));
}

TEST(GraspAndCarry, CarriesTheParcelWithoutLosingHold) {
  GallerySession session("grasp_and_carry.yaml");
  session.play_until(2.9);  // lifted
  const engine::Vec3 from = motion_of(session, "parcel.body").position;
  const engine::Vec3 in_the_hand = from - between_fingers(session);

  double slip = 0.0;
  session.play_until(4.5, [&] {
    const engine::Vec3 now = motion_of(session, "parcel.body").position - between_fingers(session);
    slip = std::max(slip, (now - in_the_hand).norm());
    ASSERT_EQ(session.world().bound_pairs(kPinch).size(), 4u);  // two balls at either finger
  });
  EXPECT_LT(slip, 0.0001);  // 0.1 mm of 14 cm
  EXPECT_NEAR(motion_of(session, "parcel.body").position.x() - from.x(), 0.14, 0.0002);
}

TEST(GraspAndCarry, LetsTheParcelFallFreely) {
  GallerySession session("grasp_and_carry.yaml");
  double released_s = 0.0;
  Motion released;
  session.play_until(4.7);
  session.play_until(4.82, [&] {
    if (released_s > 0.0 || !session.world().bound_pairs(kPinch).empty()) return;
    released_s = session.time_s();
    released = motion_of(session, "parcel.body");
  });
  ASSERT_GT(released_s, 4.7);
  ASSERT_GT(motion_of(session, "parcel.body").position.y(), 0.0);  // still in the air

  // v' = -g - (Z/m) v
  const double rate = kMediumViscosity / kBallMass;
  const double final_speed = -kGravity / rate;
  const double expected = final_speed + (released.velocity.y() - final_speed) *
                                            std::exp(-rate * (session.time_s() - released_s));
  EXPECT_LT(expected, -0.4);
  EXPECT_NEAR(motion_of(session, "parcel.body").velocity.y(), expected, 1.0e-4 * -expected);

  session.play_until(7.0);
  const engine::Vec3 rest = motion_of(session, "parcel.body").position;
  EXPECT_LT(rest.y(), -0.02);  // in the bin
  EXPECT_NEAR(rest.x(), 0.07, 0.01);
}

TEST(GraspAndCarry, NeverGivesTheBurrBack) {
  GallerySession session("grasp_and_carry.yaml");
  std::size_t held = 0;
  session.play_until(10.0, [&] {
    const std::size_t now = session.world().bound_pairs(kHooks).size();
    ASSERT_GE(now, held) << session.time_s();  // no way back
    held = now;
  });
  EXPECT_EQ(held, 4u);
  EXPECT_GT(session.signal("squeeze"), 0.5);  // the open hand draws at it
  EXPECT_LT((motion_of(session, "burr.body").position - between_fingers(session)).norm(), 0.001);
  EXPECT_LT(std::abs(session.energy_residual()), 1.0e-9);
}

}  // namespace
}  // namespace cordis::test
