// tests/device/mock_test.cpp
#include "device_node/drivers/mock.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <stdexcept>

#include <gtest/gtest.h>

namespace cordis::device {
namespace {

constexpr double kFingerStiffness = 2000.0;
constexpr double kHandStiffness = 400.0;

AxisLayout layout_of(int axes) {
  AxisLayout layout;
  layout.count = axes;
  return layout;
}

/// Keys without dry friction, so that they rest where the balance of forces says.
MockSettings played_by_a_hand(double target_m, int axes) {
  MockSettings settings;
  settings.key.friction_n = 0.0;
  settings.hand.stiffness_n_per_m = kHandStiffness;
  settings.hand.finger_n_per_m = kFingerStiffness;
  settings.gesture = {
      Trajectory(0.0, {{0.1, 0.3, target_m}}, Trajectory::Shape::kMinimumJerk, 0.0)};
  for (int a = 0; a < axes; ++a) settings.played.push_back(a);
  return settings;
}

/// Lives under a constant command, and returns what the sensors then say.
AxisValues after(Mock& mock, double seconds, double commanded) {
  AxisValues values;
  values.fill(commanded);
  for (int n = 0; n < static_cast<int>(seconds * 1000.0); ++n) mock.write(values);
  mock.read(values);
  return values;
}

std::array<std::uint64_t, kMaxAxes> bits_of(const AxisValues& values) {
  return std::bit_cast<std::array<std::uint64_t, kMaxAxes>>(values);
}

TEST(Mock, HandAndForceComeToTheBalanceOfTheirSprings) {
  // The finger pushes P = K_f (x - x_h), the hand is pulled P = K_h (x_h - target), the key
  // carries P = F: so x = target + F / K_h + F / K_f.
  const double target = -0.02;
  Mock mock(played_by_a_hand(target, 1), layout_of(1));
  mock.start(Role::kMass);

  const double with_two_newton = after(mock, 5.0, 2.0)[0];
  const double with_one_newton = after(mock, 5.0, 1.0)[0];

  EXPECT_NEAR(with_two_newton, target + 2.0 / kHandStiffness + 2.0 / kFingerStiffness, 1e-9);
  EXPECT_NEAR(with_one_newton, target + 1.0 / kHandStiffness + 1.0 / kFingerStiffness, 1e-9);
}

TEST(Mock, MeasuresTheHandThatPushesWhereTheKeyIsCarried) {
  // K_f (x - x_h) = K_h (x_h - target) is the force, x held by the motor.
  const double target = -0.02;
  const double x = -0.005;
  Mock mock(played_by_a_hand(target, 1), layout_of(1));
  mock.start(Role::kLiaison);

  const double force = after(mock, 5.0, x)[0];

  const double series = kFingerStiffness * kHandStiffness / (kFingerStiffness + kHandStiffness);
  EXPECT_NEAR(force, -series * (x - target), 1e-9);
}

TEST(Mock, SensorDoesNotMeasureMoreThanTheLimitOfForce) {
  MockSettings settings = played_by_a_hand(-0.5, 1);
  AxisLayout layout = layout_of(1);
  layout.force_limit_n = 4.0;
  Mock mock(settings, layout);
  mock.start(Role::kLiaison);

  EXPECT_EQ(after(mock, 2.0, 0.0)[0], -4.0);
}

TEST(Mock, PlaysTheAxesItIsGivenOneAfterTheOther) {
  MockSettings settings = played_by_a_hand(-0.02, 0);
  settings.played = {2, 0};
  settings.stagger_s = 1.0;
  Mock mock(settings, layout_of(3));
  mock.start(Role::kMass);

  const AxisValues first = after(mock, 0.9, 0.0);
  EXPECT_LT(first[2], -0.015);
  EXPECT_EQ(first[0], 0.0);
  EXPECT_EQ(first[1], 0.0);

  const AxisValues second = after(mock, 1.0, 0.0);
  EXPECT_LT(second[0], -0.015);
  EXPECT_EQ(second[1], 0.0);
  for (int a = 3; a < kMaxAxes; ++a) EXPECT_EQ(second[a], 0.0);
}

TEST(Mock, SameForcesGiveTheSamePositionsToTheLastBit) {
  const MockSettings settings = played_by_a_hand(-0.03, 16);
  Mock one(settings, layout_of(16));
  Mock other(settings, layout_of(16));
  one.start(Role::kMass);
  after(one, 0.3, 1.0);  // an earlier life must not matter
  one.start(Role::kMass);
  other.start(Role::kMass);
  AxisValues x{};
  AxisValues y{};

  for (int n = 0; n < 3000; ++n) {
    one.read(x);
    other.read(y);
    ASSERT_EQ(bits_of(x), bits_of(y)) << n;
    AxisValues force;
    for (std::size_t a = 0; a < force.size(); ++a) {
      force[a] = -100.0 * x[a] + 0.1 * static_cast<double>((n * (a + 3)) % 17);
    }
    one.write(force);
    other.write(force);
  }
}

TEST(Mock, BeginsItsGestureAtEveryStart) {
  Mock mock(played_by_a_hand(-0.02, 1), layout_of(1));  // which rests for 0.1 s
  for (int life = 0; life < 2; ++life) {
    mock.start(Role::kMass);
    EXPECT_EQ(after(mock, 0.1, 0.0)[0], 0.0) << life;
    EXPECT_LT(after(mock, 0.001, 0.0)[0], 0.0) << life;
  }
}

TEST(Mock, TakesAsManySubStepsAsItsMechanicsWant) {
  MockSettings settings = played_by_a_hand(-0.02, 1);
  const Mock mock(settings, layout_of(1));
  settings.key.stop_n_per_m *= 4.0;
  const Mock stiffer(settings, layout_of(1));

  // h <= 0.1 sqrt(m/K) for key and stop and finger; here the stop's damper wants less still
  EXPECT_GE(mock.sub_steps(), std::ceil(0.001 / (0.1 * std::sqrt(0.05 / 22000.0))));
  EXPECT_GE(stiffer.sub_steps(), std::ceil(0.001 / (0.1 * std::sqrt(0.05 / 82000.0))));
  EXPECT_LT(stiffer.sub_steps(), 30);
}

TEST(Mock, RefusesMechanicsTooFastToSimulate) {
  MockSettings settings = played_by_a_hand(-0.02, 1);
  settings.hand.mass_kg = 1e-4;
  settings.hand.finger_n_per_m = 1e6;
  EXPECT_THROW(Mock(settings, layout_of(1)), std::invalid_argument);
}

}  // namespace
}  // namespace cordis::device
