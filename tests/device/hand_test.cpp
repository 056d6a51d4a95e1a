// tests/device/hand_test.cpp
#include "device_node/drivers/hand.h"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

namespace cordis::device {
namespace {

constexpr double kH = 1e-5;  // [s]

HandSettings hand_settings() {
  HandSettings hand;
  hand.mass_kg = 0.15;
  hand.stiffness_n_per_m = 400.0;
  hand.viscosity_n_s_per_m = 10.0;
  hand.finger_n_per_m = 2000.0;
  hand.finger_viscosity_n_s_per_m = 2.0;
  return hand;
}

Trajectory resting_at(double target) {
  return {target, {}, Trajectory::Shape::kMinimumJerk, 0.0};
}

TEST(Hand, FollowsAMinimumJerkMoveAsItsEquationSays) {
  // The lag e = x - target follows m e'' + Z e' + K e = -m a(t), with a(t) the cubic acceleration
  // of the move. Its solution is a cubic, found power by power, and a damped swing from rest.
  const HandSettings steady = hand_settings();
  const double m = steady.mass_kg;
  const double z = steady.viscosity_n_s_per_m;
  const double k = steady.stiffness_n_per_m;
  const double distance = -0.03;
  const double duration = 0.3;
  const double scale = m * distance / (duration * duration);
  const double c1 = -scale * 60.0 / duration;
  const double c2 = scale * 180.0 / (duration * duration);
  const double c3 = -scale * 120.0 / (duration * duration * duration);
  const double p3 = c3 / k;
  const double p2 = (c2 - 3.0 * z * p3) / k;
  const double p1 = (c1 - 2.0 * z * p2 - 6.0 * m * p3) / k;
  const double p0 = -(z * p1 + 2.0 * m * p2) / k;
  const double s = z / (2.0 * m);
  const double w = std::sqrt(k / m - s * s);
  const Trajectory target(0.0, {{0.0, duration, distance}}, Trajectory::Shape::kMinimumJerk, 0.0);
  Hand hand(steady, target);

  double largest_lag = 0.0;
  for (int n = 0; n * kH < duration; ++n) {
    hand.advance(n * kH, kH, 0.0);
    const double t = (n + 1) * kH;
    const double swing =
        std::exp(-s * t) * (-p0 * std::cos(w * t) + (-p1 - s * p0) / w * std::sin(w * t));
    const double lag = p0 + t * (p1 + t * (p2 + t * p3)) + swing;
    // first order: half a sub-step late at 0.19 m/s
    ASSERT_NEAR(hand.position_m(), target.value_at(t) + lag, 2e-6) << t;
    largest_lag = std::max(largest_lag, std::abs(lag));
  }
  EXPECT_GT(largest_lag, 5e-4);  // or the comparison would show nothing
}

TEST(Hand, YieldsToAForceByForceOverStiffness) {
  Hand hand(hand_settings(), resting_at(-0.01));

  for (int n = 0; n < 200000; ++n) hand.advance(n * kH, kH, 1.2);

  EXPECT_NEAR(hand.position_m(), -0.01 + 1.2 / 400.0, 1e-12);
}

TEST(Hand, PullsNoHarderThanItsLimit) {
  // Its spring alone would pull with 20 N and more all the way: it moves as a mass under a constant force,
  // and a force above the limit carries it off. With h the step, x(n) = a h^2 n (n + 1) / 2.
  HandSettings weak = hand_settings();
  weak.force_limit_n = 3.0;
  for (const double force_n : {0.0, -5.0}) {
    Hand hand(weak, resting_at(0.0));
    hand.follow(0.1, 0.0, 1.0);
    const double acceleration = (3.0 + force_n) / 0.15;
    const int count = 5000;

    for (int n = 0; n < count; ++n) hand.advance(n * kH, kH, force_n);

    EXPECT_NEAR(hand.position_m(), acceleration * kH * kH * count * (count + 1) / 2.0, 1e-9);
  }
}

TEST(Hand, ComesToRestAtItsTargetUnderALimit) {
  HandSettings weak = hand_settings();
  weak.force_limit_n = 3.0;
  Hand hand(weak, resting_at(0.0));
  hand.follow(0.1, 0.0, 1.0);

  for (int n = 0; n < 200000; ++n) hand.advance(n * kH, kH, 1.2);

  EXPECT_NEAR(hand.position_m(), 0.1 + 1.2 / 400.0, 1e-9);
}

TEST(Hand, PushesButDoesNotPull) {
  const Hand hand(hand_settings(), resting_at(-0.01));

  EXPECT_EQ(hand.force_on_key_n(-0.011, 0.0), 0.0);  // key below the finger
  EXPECT_EQ(hand.force_on_key_n(-0.011, 1.0), 0.0);
  EXPECT_NEAR(hand.force_on_key_n(-0.009, 0.0), -2.0, 1e-12);  // 1 mm into the finger
  EXPECT_EQ(hand.force_on_key_n(-0.009, -5.0), 0.0);           // flees faster than it springs back
}

TEST(Hand, PullsWhenItHolds) {
  HandSettings holding = hand_settings();
  holding.holds = true;
  const Hand hand(holding, resting_at(-0.01));

  EXPECT_NEAR(hand.force_on_key_n(-0.011, 0.0), 2.0, 1e-12);
  EXPECT_NEAR(hand.force_on_key_n(-0.009, 0.0), -2.0, 1e-12);
  EXPECT_NEAR(hand.force_on_key_n(-0.01, 0.5), -1.0, 1e-12);
}

TEST(Hand, StartsAtRestAtTheBeginningOfItsTarget) {
  Hand hand(hand_settings(), resting_at(0.02));
  hand.advance(0.0, kH, 5.0);
  ASSERT_NE(hand.position_m(), 0.02);

  hand.start();

  EXPECT_EQ(hand.position_m(), 0.02);
  EXPECT_EQ(hand.speed_m_per_s(), 0.0);
}

TEST(Hand, RefusesSettingsOutOfRange) {
  HandSettings bad = hand_settings();
  bad.mass_kg = -1.0;
  EXPECT_THROW(Hand(bad, resting_at(0.0)), std::invalid_argument);
  bad = hand_settings();
  bad.finger_n_per_m = 0.0;
  EXPECT_THROW(Hand(bad, resting_at(0.0)), std::invalid_argument);
  bad = hand_settings();
  bad.force_limit_n = 0.0;
  EXPECT_THROW(Hand(bad, resting_at(0.0)), std::invalid_argument);
}

}  // namespace
}  // namespace cordis::device
