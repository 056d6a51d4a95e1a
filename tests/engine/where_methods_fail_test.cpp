// tests/engine/where_methods_fail_test.cpp -- the smallest scene in which each integrator goes
// wrong while another does not. m = 1 and dt = 1: then K is K' and Z is Z'.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include <gtest/gtest.h>

#include "tests/engine/programs.h"
#include "tests/engine/scenes.h"
#include "tests/engine/surfaces.h"
#include "tests/support/rounds.h"

namespace cordis::test {
namespace {

using engine::IntegratorKind;

/// One mass on a spring and a damper that are those of a state, or linear.
NetworkDescription one_mass(double stiffness, double viscosity, bool of_state) {
  NetworkDescription scene = oscillator(1.0, stiffness, viscosity, 1.0, 0.0, 1.0);
  if (!of_state) return scene;
  scene.links.clear();
  scene.state_machines.push_back(Behaving().state(stiffness, viscosity).state_machine);
  scene.state_links = {{0, 1, 0, 0.0}};
  return scene;
}

double excursion_by(IntegratorKind integrator, NetworkDescription scene, int steps = 2000) {
  scene.integrator = integrator;
  return largest_excursion(std::move(scene), steps);
}

TEST(WhereMethodsFail, CordisOnAHeavyDamperWhereTheOthersHold) {
  const NetworkDescription scene = one_mass(0.1, 2.2, false);

  EXPECT_GT(excursion_by(IntegratorKind::kCordis, scene), 1e20);
  EXPECT_LT(excursion_by(IntegratorKind::kLeapfrog, scene), 1.5);
  EXPECT_LT(excursion_by(IntegratorKind::kImplicit, scene), 1.5);
  EXPECT_LT(excursion_by(IntegratorKind::kModal, scene), 1.5);
}

TEST(WhereMethodsFail, LeapfrogOnTheDamperOfASetWhereCordisHolds) {
  NetworkDescription scene = one_mass(0.5, 1.0, true);
  scene.mats[1].position.x() = 10.5;
  scene.state_links.clear();
  scene.sets = {{0, {0}, {1}, 1e300, 10.0}};

  EXPECT_GT(excursion_by(IntegratorKind::kLeapfrog, scene), 1e3);
  EXPECT_LT(excursion_by(IntegratorKind::kCordis, scene), 12.0);
}

TEST(WhereMethodsFail, CordisOnTheDamperOfAStateWhereLeapfrogHolds) {
  const NetworkDescription scene = one_mass(0.5, 2.0, true);

  EXPECT_GT(excursion_by(IntegratorKind::kCordis, scene), 1e3);
  EXPECT_LT(excursion_by(IntegratorKind::kLeapfrog, scene), 1.5);
}

TEST(WhereMethodsFail, EveryExplicitOneOnAStiffSpringWhereImplicitHolds) {
  const NetworkDescription scene = one_mass(100.0, 0.0, false);

  EXPECT_GT(excursion_by(IntegratorKind::kCordis, scene), 1e20);
  EXPECT_GT(excursion_by(IntegratorKind::kLeapfrog, scene), 1e20);
  EXPECT_GT(excursion_by(IntegratorKind::kSymplectic4, scene), 1e20);
  EXPECT_LT(excursion_by(IntegratorKind::kImplicit, scene), 1.0);
  EXPECT_LT(excursion_by(IntegratorKind::kModal, scene), 1.01);
}

TEST(WhereMethodsFail, ImplicitLetsDieWhatSwingsForeverWithTheOthers) {
  for (const IntegratorKind integrator :
       {IntegratorKind::kCordis, IntegratorKind::kLeapfrog, IntegratorKind::kSymplectic4,
        IntegratorKind::kImplicit, IntegratorKind::kModal}) {
    NetworkDescription scene = one_mass(0.01, 0.0, false);  // w dt = 0.1
    scene.integrator = integrator;
    World world = make_world(scene);
    run(world, 1000);
    double late = 0.0;
    for (int n = 0; n < 70; ++n) {
      world.step();
      late = std::max(late, std::abs(world.position(1).x()));
    }

    if (integrator == IntegratorKind::kImplicit) {
      EXPECT_LT(late, 0.01);  // e^(-0.005 n)
    } else {
      EXPECT_NEAR(late, 1.0, 0.01) << to_string(integrator);
    }
  }
}

/// Speed after a bounce on a wall that only pushes, for one of many moments of arrival.
double speed_after_bounce(double stiffness, double phase) {
  NetworkDescription scene = oscillator(1.0, 0.0, 0.0, 3.0 + phase, -1.0, 1.0);
  scene.links.clear();
  scene.state_machines.push_back(Behaving().state(stiffness).state_machine);
  scene.state_machines[0].states[0].pulls = false;
  scene.state_links = {{0, 1, 0, 0.0}};
  World world = make_world(scene);
  run(world, 30);
  return std::abs(world.velocity(1).x());
}

TEST(WhereMethodsFail, CordisOnAStiffContactThoughItIsStable) {
  // The energy after a bounce is between 1 - K'/4 and 1 / (1 - K'/4) of that before it.
  const auto largest_gain = [](double stiffness) {
    double most = 0.0;
    for (int i = 0; i < 100; ++i) {
      most = std::max(most, std::pow(speed_after_bounce(stiffness, 0.01 * i), 2.0));
    }
    return most;
  };

  EXPECT_GT(largest_gain(3.6), 5.0);
  EXPECT_LE(largest_gain(3.6), 10.0 * (1.0 + 1e-9));
  EXPECT_LE(largest_gain(0.04), 1.0 / 0.99 * (1.0 + 1e-9));
}

TEST(WhereMethodsFail, ModalNearItsNyquistFrequencyUnderALoadThatCordisBears) {
  // K' = 3.9 and 0.05 besides: 3.95 < 4; of the mode K' = 4 sin^2(w dt / 2), w dt = 3.1
  NetworkDescription scene = one_mass(9.61, 0.0, false);
  scene.state_machines.push_back(Behaving().state(0.05).state_machine);
  scene.state_links = {{0, 1, 0, 0.0}};
  EXPECT_GT(excursion_by(IntegratorKind::kModal, scene, 20000), 1e3);

  scene.links[0].stiffness = 3.9;
  EXPECT_LT(excursion_by(IntegratorKind::kCordis, scene, 20000), 20.0);
}

/// A block of 1 kg on a floor that presses with 10 N and rubs with 0.5, pushed along by 4 N: it stays.
constexpr double kLoad = 10.0;
constexpr double kMu = 0.5;
constexpr double kPush = 4.0;
constexpr int kStandstill = rounds(1'000'000);  // steps of 0.1 ms
constexpr double kHalf = 0.5e-4 * kStandstill;  // [s]

struct Standstill {
  double creep = 0.0;    // way of the second half [m]
  double chatter = 0.0;  // fastest in the last thousand steps [m/s]
};

Standstill standstill_of(NetworkDescription scene, std::uint32_t block, double load) {
  scene.step = 1e-4;
  World world = make_world(std::move(scene));
  Standstill still;
  const auto step = [&](double push) {
    world.set_external_force(block, Vec3(push, -load, 0.0));
    world.step();
  };
  for (int n = 0; n < kStandstill / 2; ++n) step(kPush * std::min(1.0, n / 20000.0));
  const double half = world.position(block).x();
  for (int n = kStandstill / 2; n < kStandstill; ++n) {
    step(kPush);
    if (n >= kStandstill - 1000)
      still.chatter = std::max(still.chatter, std::abs(world.velocity(block).x()));
  }
  still.creep = world.position(block).x() - half;
  return still;
}

/// Friction as a law of the speed, which grows to its limit up to a speed.
Standstill standstill_by_law(IntegratorKind integrator, double full_at) {
  NetworkDescription scene;
  scene.dimension = 1;
  scene.integrator = integrator;
  scene.mats = {fixed(Vec3::Zero()), mass(1.0, Vec3::Zero())};
  LinkState rubbing;
  rubbing.dissipation = engine::Table({-full_at, full_at}, {-kMu * kLoad, kMu * kLoad});
  scene.state_machines.push_back(Behaving().state(rubbing).state_machine);
  scene.state_links = {{0, 1, 0, 0.0}};
  return standstill_of(scene, 1, 0.0);
}

TEST(WhereMethodsFail, LawsOfTheSpeedCreepOrChatterWhereFrictionSticks) {
  // Stable with `cordis` where Z' = 5 N / full_at * dt / m < 2.
  const Standstill gentle = standstill_by_law(IntegratorKind::kCordis, 1e-3);
  EXPECT_NEAR(gentle.creep, 0.8e-3 * kHalf, 1e-6);
  EXPECT_LT(gentle.chatter, 0.81e-3);
  const Standstill steep = standstill_by_law(IntegratorKind::kCordis, 1e-5);
  EXPECT_GT(steep.chatter, 10.0 * 1e-5);
  const Standstill solved = standstill_by_law(IntegratorKind::kLeapfrog, 1e-5);
  EXPECT_NEAR(solved.creep, 0.8e-5 * kHalf, 1e-8);
  EXPECT_LT(solved.chatter, 0.81e-5);

  for (const double kinetic : {0.5, 0.3}) {
    constexpr double kFloorStiffness = 1e5;
    NetworkDescription scene;
    scene.dimension = 2;
    scene.mats = {mass(1.0, Vec3(0.0, 0.05 - kLoad / kFloorStiffness, 0.0))};
    scene.radius = {0.05};
    StateMachine touching = of_one_state(contact(kFloorStiffness, 100.0));
    touching.friction = {kMu, kinetic, kFloorStiffness, 300.0};
    const std::uint32_t floor = add_surface(scene, plane(Vec3::UnitY()), Vec3::Zero());
    touch(scene, 1, touching, 0.05, -1.0, {floor});
    const Standstill sticks = standstill_of(scene, 0, kLoad);
    EXPECT_LT(std::abs(sticks.creep), 1e-12) << kinetic;
    EXPECT_LT(sticks.chatter, 1e-12) << kinetic;
  }
}

}  // namespace
}  // namespace cordis::test
