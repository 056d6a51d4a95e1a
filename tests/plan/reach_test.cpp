// tests/plan/reach_test.cpp -- how far a scene may go, from figures worked out by hand.
#include "sim_node/plan/stability/reach.h"

#include <gtest/gtest.h>

#include "tests/plan/networks.h"

namespace cordis::test {
namespace {

using plan::Reach;
using plan::reach_of;

/// 2 kg at 3 m/s and 1 kg at rest, 5 m apart, in a field of 10 m/s^2.
NetworkDescription two_masses() {
  NetworkDescription scene;
  scene.dimension = 2;
  scene.step = 1e-3;
  scene.gravity = Vec3(0, -10, 0);
  scene.mats.push_back(mass(2.0, Vec3(0, 0, 0)));
  scene.mats.push_back(mass(1.0, Vec3(3, 4, 0)));
  scene.mats[0].velocity = Vec3(3, 0, 0);
  return scene;
}
constexpr double kMotion = 9.0;       // 2 kg * (3 m/s)^2 / 2
constexpr double kFall = 10.0 * 4.0;  // of the upper one, to the bottom of the box about the masses
constexpr double kFallOfHeld = 30.0 * 5.0;  // both along its diagonal

TEST(Reach, HasTheEnergyOfMotionAndOfAFallThroughTheScene) {
  const Reach reach = reach_of(two_masses());
  EXPECT_DOUBLE_EQ(reach.brought, kMotion + kFall);
  EXPECT_DOUBLE_EQ(reach.energy, 18.0) << "two that meet";
  EXPECT_DOUBLE_EQ(reach.speed, 3.0);
  EXPECT_DOUBLE_EQ(reach.force, 30.0);
  EXPECT_EQ(reach.pushed, 0.0);

  const Reach wider = reach_of(two_masses(), 4.0);
  EXPECT_DOUBLE_EQ(wider.brought, 4.0 * (kMotion + kFall));
  EXPECT_DOUBLE_EQ(wider.energy, 72.0);
  EXPECT_DOUBLE_EQ(wider.speed, 6.0);
}

TEST(Reach, HasWhatLinksOfEachKindStoreAtTheStart) {
  NetworkDescription spring = two_masses();
  spring.links.push_back({0, 1, 1000.0, 0.0, 4.8});
  EXPECT_NEAR(reach_of(spring).brought - kMotion - kFallOfHeld, 20.0, 1e-9);

  NetworkDescription maxwell = two_masses();
  maxwell.maxwell_links.push_back({0, 1, 50.0, 1.0, 10.0});
  EXPECT_NEAR(reach_of(maxwell).brought - kMotion - kFallOfHeld, 1.0, 1e-9);

  NetworkDescription states = two_masses();
  states.state_machines.push_back(state_machine(1000.0));
  states.state_links.push_back({0, 1, 0, 4.9});
  EXPECT_NEAR(reach_of(states).brought - kMotion - kFallOfHeld, 5.0, 1e-6);
  EXPECT_DOUBLE_EQ(reach_of(states).elongation, 5.0);

  NetworkDescription rubbing = two_masses();
  rubbing.state_machines.push_back(state_machine(1000.0));
  rubbing.state_machines[0].friction = {0.5, 0.5, 400.0, 0.0};
  engine::SetLiaison touching;
  touching.range = touching.rest_length = 1.0;
  touching.set_p = {0, 1};
  touching.stretches = {{0, 1, false, Vec3(0.3, 0.4, 0.0)}};
  rubbing.sets = {touching};
  EXPECT_NEAR(reach_of(rubbing).brought - kMotion - kFall, 50.0, 1e-9);

  NetworkDescription bend = two_masses();
  bend.mats.push_back(mass(1.0, Vec3(3, 0, 0)));
  engine::Bend corner;  // a right angle that is straight at rest: w^2 = 2
  corner.mat_a = 0;
  corner.mat_b = 2;
  corner.mat_c = 1;
  corner.stiffness = 7.0;
  corner.length_ab = 3.0;
  corner.length_bc = 4.0;
  bend.bends.push_back(corner);
  EXPECT_NEAR(reach_of(bend).brought - kMotion - 40.0 * 5.0, 7.0, 1e-9);
}

TEST(Reach, HasTheWorkOfADrivenForceThroughTheScene) {
  NetworkDescription scene = two_masses();
  engine::TimeFunction function;
  function.time = {0.0, 0.1, 0.2};
  function.value = {Vec3::Zero(), Vec3(0, -7, 0), Vec3(2, 0, 0)};
  scene.time_functions.push_back(function);
  scene.drives.push_back({1, 0, true});
  const Reach reach = reach_of(scene, 2.0);
  EXPECT_NEAR(reach.pushed, 2.0 * 7.0 * 5.0, 1e-9);
  EXPECT_NEAR(reach.force, 37.0, 1e-9);
  EXPECT_NEAR(reach.brought, 2.0 * (kMotion + kFall) + reach.pushed, 1e-9);
}

TEST(Reach, BetweenTwoMatsHasTheirMassesAndAllTheEnergy) {
  const NetworkDescription scene = two_masses();
  const Reach reach = plan::reach_of_link(reach_of(scene), scene, 0, 1);
  EXPECT_DOUBLE_EQ(reach.inverse_mass, 1.5);
  EXPECT_DOUBLE_EQ(reach.energy, kMotion + kFall);
  EXPECT_EQ(reach.mass_a.low, 2.0);
  EXPECT_EQ(reach.mass_a.high, 2.0);
  EXPECT_EQ(reach.mass_b.high, 1.0);
  EXPECT_FALSE(reach.held);
  EXPECT_NEAR(plan::energy_at(reach), 1.01 * (kMotion + kFall + 2.0 * 9.0 / 1.5), 1e-9);
}

TEST(Reach, BetweenGroupsHasTheRangeOfTheirMassesAndKnowsAPort) {
  NetworkDescription scene = two_masses();
  scene.mats.push_back({engine::MatKind::kPort, 0.0, Vec3(0, 1, 0)});
  const Reach reach = plan::reach_between(reach_of(scene), scene, {0, 1}, {2});
  EXPECT_EQ(reach.mass_a.low, 1.0);
  EXPECT_EQ(reach.mass_a.high, 2.0);
  EXPECT_EQ(reach.mass_b.high, 0.0) << "a port has none";
  EXPECT_DOUBLE_EQ(reach.inverse_mass, 1.0) << "that of the lighter one";
  EXPECT_TRUE(reach.held);
  EXPECT_DOUBLE_EQ(reach.energy, kFall) << "that of the upper body";
}

TEST(Reach, BetweenGroupsHasTheEnergyOfTwoBodiesAndAllThatLinksStore) {
  NetworkDescription scene = two_masses();
  scene.gravity = Vec3::Zero();
  for (int i = 2; i < 12; ++i) {
    scene.mats.push_back(mass(2.0, Vec3(0.3 * i, 4, 0)));
    scene.mats[i].velocity = Vec3(3, 0, 0);
  }
  scene.state_machines = {state_machine(0.0)};
  engine::SetLiaison set;
  set.set_p = {0, 1, 2};
  set.set_q = {3, 4};
  scene.sets.push_back(set);
  const auto energy_of = [&] {
    return plan::reach_between(reach_of(scene), scene, set.set_p, set.set_q).energy;
  };
  EXPECT_NEAR(energy_of(), 2.0 * kMotion, 1e-9) << "each is a body of its own";
  scene.links.push_back({2, 3, 0.0, 1.0, 0.0});
  EXPECT_NEAR(energy_of(), 3.0 * kMotion, 1e-9) << "a body of two and one of one";
  scene.links.push_back({0, 1, 1000.0, 0.0, 4.9});
  EXPECT_NEAR(energy_of(), 3.0 * kMotion + 5.0, 1e-9) << "and a spring";
}

TEST(EnergyShare, IsThatOfWhatLinksAndPairsJoin) {
  NetworkDescription scene;
  scene.dimension = 1;
  for (int i = 0; i < 6; ++i) scene.mats.push_back(mass(1.0, Vec3(i, 0, 0)));
  scene.mats.push_back(fixed(Vec3(9, 0, 0)));
  scene.mats.push_back({engine::MatKind::kPort, 0.0, Vec3(8, 0, 0)});
  scene.mats[0].velocity = Vec3(2, 0, 0);   // 2 J
  scene.mats[1].velocity = Vec3(-4, 0, 0);  // 8 J
  scene.mats[2].velocity = Vec3(1, 0, 0);   // 0.5 J
  scene.links.push_back({0, 1, 0.0, 1.0, 0.0});
  scene.links.push_back({3, 6, 1.0, 0.0, 6.0});
  engine::SetLiaison set;
  set.set_p = {2, 6};
  set.set_q = {1, 3};
  scene.sets.push_back(set);
  set.set_p = {6};
  set.set_q = {4, 5};
  scene.sets.push_back(set);
  set.set_p = {7};
  set.set_q = {5};
  scene.sets.push_back(set);

  const auto shares =
      plan::energy_shares(scene, {1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0, 128.0}, /*port_speed=*/3.0);

  for (const int mat : {0, 1, 2, 3}) {
    EXPECT_EQ(shares[mat].of_bodies, 10.5) << mat;
    EXPECT_EQ(shares[mat].stored, 15.0) << mat;
    EXPECT_EQ(shares[mat].struck, 0.0) << mat;
  }
  EXPECT_EQ(shares[4].of_bodies, 0.0) << "both touch what is fixed, and not each other";
  EXPECT_EQ(shares[4].stored, 16.0);
  EXPECT_EQ(shares[5].stored, 32.0);
  EXPECT_EQ(shares[5].struck, 18.0) << "at twice the speed of the port";
}

}  // namespace
}  // namespace cordis::test
