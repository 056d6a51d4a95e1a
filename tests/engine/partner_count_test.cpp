// tests/engine/partner_count_test.cpp -- how many others a mass of a set touches.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/engine/balls.h"

namespace cordis::test {
namespace {

/// Others nearer to a member than `touch` says for the two.
template <class Touch>
std::uint32_t partners(const NetworkDescription& scene, const World& world, std::uint32_t member,
                       Touch touch) {
  std::uint32_t count = 0;
  for (std::uint32_t other = 0; other < scene.mats.size(); ++other) {
    const double distance = (world.position(other) - world.position(member)).norm();
    if (other != member && distance > 0.0 && distance < touch(member, other)) ++count;
  }
  return count;
}

/// Steps a set within all MATs and counts beside it, at every vector width.
template <class Touch>
void expect_counts(NetworkDescription scene, Touch touch) {
  std::uint32_t largest_ever = 0;
  for (const VectorWidth width : engine::supported_vector_widths()) {
    World world = make_world(scene, width);
    for (int n = 0; n < 40; ++n) {
      std::vector<std::uint32_t> expected;  // forces are of the positions before the step
      for (std::uint32_t m = 0; m < scene.mats.size(); ++m) {
        expected.push_back(partners(scene, world, m, touch));
      }
      world.step();
      std::uint32_t most = 0;
      for (std::uint32_t m = 0; m < expected.size(); ++m) {
        ASSERT_EQ(world.partners_of(0, m), expected[m])
            << "member " << m << " in step " << n << ", " << to_string(width);
        if (scene.mats[m].kind == MatKind::kMass) most = std::max(most, expected[m]);
      }
      EXPECT_EQ(world.largest_partners(0).of_p, most);
      EXPECT_EQ(world.largest_partners(0).of_q, 0u);
      largest_ever = std::max(largest_ever, most);
    }
  }
  EXPECT_GE(largest_ever, 3u);
}

TEST(PartnerCount, OfContactsCountsThePairsThatArePressed) {
  for (const int dimension : {1, 2, 3}) {
    NetworkDescription scene = cloud(60, dimension == 1 ? 2.0 : 0.3, 1.0, dimension);
    add_set(scene, contact(50.0, 0.0), 0.1, -1.0, static_cast<std::uint32_t>(scene.mats.size()));
    expect_counts(
        scene, [&](std::uint32_t a, std::uint32_t b) { return scene.radius[a] + scene.radius[b]; });
  }
}

TEST(PartnerCount, OfStatesCountsBoundPairsBeyondTheRangeToo) {
  NetworkDescription scene = cloud(40, 0.4, 0.0, 3);
  add_set(scene, contact(50.0, 0.0), 0.1, -1.0, static_cast<std::uint32_t>(scene.mats.size()));
  scene.state_machines[0].states[0].pulls = true;
  scene.state_machines[0].states.push_back(scene.state_machines[0].states[0]);  // never entered
  expect_counts(scene, [](std::uint32_t, std::uint32_t) { return 0.1; });
}

TEST(PartnerCount, OfLennardJonesCountsThePairsWithinTheInflection) {
  NetworkDescription scene = cloud(60, 0.3, 0.0, 3);
  add_set(scene, lennard_jones(1e-6, 0.06, 0.15), 0.15, -1.0, 60);
  const double touch = 0.06 * std::pow(26.0 / 7.0, 1.0 / 6.0);
  expect_counts(scene, [touch](std::uint32_t, std::uint32_t) { return touch; });
}

TEST(PartnerCount, OfTwoSetsIsThatOfTheirMassesAlone) {
  // A ball above a row of fixed points, five of which are in its reach.
  NetworkDescription scene;
  scene.dimension = 2;
  scene.step = 1e-4;
  scene.mats.push_back(mass(1.0, Vec3(0, 0.08, 0)));
  for (int i = -5; i <= 5; ++i) scene.mats.push_back(fixed(Vec3(0.025 * i, 0, 0)));
  scene.radius.assign(scene.mats.size(), 0.05);
  add_set(scene, contact(50.0, 0.0), 0.1, -1.0, 1);

  World world = make_world(scene);
  EXPECT_EQ(world.largest_partners(0).of_p, 5u) << "at the start";
  world.step();

  EXPECT_EQ(world.largest_partners(0).of_p, 5u);
  EXPECT_EQ(world.largest_partners(0).of_q, 0u);
  EXPECT_EQ(world.partners_of(0, 1 + 5), 1u) << "the fixed point below";
}

}  // namespace
}  // namespace cordis::test
