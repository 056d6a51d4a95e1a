// tests/sim/passivity_controller_test.cpp -- a hand that holds a simulated mass over a wire that is
// late.
#include "sim_node/devices/passivity_controller.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include <gtest/gtest.h>

#include "sim_node/devices/recent_peak.h"
#include "tests/engine/programs.h"
#include "tests/sim/hand_loop.h"
#include "tests/support/rounds.h"

namespace cordis::sim {
namespace {

TEST(RecentPeak, LastsOnceToTwiceItsMemory) {
  RecentPeak peak(3);
  for (const double value : {0.0, 0.0, 5.0, 1.0, 1.0, 1.0}) peak.enter(value);
  EXPECT_EQ(peak.value(), 5.0);  // three values ago
  peak.enter(2.0);
  EXPECT_EQ(peak.value(), 2.0);
}

class Late : public ::testing::TestWithParam<int> {};

TEST_P(Late, AHandUpToTenTimesTooStiffNoLongerSwings) {
  for (const double viscosity : {0.5, 5.0}) {
    for (const double times : {1.5, 3.0, 10.0}) {
      Hold hold{viscosity, GetParam(), times * viscosity / (GetParam() * kTick)};
      Loop damped(hold);
      hold.reports_work = false;
      Loop undamped(hold);

      EXPECT_GT(swing(undamped), 0.01) << viscosity << " " << times;
      EXPECT_LT(swing(damped), 1e-5) << viscosity << " " << times;
      EXPECT_GT(damped.passivity_ticks(), 0u);
    }
  }
}

TEST_P(Late, AHandWithinTheLimitIsNeverDamped) {
  constexpr double kTwoPi = 2.0 * std::numbers::pi;
  const std::function<double(double)> gestures[] = {
      [](double s) { return s < 1.0 ? 0.0 : 0.005; },                          // a jerk
      [](double s) { return 0.03 * std::sin(kTwoPi * s); },                    // to and fro
      [](double s) { return 0.002 * std::sin(kTwoPi * 8.0 * s) + 0.01 * s; },  // a tremor
      [](double s) { return 0.1 * s; }};  // a hand that pushes on
  for (const double viscosity : {2.0, 5.0}) {
    for (const int sub_steps : {1, 5}) {
      // What is held over a period is half a period older still when it is taken in parts.
      const double age = GetParam() + 0.5 * (1.0 - 1.0 / sub_steps);
      Hold hold{viscosity, GetParam(), 0.95 * viscosity / (age * kTick), sub_steps};
      for (std::size_t g = 0; g < std::size(gestures); ++g) {
        Loop loop(hold);
        for (int n = 0; n < test::rounds(6000); ++n) loop.tick(gestures[g](n * kTick));
        EXPECT_EQ(loop.passivity_ticks(), 0u) << viscosity << " " << sub_steps << " gesture " << g;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(PassivityController, Late, ::testing::Values(1, 2, 3));

TEST(PassivityController, KeepsToItselfWhenTheDeviceReportsNoWork) {
  Loop loop({5.0, 1, 10000.0, 1, false});

  swing(loop);

  EXPECT_EQ(loop.passivity_ticks(), 0u);
}

TEST(PassivityController, ForgetsWhatAMomentWithoutAnswersHasMade) {
  for (const int lost : {8, 15, 30}) {
    Loop loop({5.0, 1, 0.5 * 5.0 / kTick});
    const auto hand = [](int n) { return 0.03 * std::sin(2.0 * std::numbers::pi * n * kTick); };
    int n = 0;
    for (; n < 2000; ++n) loop.tick(hand(n));
    for (; n < 2000 + lost; ++n) loop.tick(hand(n), false);
    for (; n < 3000; ++n) loop.tick(hand(n));
    const std::uint64_t damped = loop.passivity_ticks();

    for (; n < 6000; ++n) loop.tick(hand(n));

    EXPECT_EQ(loop.passivity_ticks(), damped) << lost;
    EXPECT_LT(std::abs(loop.position() - hand(n)), 0.001);
  }
}

TEST(PassivityController, LetsGoOfAMassThatNobodyHolds) {
  Loop loop({5.0, 1, 10.0 * 5.0 / kTick});
  for (int n = 0; n < 1000; ++n) loop.tick(0.005);
  ASSERT_GT(loop.passivity_ticks(), 0u);
  for (int n = 0; n < 25; ++n) loop.live();  // the device is lost
  const std::uint64_t damped = loop.passivity_ticks();

  for (int n = 0; n < 100; ++n) loop.live();

  EXPECT_EQ(loop.passivity_ticks(), damped);
}

TEST(PassivityController, HoldsAMassOfManySmallStepsToo) {
  Loop loop({5.0, 2, 10.0 * 5.0 / (2.0 * kTick), 10});

  EXPECT_LT(swing(loop), 1e-5);
}

/// A wall that is felt through a liaison with states: nothing beyond it, K and Z when pressed.
scene::Scene wall_scene(double viscosity) {
  scene::Scene scene = bare_scene(1);
  const test::Term elongation = test::q(engine::Quantity::kElongation);
  scene.network.state_machines = {test::Behaving()
                                      .state(0.0)
                                      .exit(elongation > 0.0, 1)
                                      .state(200.0, viscosity)
                                      .exit(elongation < 0.0, 0)
                                      .state_machine};
  scene.network.state_machines[0].name = "contact";
  scene.network.state_links = {{1, 0, 0, -0.001}};  // the port is pressed in by 1 mm
  return scene;
}

TEST(PassivityController, AWallWithStatesTakesWhatItTakes) {
  constexpr double kViscosity = 5.0;
  Loop loop({0.0, 1, 0.85 * kViscosity / kTick}, wall_scene(kViscosity));

  for (int n = 0; n < 4000; ++n) loop.tick(n % 500 < 250 ? 0.02 : 0.015);

  EXPECT_EQ(loop.passivity_ticks(), 0u);
}

/// A mass on a damper of 0.1 m, which a hand has led to a quarter of a circle from its start.
Loop turned_loop(const Vec3& stiffness, bool damped = true) {
  constexpr double kLength = 0.1;
  scene::Scene scene = bare_scene(2);
  scene.network.mats[1].position = Vec3(-kLength, 0.0, 0.0);
  scene.network.links = {{0, 1, 0.0, 5.0, 0.0}};
  scene.network.medium_viscosity = 0.2;
  Loop loop({0.0, 1, 50.0, 1, damped}, scene);
  for (int n = 0; n <= 3000; ++n) {
    const double angle = 0.5 * std::numbers::pi * std::min(1.0, n / 2000.0);
    loop.tick({kLength * (std::cos(angle) - 1.0), kLength * std::sin(angle), 0.0});
  }
  loop.hold_with(stiffness);
  return loop;
}

TEST(PassivityController, AMassIsNotDampedAlongADamperThatHasTurned) {
  Loop loop = turned_loop(Vec3(50.0, 4000.0, 0.0));
  const std::uint64_t before = loop.passivity_ticks();

  for (int n = 0; n < 4000; ++n) loop.tick({-0.1, n % 500 < 250 ? 0.1 : 0.105, 0.0});

  EXPECT_EQ(loop.passivity_ticks(), before);
}

TEST(PassivityController, AMassIsDampedAcrossADamperThatHasTurned) {
  const Vec3 hand(-0.095, 0.1, 0.0);
  for (const bool damped : {false, true}) {
    Loop loop = turned_loop(Vec3(500.0, 50.0, 0.0), damped);
    swing_along(loop, hand, 0, 3000);
    const double swing = swing_along(loop, hand, 0, 1000);
    EXPECT_TRUE(damped ? swing < 0.001 : swing > 0.05) << swing;
  }
}

/// The port hangs on a spring on a mass, and that mass on a damper.
scene::Scene chain_scene(double stiffness, double between, double to_ground) {
  scene::Scene scene = bare_scene(1);
  scene.network.mats.push_back(mass_at(Vec3::Zero()));
  scene.network.links = {{0, 2, stiffness, between, 0.0}, {2, 1, 0.0, to_ground, 0.0}};
  return scene;
}

TEST(PassivityController, WhatIsTakenFarFromThePortCounts) {
  // k d T v^2 at the port against Z v^2 of a mass that goes with it.
  Loop loop({0.0, 1, 1000.0}, chain_scene(20000.0, 0.0, 4.0));

  for (int n = 0; n < 6000; ++n) loop.tick(n % 500 < 250 ? 0.0 : 0.005);

  EXPECT_EQ(loop.passivity_ticks(), 0u);
}

TEST(PassivityController, ADamperWhoseEndsGoTogetherTakesNothing) {
  for (const bool damped : {false, true}) {
    Loop loop({0.0, 1, 200.0, 1, damped}, chain_scene(5000.0, 5.0, 0.0));
    const double largest = swing(loop);
    // What the hand itself has given is left to it.
    EXPECT_TRUE(damped ? largest > 0.004 && largest < 0.0055 : largest > 0.02) << largest;
  }
}

TEST(PassivityController, AHandThatIsGivenEnergyByTheDelayIsDamped) {
  // Driven at w, the port sends m w^2 d T v^2 more than it is given, and Z takes Z v^2.
  const Hold hold{0.5, 1, 400.0};
  const double limit = std::sqrt(hold.viscosity / (kPortMass * hold.delay * kTick));
  for (const double share : {0.5, 0.9, 1.1, 2.0}) {
    const auto shake = [&](Loop& loop) {
      for (int n = 0; n < 4000; ++n) loop.tick(0.003 * std::sin(share * limit * n * kTick));
      const double before = loop.hand_work();
      for (int n = 0; n < 1000; ++n) loop.tick(0.003 * std::sin(share * limit * n * kTick));
      return loop.hand_work() - before;
    };
    Loop free({hold.viscosity, hold.delay, hold.stiffness, 1, false});
    EXPECT_EQ(shake(free) > 0.0, share < 1.0) << share;

    Loop damped(hold);
    shake(damped);
    EXPECT_EQ(damped.passivity_ticks() > 0, share > 1.0) << share;
  }
}

TEST(PassivityController, SamplesLateInBurstsDampNothing) {
  Loop loop({5.0, 1, 0.8 * 5.0 / kTick});

  for (int n = 0; n < 4000; ++n) {
    loop.tick(0.03 * std::sin(2.0 * std::numbers::pi * n * kTick), n % 400 < 385);
  }

  EXPECT_EQ(loop.passivity_ticks(), 0u);
}

TEST(PassivityController, KnowsWhatEveryIntegratorTakes) {
  for (const engine::IntegratorKind integrator :
       {engine::IntegratorKind::kCordis, engine::IntegratorKind::kLeapfrog,
        engine::IntegratorKind::kImplicit}) {
    for (const int sub_steps : {1, 5}) {
      for (const double times : {0.6, 2.0}) {
        Hold hold{5.0, 1, times * 5.0 / kTick, sub_steps};
        scene::Scene scene = scene_of(hold);
        scene.network.integrator = integrator;
        Loop loop(hold, scene);
        EXPECT_LT(swing(loop), 1e-5);
        EXPECT_EQ(loop.passivity_ticks() > 0, times > 1.0) << sub_steps;
      }
    }
  }
}

TEST(PassivityController, TwoHandsThatSwingAtOnceAreBothDamped) {
  for (const bool damped : {false, true}) {
    scene::Scene scene = bare_scene(1);
    scene.network.mats.push_back(mass_at(Vec3::Zero()));
    scene.network.links = {{0, 1, 0.0, 5.0, 0.0}, {2, 1, 0.0, 5.0, 0.0}};
    scene.ports.push_back(scene.ports.front());
    scene.ports.back().device = "other key";
    scene.ports.back().device_id = 10;
    scene.ports.back().mat = 2;
    Loop loop({0.0, 1, 3.0 * 5.0 / kTick, 1, damped}, scene);
    const double largest = swing(loop);
    EXPECT_TRUE(damped ? largest < 1e-5 : largest > 0.005) << largest;
  }
}

TEST(PassivityController, AHandThatGrowsStiffAfterLongPlayIsDampedUntilItIsSoftAgain) {
  Loop loop({2.0, 1, 500.0});
  for (int n = 0; n < 4000; ++n) loop.tick(0.3 * std::sin(0.01 * n));
  for (int n = 0; n < 3000; ++n) loop.tick(0.0);
  ASSERT_EQ(loop.passivity_ticks(), 0u);

  loop.hold_with(Vec3(6000.0, 0.0, 0.0));
  EXPECT_LT(swing_along(loop, Vec3(0.0002, 0.0, 0.0), 0, 2000), 0.0125);
  for (int n = 0; n < 3000; ++n) loop.tick(0.03 * std::sin(0.01 * n));
  EXPECT_GT(loop.passivity_ticks(), 2000u);

  loop.hold_with(Vec3(500.0, 0.0, 0.0));
  for (int n = 3000; n < 4000; ++n) loop.tick(0.03 * std::sin(0.01 * n));
  const std::uint64_t of_soft = loop.passivity_ticks();
  for (int n = 4000; n < 6000; ++n) loop.tick(0.03 * std::sin(0.01 * n));
  EXPECT_EQ(loop.passivity_ticks(), of_soft);
}

TEST(PassivityController, WhatALawTakesAndGivesBackCountsOnce) {
  for (const bool damped : {false, true}) {
    scene::Scene scene = bare_scene(1);
    engine::StateMachine state_machine;
    state_machine.name = "hidden";
    state_machine.states.resize(1);
    // a spring that the engine does not know for one
    state_machine.states[0].elasticity =
        test::expression_law(2000.0 * test::q(engine::Quantity::kElongation));
    scene.network.state_machines = {state_machine};
    scene.network.links = {{0, 1, 0.0, 0.5, 0.0}};
    scene.network.state_links = {{0, 1, 0, 0.0}};
    Loop loop({0.0, 1, 1000.0, 1, damped}, scene);
    for (int n = 0; n < 4000; ++n) loop.tick(0.005);
    const double swing = swing_along(loop, Vec3(0.005, 0.0, 0.0), 0, 1000);
    EXPECT_TRUE(damped ? swing < 0.001 : swing > 0.01) << swing;
  }
}

TEST(PassivityController, DampsAlongTheAxesOfTheDeviceAlone) {
  scene::Scene scene = bare_scene(2);
  scene.network.mats[0].velocity = Vec3(0.0, 0.2, 0.0);
  scene.network.mats[1].position = Vec3(-1000.0, 0.0, 0.0);  // the damper stays along x
  scene.network.links = {{0, 1, 0.0, 0.5, 0.0}};
  scene.ports[0].axes.pop_back();
  scene.ports[0].directions.pop_back();
  Loop loop({0.0, 1, 1500.0}, scene);
  for (int n = 0; n < 3000; ++n) loop.tick(0.005);

  EXPECT_GT(loop.passivity_ticks(), 0u);
  EXPECT_NEAR(loop.place().y(), 3.0 * 0.2, 0.001);
}

/// A damper to a mass of 0.3 kg has the Z' of 1.5 at the port: 2 more would pass the limit K' + 2 Z' < 4 of the scheme.
TEST(PassivityController, DampsNothingThatADamperWouldMakeUnstable) {
  scene::Scene scene = bare_scene(1);
  scene.network.mats.push_back(mass_at(Vec3::Zero(), 0.3));
  scene.network.links = {{0, 2, 0.0, 1.5 * kPortMass / kTick, 0.0}};
  Loop watched({0.0, 8, 100.0}, scene);
  Loop free({0.0, 8, 100.0, 1, false}, scene);
  double farthest = 0.0;
  for (int n = 0; n < 5000; ++n) {
    const double hand = n < 1000 ? 0.0 : 0.005;
    watched.tick(hand);
    free.tick(hand);
    farthest = std::max(farthest, std::abs(free.position() - hand));
    ASSERT_NEAR(watched.position(), free.position(), 1e-12) << n;
  }
  EXPECT_GT(farthest, 0.02) << "what the delay makes lets it swing ever more";
}

}  // namespace
}  // namespace cordis::sim
