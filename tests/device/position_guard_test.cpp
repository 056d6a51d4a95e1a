// tests/device/position_guard_test.cpp
#include "device_node/position_guard.h"

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

namespace cordis::device {
namespace {

constexpr double kPositionRounding = 1e-15;  // [m]

PositionGuardSettings position_settings() {
  PositionGuardSettings guard;
  guard.lowest_m = -0.04;
  guard.highest_m = 0.0;
  guard.speed_m_per_s = 2.0;
  guard.ramp_s = 0.0;
  guard.watchdog_s = 0.02;
  guard.period_s = 0.001;
  return guard;
}

AxisValues at_all_axes(double position) {
  AxisValues values;
  values.fill(position);
  return values;
}

TEST(PositionGuard, LetsThroughWhatIsAllowed) {
  PositionGuard guard(position_settings());

  guard.accept(at_all_axes(-0.001));
  EXPECT_EQ(guard.tick(0.0), at_all_axes(-0.001));
}

TEST(PositionGuard, LimitsTheSpeed) {
  PositionGuard guard(position_settings());
  guard.accept(at_all_axes(-0.005));

  EXPECT_NEAR(guard.tick(0.0)[0], -0.002, kPositionRounding);
  EXPECT_NEAR(guard.tick(0.0)[0], -0.004, kPositionRounding);
  EXPECT_NEAR(guard.tick(0.0)[0], -0.005, kPositionRounding);
}

TEST(PositionGuard, FollowsWhatComesLateInTheFirstPeriodToo) {
  PositionGuard guard(position_settings());
  guard.accept(at_all_axes(-0.0005));
  guard.tick(0.0);
  guard.accept(at_all_axes(-0.001));

  EXPECT_NEAR(guard.tick_again(0.0, 0.0005)[0], -0.001, kPositionRounding);
}

TEST(PositionGuard, StaysWithinTheTravel) {
  PositionGuard guard(position_settings());
  guard.accept(at_all_axes(-1.0));
  for (int n = 0; n < 100; ++n) guard.tick(0.0);
  EXPECT_NEAR(guard.tick(0.0)[0], -0.04, kPositionRounding);

  guard.accept(at_all_axes(1.0));
  for (int n = 0; n < 100; ++n) guard.tick(0.0);
  EXPECT_NEAR(guard.tick(0.0)[0], 0.0, kPositionRounding);
}

TEST(PositionGuard, StaysWhereItIsWhenPositionsAreOldOrNotNumbers) {
  PositionGuard guard(position_settings());
  guard.accept(at_all_axes(-0.03));
  for (int n = 0; n < 5; ++n) guard.tick(0.0);

  const AxisValues limited = guard.tick(0.02);
  EXPECT_NEAR(limited[0], -0.01, kPositionRounding);
  EXPECT_EQ(guard.tick(0.0), limited);  // the old positions do not come back

  EXPECT_FALSE(guard.accept(at_all_axes(std::nan(""))));
  EXPECT_EQ(guard.tick(0.0), limited);
  EXPECT_TRUE(guard.accept(at_all_axes(-0.011)));
  EXPECT_NEAR(guard.tick(0.0)[0], -0.011, kPositionRounding);
}

TEST(PositionGuard, MovesSlowlyAtFirst) {
  PositionGuardSettings ramped = position_settings();
  ramped.ramp_s = 0.01;
  PositionGuard guard(ramped);
  guard.accept(at_all_axes(-0.04));

  EXPECT_NEAR(guard.tick(0.0)[0], -0.0002, kPositionRounding);
  EXPECT_NEAR(guard.tick(0.0)[0], -0.0006, kPositionRounding);
}

TEST(PositionGuard, HoldsWhateverItIsGiven) {
  std::mt19937_64 random(2026);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  PositionGuard guard(position_settings());
  AxisValues before{};
  double age = 0.0;

  for (int n = 0; n < 10000; ++n) {
    if (share(random) < 0.2) {
      const double kind = share(random);
      const double sign = share(random) < 0.5 ? -1.0 : 1.0;
      const double position = kind < 0.1   ? std::nan("")
                              : kind < 0.2 ? sign * std::numeric_limits<double>::infinity()
                              : kind < 0.4 ? sign * 1e300
                                           : -0.05 * share(random);
      guard.accept(at_all_axes(position));
      age = 0.0;
    } else {
      age += 0.001;
    }
    const AxisValues& now = guard.tick(age);
    ASSERT_GE(now[7], -0.04 - kPositionRounding);
    ASSERT_LE(now[7], 0.0 + kPositionRounding);
    ASSERT_LE(std::abs(now[7] - before[7]), 0.002 + kPositionRounding);
    if (age >= 0.02) {
      ASSERT_EQ(now, before);
    }
    before = now;
  }
}

TEST(PositionGuard, RefusesSettingsOutOfRange) {
  PositionGuardSettings bad = position_settings();
  bad.speed_m_per_s = 0.0;
  EXPECT_THROW(PositionGuard{bad}, std::invalid_argument);
}

}  // namespace
}  // namespace cordis::device
