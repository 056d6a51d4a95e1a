// tests/plan/reach_limit_test.cpp -- the energy and speed up to which a step is certified.
#include "sim_node/plan/reach_limit.h"

#include <cmath>

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

TEST(ReachLimit, OfASetIsTheEnergyOfAPair) {
  NetworkDescription scene;
  scene.dimension = 2;
  scene.step = 1e-4;
  scene.state_machines.push_back(state_machine(0.0, engine::LennardJones{0.01, 0.1, 0.3}));
  engine::SetLiaison set;
  for (std::uint32_t i = 0; i < 3; ++i) {
    set.set_p.push_back(i);
    scene.mats.push_back(mass(0.1, Vec3(0.11225 * i, 0, 0)));
  }
  set.range = 0.3;
  scene.sets.push_back(set);
  const ReachLimit limit = plan::reach_limit(scene);
  EXPECT_FALSE(limit.is_infinite());
  EXPECT_TRUE(std::isfinite(limit.pair_energy));
  EXPECT_GT(limit.pair_energy, 0.0);
  EXPECT_TRUE(std::isinf(limit.energy)) << "no link has such a law";
}

}  // namespace
}  // namespace cordis::test
