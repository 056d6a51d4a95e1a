// tests/plan/reach_limit_test.cpp -- the energy and speed up to which a step is certified.
#include "sim_node/plan/reach_limit.h"

#include <gtest/gtest.h>

#include "tests/plan/networks.h"

namespace cordis::test {
namespace {

using plan::is_beyond;
using plan::ReachLimit;

/// Three masses of 2 kg in flight, with 9, 4 and 1 J, and a port that moves at 1 m/s.
World in_flight() {
  NetworkDescription scene;
  scene.dimension = 3;
  scene.step = 1e-3;
  int i = 0;
  for (const double speed : {3.0, 2.0, 1.0}) {
    scene.mats.push_back(mass(2.0, Vec3(0, i++, 0)));
    scene.mats.back().velocity = Vec3(speed, 0, 0);
  }
  scene.mats.push_back({engine::MatKind::kPort, 0.0, Vec3(5, 0, 0)});
  World world = make_world(scene);
  for (int n = 1; n <= 3; ++n) {
    world.impose_position(3, Vec3(5.0 + 1e-3 * n, 0, 0));
    world.step();
  }
  return world;
}

TEST(ReachLimit, IsPassedByEnergySpeedOrTheTwoMatsOfMostEnergy) {
  const World world = in_flight();
  const engine::Energy energy = world.energy();
  ASSERT_NEAR(energy.kinetic, 14.0, 1e-9);
  EXPECT_FALSE(is_beyond({.energy = 14.1}, world, energy));
  EXPECT_TRUE(is_beyond({.energy = 13.9}, world, energy));
  EXPECT_FALSE(is_beyond({.pair_energy = 13.1}, world, energy)) << "9 and 4 J";
  EXPECT_TRUE(is_beyond({.pair_energy = 12.9}, world, energy));
  EXPECT_FALSE(is_beyond({.speed = 1.01, .energy = 20.0}, world, energy));
  EXPECT_TRUE(is_beyond({.speed = 0.99, .energy = 20.0}, world, energy)) << "the port";
}

TEST(ReachLimit, CountsStoredEnergyForTheWholeSceneAndNoneBelowNothing) {
  const World world = in_flight();
  engine::Energy energy = world.energy();
  energy.elastic = 5.0;
  EXPECT_TRUE(is_beyond({.energy = 18.9}, world, energy));
  EXPECT_FALSE(is_beyond({.energy = 19.1}, world, energy));
  energy.elastic = -5.0;
  EXPECT_TRUE(is_beyond({.energy = 13.9}, world, energy)) << "14 J of motion";
}

TEST(ReachLimit, IsNeverPassedWhereThereIsNone) {
  const World world = in_flight();
  engine::Energy energy = world.energy();
  energy.kinetic = 1e300;
  EXPECT_TRUE(ReachLimit{}.is_infinite());
  EXPECT_FALSE(is_beyond(ReachLimit{}, world, energy));
  EXPECT_FALSE(is_beyond({.speed = 0.1}, world, energy)) << "a speed alone certifies nothing";
}

}  // namespace
}  // namespace cordis::test
