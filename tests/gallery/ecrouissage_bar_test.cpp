// tests/gallery/ecrouissage_bar_test.cpp
#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/gallery/gallery_session.h"

namespace cordis::test {
namespace {

constexpr std::size_t kFlowing = 1;
constexpr std::size_t kBroken = 3;
constexpr double kHardenedLength = 0.1;

TEST(EcrouissageBar, GrowsHarderAndLongerWithEveryPullUntilItBreaks) {
  GallerySession session("ecrouissage_bar.yaml");
  const std::array<double, 4> pull_begins = {0.0, 1.8, 3.8, 5.8};
  const std::array<double, 3> pull_ends = {1.8, 3.8, 5.8};
  std::array<double, 4> flow_force{};  // at which the first liaison flows in a pull
  std::array<double, 3> peak_force{};  // of a pull
  std::array<double, 3> remanent{};    // after it
  for (std::size_t pull = 0; pull < 4; ++pull) {
    EXPECT_NEAR(session.time_s(), pull_begins[pull], 1.0e-6);
    session.play_until(pull < 3 ? pull_ends[pull] : 6.9, [&] {
      const double force = std::abs(session.signal("hand_force"));
      if (pull < 3) peak_force[pull] = std::max(peak_force[pull], force);
      if (flow_force[pull] == 0.0 && session.world().state_of(0) == kFlowing) {
        flow_force[pull] = force;
      }
    });
    if (pull < 3) remanent[pull] = session.position("bar", 4).x() - kHardenedLength;
  }

  EXPECT_NEAR(flow_force[0], 2.0, 0.2);  // yield 1 mm, 2000 N/m
  for (std::size_t pull = 1; pull < 4; ++pull) {
    EXPECT_GT(flow_force[pull], flow_force[pull - 1] + 0.2) << pull;
    EXPECT_NEAR(flow_force[pull], peak_force[pull - 1], 0.1 * peak_force[pull - 1]) << pull;
  }
  EXPECT_GT(remanent[0], 0.01);
  EXPECT_GT(remanent[1], remanent[0] + 0.005);
  EXPECT_GT(remanent[2], remanent[1] + 0.005);
}

TEST(EcrouissageBar, BreaksAtItsFlawAlone) {
  GallerySession session("ecrouissage_bar.yaml");
  session.play_until(5.8);
  const engine::World& world = session.world();
  const std::uint32_t flaw = 3;  // state links: three before it, one behind, the thread
  EXPECT_NE(world.state_of(flaw), kBroken);

  session.play_until(9.0);
  EXPECT_EQ(world.state_of(flaw), kBroken);
  for (const std::uint32_t whole : {0u, 1u, 2u, 4u}) EXPECT_NE(world.state_of(whole), kBroken);
  EXPECT_NEAR(session.signal("hand_force"), 0.0, 1.0e-9);
}

}  // namespace
}  // namespace cordis::test
