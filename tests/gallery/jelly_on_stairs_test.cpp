// tests/gallery/jelly_on_stairs_test.cpp
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/gallery/gallery_session.h"

namespace cordis::test {
namespace {

constexpr std::uint32_t kEdge = 5;     // balls along an edge of the jelly
constexpr double kWidth = 0.04;        // between the middles of its outer balls [m]
constexpr double kBallRadius = 0.005;  // [m]

/// The number of the first ball of the jelly.
std::uint32_t first_ball(const engine::NetworkDescription& network) {
  std::uint32_t first = 0;
  while (network.radius[first] != kBallRadius) ++first;
  return first;
}

/// How deep the deepest ball is in a surface [m].
double deepest(const engine::World& world) {
  const engine::NetworkDescription& network = world.network().description();
  double deepest = 0.0;
  for (const engine::Surface& surface : network.surfaces) {
    for (std::uint32_t i = 0; i < network.mats.size(); ++i) {
      if (network.radius[i] != kBallRadius) continue;
      const double distance =
          distance_from(surface, network.mats[surface.mat].position, world.position(i)).distance;
      deepest = std::max(deepest, kBallRadius - distance);
    }
  }
  return deepest;
}

TEST(JellyOnStairs, DropsFromStepToStepAndRestsOnTheLast) {
  GallerySession session("jelly_on_stairs.yaml");
  const engine::World& world = session.world();
  const engine::NetworkDescription& network = world.network().description();
  EXPECT_EQ(network.surfaces.size(), 7u);

  session.play_until(0.4);  // it stands on the landing
  EXPECT_NEAR(session.signal("middle_x"), 0.0, 1e-6);
  double deep = 0.0;
  double highest = session.signal("middle_y");
  session.play_until(6.0, [&] {
    deep = std::max(deep, deepest(world));
    ASSERT_LT(session.signal("middle_y"), highest + 0.02);
    highest = std::min(highest, session.signal("middle_y"));
  });

  EXPECT_LT(deep, 0.8 * kBallRadius);
  EXPECT_GT(session.signal("middle_x"), 0.27);
  EXPECT_LT(session.signal("middle_x"), 0.33);
  // the last step carries its whole weight
  const double weight = 125.0 * 0.001 * 9.81;
  EXPECT_NEAR(session.signal("last_step_force"), -weight, 0.001 * weight);
  // and it is a cube again
  const std::uint32_t first = first_ball(network);
  const double diagonal =
      (world.position(first + kEdge * kEdge * kEdge - 1) - world.position(first)).norm();
  EXPECT_NEAR(diagonal, std::sqrt(3.0) * kWidth, 0.02 * diagonal);
  EXPECT_LT(std::abs(session.energy_residual()), 1.0e-9);
}

}  // namespace
}  // namespace cordis::test
