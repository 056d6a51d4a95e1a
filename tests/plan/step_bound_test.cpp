// tests/plan/step_bound_test.cpp
#include "sim_node/plan/stability/step_bound.h"

#include <cmath>
#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "sim_node/plan/stability/partner_bound.h"
#include "sim_node/plan/stability/start_tangent.h"
#include "tests/plan/networks.h"

namespace cordis::test {
namespace {

using plan::certified_bound;
using plan::edge_bound;
using plan::liaison_graph;
using plan::LiaisonKind;

TEST(StepBound, LiesBelowTheLimitOfEveryNetworkAndTheRowsBringItNearer) {
  double worst = 1.0;
  for (unsigned seed = 0; seed < 40; ++seed) {
    const NetworkDescription scene = random_network(seed);
    const double edge = edge_bound(liaison_graph(scene)).step;
    const double certified = certified_bound(scene, liaison_graph(scene)).step;
    const double limit = plan::StartTangent(scene).diverging_step();

    EXPECT_LE(edge, certified * (1.0 + 1e-12)) << seed;
    EXPECT_LE(certified, limit * (1.0 + 1e-6)) << seed;
    worst = std::min(worst, certified / limit);
  }
  EXPECT_GT(worst, 0.75);  // odd rings, which the rows with all entries positive overrate
}

TEST(StepBound, OfALongChainIsItsLimit) {
  const NetworkDescription scene = string_in_space(100, 0.0, 1e-4);

  const double step = certified_bound(scene, liaison_graph(scene)).step;

  EXPECT_NEAR(step, std::sqrt(0.001 / 400.0), 1e-3 * step);
  EXPECT_LE(step, std::sqrt(0.001 / 400.0) / std::sin(100.0 * M_PI / 202.0));
}

TEST(StepBound, NamesTheMassThatMovesInWhatLimitsIt) {
  // A stiff string, and soft springs that hang from its middle to the end of the list of masses.
  NetworkDescription scene = string_in_space(10, 0.0, 1e-4);
  const auto of_string = static_cast<std::uint32_t>(scene.mats.size());
  const std::uint32_t middle = of_string / 2;
  for (std::uint32_t tail = 0; tail < 3; ++tail) {
    scene.mats.push_back(mass(0.05, Vec3(0.05, 0.03 * (1.0 + tail), 0)));
    const std::uint32_t from = tail == 0 ? middle : of_string + tail - 1;
    scene.links.push_back({from, of_string + tail, 3.0, 0.0, 0.03});
  }

  const plan::StepBound bound = certified_bound(scene, liaison_graph(scene));

  EXPECT_LT(bound.mat, of_string);
  ASSERT_TRUE(bound.liaison);
  EXPECT_EQ(bound.liaison->kind, LiaisonKind::kLink);
  EXPECT_LT(bound.liaison->index, scene.links.size() - 3);
}

/// A cube of 8 masses, every two of them joined at their distance, spinning about a slanted axis
/// and shivering a little.
NetworkDescription spinning_cube() {
  NetworkDescription scene;
  scene.dimension = 3;
  const Vec3 spin(3.0, 5.0, 2.0);  // [1/s]
  std::mt19937 random(5);
  const auto shiver = [&random] { return 1e-3 * (static_cast<double>(random()) / 4294967296.0); };
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 place(corner & 1 ? 0.1 : -0.1, corner & 2 ? 0.1 : -0.1, corner & 4 ? 0.1 : -0.1);
    scene.mats.push_back(mass(0.01, place, spin.cross(place) + Vec3(shiver(), shiver(), shiver())));
  }
  for (std::uint32_t a = 0; a < 8; ++a) {
    for (std::uint32_t b = a + 1; b < 8; ++b) {
      const double length = (scene.mats[b].position - scene.mats[a].position).norm();
      scene.links.push_back({a, b, 50.0, 0.0, length});
    }
  }
  return scene;
}

TEST(StepBound, HoldsWhateverPoseANetworkInSpaceTakes) {
  NetworkDescription scene = spinning_cube();
  scene.step = 1e-3;
  scene.step = 0.99 * certified_bound(scene, liaison_graph(scene)).step;

  World world = make_world(scene);
  const double before = world.energy().total();
  run(world, 20000);

  EXPECT_NEAR(world.energy().total(), before, 0.01 * before);
}

TEST(StepBound, NamesTheLightMassAndItsStiffLink) {
  NetworkDescription scene = string_in_space(30, 0.01, 1e-4);
  scene.mats[12].mass = 1e-5;
  scene.links[12].stiffness = 900.0;  // between 12 and 13

  for (const plan::StepBound& bound :
       {edge_bound(liaison_graph(scene)), certified_bound(scene, liaison_graph(scene))}) {
    EXPECT_EQ(bound.mat, 12u);
    ASSERT_TRUE(bound.liaison.has_value());
    EXPECT_EQ(bound.liaison->kind, LiaisonKind::kLink);
    EXPECT_EQ(bound.liaison->index, 12u);
  }
}

TEST(StepBound, TakesEveryLinkInItsStiffestState) {
  NetworkDescription scene = oscillator(0.1, 0.0, 0.0, 1.0, 0.0, 1e-3);
  scene.links.clear();
  scene.state_machines.emplace_back();
  scene.state_machines[0].states.resize(2);
  scene.state_machines[0].states[0].stiffness = 10.0;
  scene.state_machines[0].states[1].stiffness = 4000.0;
  scene.state_links = {{0, 1, 0, 0.0}};

  const plan::StepBound bound = certified_bound(scene, liaison_graph(scene));

  EXPECT_NEAR(bound.step, 2.0 * std::sqrt(0.1 / 4000.0), 1e-9);
  EXPECT_EQ(bound.liaison->kind, LiaisonKind::kStateLink);
}

TEST(StepBound, CountsTheMediumAlone) {
  NetworkDescription scene = oscillator(0.1, 0.0, 0.0, 1.0, 0.0, 1e-3);
  scene.medium_viscosity = 5.0;

  const plan::StepBound bound = certified_bound(scene, liaison_graph(scene));

  EXPECT_NEAR(bound.step, 2.0 * 0.1 / 5.0, 1e-12);  // 2 Z' < 4
  EXPECT_FALSE(bound.liaison.has_value());
}

TEST(StepBound, OfASetTakesAsManyContactsAsTouchAtOnce) {
  NetworkDescription scene;
  scene.dimension = 2;
  scene.step = 1e-3;
  scene.state_machines.push_back(contact(100.0));
  engine::SetLiaison paste;
  for (std::uint32_t i = 0; i < 30; ++i) {
    scene.mats.push_back(mass(0.01, Vec3(0.02 * i, 0, 0)));
    scene.radius.push_back(0.01);
    paste.set_p.push_back(i);
  }
  paste.range = 0.02;
  paste.rest_length = -1.0;
  scene.sets.push_back(paste);

  // Two balls, each with 6 contacts of 100 N/m: dt^2 (600 + 600) / 0.01 = 4.
  const plan::StepBound bound = certified_bound(scene, liaison_graph(scene));
  EXPECT_NEAR(bound.step, 2.0 * std::sqrt(0.01 / 1200.0), 1e-9);
  EXPECT_EQ(bound.liaison->kind, LiaisonKind::kSet);
}

TEST(MostNeighbours, AreTheKissingNumbersForEqualBallsAndMoreForSmallerOnes) {
  EXPECT_EQ(plan::max_neighbours(1, 0.01, 0.01), 2.0);
  EXPECT_EQ(plan::max_neighbours(2, 0.01, 0.01), 6.0);
  EXPECT_EQ(plan::max_neighbours(3, 0.01, 0.01), 12.0);
  EXPECT_EQ(plan::max_neighbours(2, 0.01, 0.02), 6.0);
  // asin(1/3) = 19.47 degrees, and 180 / 19.47 = 9.2
  EXPECT_EQ(plan::max_neighbours(2, 0.02, 0.01), 9.0);
  EXPECT_GE(plan::max_neighbours(3, 0.02, 0.01), 25.0);
}

}  // namespace
}  // namespace cordis::test
