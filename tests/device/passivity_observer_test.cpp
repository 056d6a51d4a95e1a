// tests/device/passivity_observer_test.cpp
#include "device_node/passivity_observer.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

#include "device_node/force_guard.h"

namespace cordis::device {
namespace {

constexpr double kPeriod = 0.001;   // T [s]
constexpr double kMass = 0.05;      // m [kg]
constexpr double kViscosity = 1.0;  // b [N s/m]

/// Largest stiffness that is passive for slow hands with a delay of d periods (Colgate and
/// Schenkel 1997 for d = 0).
double passive_stiffness(double delay) {
  return kViscosity / (kPeriod * (0.5 + delay));
}

ForceGuardSettings guarded(bool active) {
  ForceGuardSettings settings;
  settings.limit_n = 20.0;
  settings.slew_n_per_s = 1e5;
  settings.ramp_s = 0.0;
  settings.passivity.active = active;
  settings.passivity.mass_kg = kMass;
  settings.passivity.viscosity_n_s_per_m = kViscosity;
  return settings;
}

/// A key of mass m and viscosity b under forces held over a period: exact, m v' = f - b v.
struct Key {
  double position = 0.0;
  double speed = 0.0;

  void step(double force, double share) {
    const double decay = std::exp(-kViscosity * share * kPeriod / kMass);
    const double end = force / kViscosity;  // the speed it tends to
    const double tau = kMass / kViscosity;
    position += end * share * kPeriod + (speed - end) * tau * (1.0 - decay);
    speed = end + (speed - end) * decay;
  }
};

/// The key before a wall that pushes back from 0 downwards, as it was `delay` periods ago. With a
/// part of a period its force changes within the period.
struct Loop {
  Loop(double stiffness, double delay, bool active)
      : stiffness_(stiffness),
        part_(delay - std::floor(delay)),
        guard(guarded(active)),
        past_(static_cast<std::size_t>(delay) + 1, 0.0) {}

  void period(double hand_n) {
    past_.push_back(key.position);
    past_.pop_front();
    AxisValues wanted{};
    wanted[0] = past_.front() < 0.0 ? -stiffness_ * past_.front() : 0.0;
    guard.accept(wanted);
    AxisValues position{};
    position[0] = key.position;
    const double before = force_;
    force_ = guard.tick(0.0, position, part_)[0];
    const double start = key.position;
    key.step(before + hand_n, part_);
    work += before * (key.position - start);
    const double middle = key.position;
    key.step(force_ + hand_n, 1.0 - part_);
    work += force_ * (key.position - middle);
    damped += guard.energy().is_damping();
  }

 private:
  double stiffness_;
  double part_;
  double force_ = 0.0;

 public:
  Key key;
  ForceGuard guard;
  int damped = 0;
  double work = 0.0;  // to the hand, exactly [J]

 private:
  std::deque<double> past_;
};

TEST(PassivityObserver, LetsALoopGiveItsBudgetAndNoMore) {
  for (const double budget : {0.0005, 0.001, 0.02}) {
    PassivitySettings settings;
    settings.active = true;
    settings.budget_j = budget;
    PassivityObserver observer(settings);
    observer.start();
    AxisValues force{};
    AxisValues position{};
    force[0] = 2.0;
    observer.observe(force, position);
    constexpr double kStepsToBudget = 20.0;
    for (int n = 1; n <= 40; ++n) {
      position[0] += budget / (kStepsToBudget * force[0]);  // each step gives a 20th of the budget
      observer.observe(force, position);
      if (n == 20) continue;  // just at the budget
      ASSERT_EQ(observer.is_damping(), n > 20) << budget << ", step " << n;
    }
  }
}

class Delays : public ::testing::TestWithParam<double> {};

TEST_P(Delays, APassiveWallIsNeverDamped) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> force(-0.4, 1.5);
  Loop loop(0.99 * passive_stiffness(GetParam()), GetParam(), true);

  double deepest = 0.0;
  double hand = 0.0;
  for (int n = 0; n < 60000; ++n) {
    if (n % 20 == 0) hand = force(random);
    loop.period(hand);
    deepest = std::min(deepest, loop.key.position);
  }

  EXPECT_EQ(loop.damped, 0);
  EXPECT_LT(deepest, -0.002) << "the hand has pressed the wall";
  EXPECT_NEAR(loop.guard.energy().given_j(), loop.work, 5e-3 * std::abs(loop.work))
      << "the motion between two samples is nearly straight";
}

/// Half of the range of positions in the last of six seconds under a hand of 1 N.
double swing(Loop& loop) {
  double lowest = 0.0;
  double highest = -1.0;
  for (int n = 0; n < 6000; ++n) {
    loop.period(-1.0);
    if (n < 5000) continue;
    lowest = std::min(lowest, loop.key.position);
    highest = std::max(highest, loop.key.position);
  }
  return 0.5 * (highest - lowest);
}

TEST_P(Delays, TheControllerEndsALimitCycleUpToTenTimesTheLimit) {
  for (const double times : {2.0, 5.0, 10.0}) {
    Loop unguarded(times * passive_stiffness(GetParam()), GetParam(), false);
    Loop guarded(times * passive_stiffness(GetParam()), GetParam(), true);

    const double before = swing(unguarded);
    const double after = swing(guarded);

    EXPECT_GT(before, 0.5e-3) << times << ": without it the key shakes";
    EXPECT_LT(after, 0.04e-3) << times << ", before " << before;
    EXPECT_GT(guarded.damped, 0) << times;
  }
}

INSTANTIATE_TEST_SUITE_P(PassivityObserver, Delays,
                         ::testing::Values(0.0, 0.12, 0.33, 0.5, 0.9, 1.0, 1.4, 2.0, 2.7, 3.0));

TEST(PassivityObserver, SumsForceTimesTheWayThatFollowedIt) {
  PassivityObserver monitor{PassivitySettings{}};
  monitor.observe({}, {});

  monitor.observe({2.0, -1.0}, {0.003, 0.001});   // 6 mJ - 1 mJ
  monitor.observe({2.0, -1.0}, {0.001, -0.001});  // -4 mJ + 2 mJ

  EXPECT_NEAR(monitor.given_j(), 0.003, 1e-15);
  monitor.start();
  EXPECT_EQ(monitor.given_j(), 0.0);
}

TEST(PassivityObserver, DampsAgainstTheMotionAndNeverBeyondItsCap) {
  PassivitySettings settings;
  settings.active = true;
  settings.budget_j = 0.0;
  settings.mass_kg = 0.1;
  PassivityObserver monitor(settings);
  monitor.observe({}, {});

  monitor.observe({100.0}, {0.001});  // 0.1 J from nothing at 1 m/s

  ASSERT_TRUE(monitor.is_damping());
  EXPECT_DOUBLE_EQ(monitor.damping_n(0), 0.5 * 0.1 / 0.001 * 1.0);  // m/(2T) v
  EXPECT_EQ(monitor.damping_n(1), 0.0);
}

TEST(PassivityObserver, TakesBackWhatTheLoopHasMadeAndThenLeavesTheHandFree) {
  ForceGuardSettings settings = guarded(true);
  settings.passivity.travel_m = 1e-4;  // nearly nothing is allowed for the ramp
  ForceGuard guard(settings);
  AxisValues wanted{};
  AxisValues position{};
  double taken = 0.0;  // from the hand, less what it was given [J]
  const auto move_on = [&] {
    const double held = guard.accept(wanted) ? guard.tick(0.0, position)[0] : 0.0;
    position[0] += 1e-4;
    taken -= held * 1e-4;
  };
  wanted[0] = 10.0;
  for (int n = 0; n < 10; ++n) move_on();  // 10 mJ
  ASSERT_LT(taken, -0.005);

  wanted[0] = 0.0;  // as from a scene that is paused
  for (int n = 0; n < 20; ++n) move_on();
  EXPECT_TRUE(guard.energy().is_damping());
  for (int n = 0; n < 80; ++n) move_on();

  EXPECT_FALSE(guard.energy().is_damping());
  EXPECT_EQ(guard.tick(0.0, position)[0], 0.0);
  EXPECT_NEAR(taken, 0.0, 0.0003) << "what the largest is_damping takes in a period";
}

TEST(PassivityObserver, TakesTheRampOfAPressedSpringForNoEnergyOfTheLoop) {
  ForceGuardSettings settings = guarded(true);
  settings.ramp_s = 0.2;
  settings.passivity.budget_j = 0.0;
  ForceGuard guard(settings);
  const double stiffness = 500.0;
  double position = -0.02;
  int damped = 0;

  // Held in the spring while the forces grow, then led out of it: the hand takes all that it holds.
  for (int n = 0; n < 1000; ++n) {
    if (n > 300) position = std::min(0.0, position + 0.0001);
    AxisValues wanted{};
    wanted[0] = -stiffness * position;
    guard.accept(wanted);
    AxisValues positions{};
    positions[0] = position;
    guard.tick(0.0, positions);
    damped += guard.energy().is_damping();
  }

  EXPECT_GT(guard.energy().given_j(), 0.09);  // K x^2 / 2 = 0.1 J
  EXPECT_EQ(damped, 0);
}

TEST(PassivityObserver, DoesNotSaveMoreThanItsTank) {
  PassivitySettings settings;
  settings.active = true;
  settings.budget_j = 0.0;
  settings.tank_j = 0.005;
  PassivityObserver monitor(settings);
  monitor.observe({}, {});

  monitor.observe({-10.0}, {0.01});  // takes 100 mJ
  monitor.observe({1.0}, {0.014});   // gives 4 mJ
  EXPECT_FALSE(monitor.is_damping());
  monitor.observe({1.0}, {0.018});  // and 4 mJ more
  EXPECT_TRUE(monitor.is_damping());
}

TEST(PassivityObserver, RefusesSettingsOutOfRange) {
  PassivitySettings bad;
  bad.mass_kg = 0.0;
  EXPECT_THROW(PassivityObserver{bad}, std::invalid_argument);
}

}  // namespace
}  // namespace cordis::device
