// tests/gallery/sticking_balls_test.cpp
#include <cmath>

#include <gtest/gtest.h>

#include "sim_node/engine/connected_components.h"
#include "tests/gallery/stage.h"

namespace cordis::test {
namespace {

constexpr std::size_t kLump = 0;  // the set of the ball that is thrown and the crowd
constexpr double kMass = 0.02;

TEST(StickingBalls, GoOnAsOnePieceWithTheMomentumOfAll) {
  Stage stage("sticking_balls.yaml");
  engine::ConnectedComponents pieces(stage.world().network(), kLump);
  EXPECT_EQ(pieces.find_bound(stage.world().bound_pairs(kLump)), 6u);

  stage.play_until(3.5);  // all have met, the palm has not been reached
  EXPECT_EQ(pieces.find_bound(stage.world().bound_pairs(kLump)), 1u);
  const engine::Vec3 momentum = stage.world().momentum();
  EXPECT_NEAR(momentum.x(), 0.4 * kMass, 1.0e-12);
  EXPECT_NEAR(momentum.y(), 0.0, 1.0e-12);
  const double common = 0.4 / 6.0;
  for (std::uint32_t i = 0; i < 5; ++i) {
    EXPECT_NEAR(stage.velocity("crowd", i).x(), common, 0.3 * common) << i;  // it still shakes
  }
}

TEST(StickingBalls, StayOnTheHandThatCatchesThem) {
  Stage stage("sticking_balls.yaml");
  stage.play_until(8.0);
  EXPECT_EQ(stage.world().bound_pairs(1).empty(), false);  // palm and crowd
  const double palm = stage.position("palm").x();
  EXPECT_NEAR(palm, 0.26, 1.0e-6);
  for (std::uint32_t i = 0; i < 5; ++i) EXPECT_LT(stage.position("crowd", i).x(), palm) << i;
  EXPECT_LT(stage.velocity("crowd", 4).norm(), 1.0e-3);
}

}  // namespace
}  // namespace cordis::test
