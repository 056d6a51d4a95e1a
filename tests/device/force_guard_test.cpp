// tests/device/force_guard_test.cpp
#include "device_node/force_guard.h"

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

namespace cordis::device {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kRounding = 1e-9;  // [N], sums of forces of 20 N round at 4e-15

ForceGuardSettings force_settings() {
  ForceGuardSettings guard;
  guard.limit_n = 20.0;
  guard.slew_n_per_s = 5000.0;
  guard.ramp_s = 0.0;
  guard.watchdog_s = 0.02;
  guard.period_s = 0.001;
  return guard;
}

AxisValues all(double force) {
  AxisValues values;
  values.fill(force);
  return values;
}

TEST(ForceGuard, GivesNothingBeforeTheFirstForces) {
  ForceGuard guard(force_settings());

  EXPECT_EQ(guard.tick(0.0, {}), AxisValues{});
}

TEST(ForceGuard, LetsThroughWhatIsAllowed) {
  ForceGuard guard(force_settings());

  guard.accept(all(3.0));
  EXPECT_EQ(guard.tick(0.001, {}), all(3.0));
  guard.accept(all(-1.5));
  EXPECT_EQ(guard.tick(0.001, {}), all(-1.5));
}

TEST(ForceGuard, LimitsTheForce) {
  ForceGuard guard(force_settings());

  guard.accept(all(1e300));
  for (int n = 0; n < 10; ++n) guard.tick(0.0, {});

  EXPECT_EQ(guard.tick(0.0, {}), all(20.0));
}

TEST(ForceGuard, LimitsTheChange) {
  ForceGuard guard(force_settings());
  guard.accept(all(12.0));

  EXPECT_DOUBLE_EQ(guard.tick(0.0, {})[0], 5.0);
  EXPECT_DOUBLE_EQ(guard.tick(0.0, {})[0], 10.0);
  EXPECT_DOUBLE_EQ(guard.tick(0.0, {})[0], 12.0);
  guard.accept(all(-12.0));
  EXPECT_DOUBLE_EQ(guard.tick(0.0, {})[0], 7.0);
}

TEST(ForceGuard, RampsForcesUpFromTheStart) {
  ForceGuardSettings ramped = force_settings();
  ramped.ramp_s = 0.1;
  ForceGuard guard(ramped);
  guard.accept(all(10.0));

  for (int n = 1; n <= 200; ++n) {
    ASSERT_NEAR(guard.tick(0.0, {})[3], std::min(0.1 * n, 10.0), kRounding) << n;
  }
}

TEST(ForceGuard, FadesOutSoAsToBeAtZeroWhenTheWatchdogBites) {
  ForceGuard guard(force_settings());
  guard.accept(all(20.0));
  for (int n = 0; n < 10; ++n) guard.tick(0.0, {});

  double before = 20.0;
  for (int n = 1; n <= 20; ++n) {
    const double force = guard.tick(n * 0.001, {})[0];
    ASSERT_LE(before - force, 5.0 + kRounding) << n;
    if (n <= 16) {
      ASSERT_NEAR(force, 20.0, kRounding) << n;  // 4 ms suffice for 20 N
    }
    before = force;
  }
  EXPECT_EQ(before, 0.0);
}

TEST(ForceGuard, IsAtZeroAtOnceWhenItsTicksHadStopped) {
  ForceGuard guard(force_settings());
  guard.accept(all(20.0));
  for (int n = 0; n < 10; ++n) guard.tick(0.0, {});

  EXPECT_EQ(guard.tick(0.5, {}), AxisValues{});
  EXPECT_EQ(guard.tick(std::numeric_limits<double>::quiet_NaN(), {}), AxisValues{});
}

TEST(ForceGuard, RampsUpAnewAfterTheWatchdogHasBitten) {
  ForceGuardSettings ramped = force_settings();
  ramped.ramp_s = 0.01;
  ForceGuard guard(ramped);
  guard.accept(all(10.0));
  for (int n = 0; n < 20; ++n) guard.tick(0.0, {});
  guard.tick(1.0, {});

  EXPECT_EQ(guard.tick(0.0, {}), AxisValues{});  // the old forces do not come back
  guard.accept(all(10.0));
  EXPECT_DOUBLE_EQ(guard.tick(0.0, {})[0], 1.0);
}

TEST(ForceGuard, ForgetsForcesThatAreAsOldAsTheWatchdogTime) {
  ForceGuard guard(force_settings());
  guard.accept(all(10.0));
  for (int n = 0; n < 20; ++n) guard.tick(0.0, {});

  EXPECT_EQ(guard.tick(0.02, {}), AxisValues{});
  EXPECT_EQ(guard.tick(0.0, {}), AxisValues{});
}

TEST(ForceGuard, TheForceOfTheFirstTickMayMoveTheHandOverTheTravel) {
  ForceGuardSettings watched = force_settings();
  watched.passivity.active = true;
  watched.passivity.budget_j = 1e-6;
  watched.passivity.travel_m = 0.01;
  ForceGuard guard(watched);
  guard.accept({1.0});  // it may give 10 mJ
  double position_m = 0.0;
  const auto move = [&] { return guard.tick(0.0, {position_m += 0.0005})[0]; };

  for (int n = 0; n < 18; ++n) ASSERT_EQ(move(), 1.0) << n;

  double last = 1.0;
  for (int n = 0; n < 10; ++n) last = move();
  EXPECT_LT(last, 1.0) << "a force that gives more makes energy";
}

TEST(ForceGuard, FadesToZeroWhenAnyForceIsNotANumber) {
  for (const double bad : {std::nan(""), kInfinity, -kInfinity}) {
    ForceGuard guard(force_settings());
    ASSERT_TRUE(guard.accept(all(8.0)));
    guard.tick(0.0, {});
    guard.tick(0.0, {});
    AxisValues values = all(8.0);
    values[15] = bad;

    EXPECT_FALSE(guard.accept(values));

    EXPECT_DOUBLE_EQ(guard.tick(0.0, {})[0], 3.0);
    EXPECT_EQ(guard.tick(0.0, {}), AxisValues{});
    EXPECT_EQ(guard.tick(0.0, {}), AxisValues{});
  }
}

TEST(ForceGuard, HoldsWhateverItIsGiven) {
  std::mt19937_64 random(2026);
  std::uniform_real_distribution<double> exponent(-3.0, 310.0);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  const auto any_force = [&] {
    const double kind = share(random);
    if (kind < 0.02) return std::nan("");
    if (kind < 0.04) return kInfinity;
    if (kind < 0.06) return -kInfinity;
    const double sign = share(random) < 0.5 ? -1.0 : 1.0;
    if (kind < 0.5) return sign * 20.0 * share(random);
    return sign * std::pow(10.0, exponent(random));  // overflows to infinity now and then
  };
  ForceGuardSettings guarded = force_settings();
  guarded.ramp_s = 0.05;
  guarded.passivity.active = true;
  ForceGuard guard(guarded);
  AxisValues before{};
  AxisValues position{};
  double age = 0.0;
  int zeros_by_age = 0;
  int forces = 0;

  for (int n = 0; n < 10000; ++n) {
    // Between two answers pass up to 40 ticks; only then does the age grow past the watchdog.
    const bool answered = share(random) < (n % 500 < 400 ? 0.5 : 0.02);
    if (answered) {
      AxisValues values;
      for (double& value : values) value = any_force();
      guard.accept(values);
      age = 0.0;
    } else {
      age += guarded.period_s;
    }
    for (double& coordinate : position)
      coordinate = 0.04 * share(random);  // a hand that jumps, up to 40 m/s
    const AxisValues& now = guard.tick(age, position);
    for (std::size_t a = 0; a < now.size(); ++a) {
      ASSERT_LE(std::abs(now[a]), 20.0) << n;
      ASSERT_LE(std::abs(now[a] - before[a]), 5.0 + kRounding) << n;
      if (age >= guarded.watchdog_s) {
        ASSERT_EQ(now[a], 0.0) << n;
      }
      forces += now[a] != 0.0;
    }
    zeros_by_age += age >= guarded.watchdog_s;
    before = now;
  }
  EXPECT_GT(zeros_by_age, 100);
  EXPECT_GT(forces, 1000);
}

/// 5 N in the first period, and 0.5 N more in each tenth of one.
TEST(ForceGuard, ChangesForcesByNoMoreThanTheTimeBetweenCommandsAllows) {
  constexpr double kSpan = 0.0001;  // [s]
  ForceGuard guard(force_settings());
  double before = 0.0;
  double changed = 0.0;
  for (int n = 0; n < 50; ++n) {
    guard.accept(all(n % 2 == 0 ? 20.0 : -20.0));
    const double since_s = n == 0 ? ForceGuard::kWholePeriod : kSpan;
    const double force = guard.tick(0.0, {}, 0.0, since_s)[0];
    changed += std::abs(force - before);
    before = force;
    ASSERT_LE(changed, 5000.0 * (n * kSpan + 0.001) + kRounding) << n;
  }
  EXPECT_GT(changed, 20.0) << "it may change by as much";
}

TEST(ForceGuard, CountsTheWorkOfTheMeanForceOfAPeriod) {
  ForceGuard guard(force_settings());
  guard.accept(all(0.0));
  guard.tick(0.0, {});
  guard.accept({2.0});
  guard.tick(0.0, {}, 0.25);  // 0 N for a quarter of the period, then 2 N
  guard.accept({4.0});
  guard.tick_again(0.0, 0.75, 0.0005);  // and 4 N for the last one

  guard.tick(0.0, {0.001});

  EXPECT_NEAR(guard.energy().given_j(), 0.001 * (0.5 * 2.0 + 0.25 * 4.0), 1e-15);
}

TEST(ForceGuard, LetsADeviceThatHasBeenAwayGoForAPeriodAndRampsUpAnew) {
  ForceGuardSettings ramped = force_settings();
  for (const double ramp_s : {0.0, 0.01}) {
    ramped.ramp_s = ramp_s;
    ForceGuard guard(ramped);
    guard.accept(all(4.0));
    for (int n = 0; n < 20; ++n) guard.tick(0.0, {});
    ASSERT_EQ(guard.tick(0.0, {}), all(4.0));

    guard.let_go();

    guard.accept(all(4.0));
    EXPECT_EQ(guard.tick(0.0, {}), AxisValues{});
    EXPECT_EQ(guard.tick_again(0.0, 0.5, 0.0005), AxisValues{});
    EXPECT_NEAR(guard.tick(0.0, {})[0], ramp_s > 0.0 ? 0.4 : 4.0, kRounding);
  }
}

TEST(ForceGuard, ForgetsAtItsStartThatItLetGo) {
  ForceGuard guard(force_settings());
  guard.let_go();
  guard.start();
  guard.accept(all(4.0));
  EXPECT_EQ(guard.tick(0.0, {}), all(4.0));
}

TEST(ForceGuard, ChangesNothingWithinAPeriodForForcesAsOldAsTheWatchdogTime) {
  ForceGuard guard(force_settings());
  guard.accept(all(10.0));
  for (int n = 0; n < 5; ++n) guard.tick(0.0, {});

  for (const double age_s : {0.02, 0.03}) EXPECT_EQ(guard.tick_again(age_s, 0.5, 0.0005)[0], 10.0);
  EXPECT_EQ(guard.tick(0.02, {}), AxisValues{});
}

TEST(ForceGuard, GivesAMovingAxisNoMoreThanItsPower) {
  ForceGuardSettings weak = force_settings();
  weak.power_w = 2.0;
  ForceGuard guard(weak);
  guard.accept(all(8.0));
  AxisValues position{};
  AxisValues force{};

  for (int n = 0; n < 10; ++n) {
    force = guard.tick(0.0, position);
    position[0] += 0.001;  // 1 m/s along the force
    position[1] -= 0.001;  // and against it
  }

  EXPECT_NEAR(force[0], 2.0, kRounding);
  EXPECT_NEAR(force[1], 8.0, kRounding);
  EXPECT_NEAR(force[2], 8.0, kRounding);
}

TEST(ForceGuard, RefusesSettingsOutOfRange) {
  ForceGuardSettings bad = force_settings();
  bad.limit_n = 0.0;
  EXPECT_THROW(ForceGuard{bad}, std::invalid_argument);
  bad = force_settings();
  bad.watchdog_s = std::nan("");
  EXPECT_THROW(ForceGuard{bad}, std::invalid_argument);
}

}  // namespace
}  // namespace cordis::device
