// tests/gallery/sticking_balls_test.cpp
#include <cmath>

#include <gtest/gtest.h>

#include "sim_node/engine/connected_components.h"
#include "tests/gallery/gallery_session.h"

namespace cordis::test {
namespace {

constexpr std::size_t kLump = 0;  // the set of the ball that is thrown and the crowd
constexpr double kBallMass = 0.02;

TEST(StickingBalls, GoOnAsOnePieceWithTheMomentumOfAll) {
  GallerySession session("sticking_balls.yaml");
  engine::ConnectedComponents pieces(session.world().network(), kLump);
  EXPECT_EQ(pieces.find_bound(session.world().bound_pairs(kLump)), 6u);

  session.play_until(3.5);  // all have met, the palm has not been reached
  EXPECT_EQ(pieces.find_bound(session.world().bound_pairs(kLump)), 1u);
  const engine::Vec3 momentum = session.world().momentum();
  EXPECT_NEAR(momentum.x(), 0.4 * kBallMass, 1.0e-12);
  EXPECT_NEAR(momentum.y(), 0.0, 1.0e-12);
  const double common = 0.4 / 6.0;
  for (std::uint32_t i = 0; i < 5; ++i) {
    EXPECT_NEAR(session.velocity("crowd", i).x(), common, 0.3 * common) << i;  // it still shakes
  }
}

TEST(StickingBalls, StayOnTheHandThatCatchesThem) {
  GallerySession session("sticking_balls.yaml");
  session.play_until(8.0);
  EXPECT_EQ(session.world().bound_pairs(1).empty(), false);  // palm and crowd
  const double palm = session.position("palm").x();
  EXPECT_NEAR(palm, 0.26, 1.0e-6);
  for (std::uint32_t i = 0; i < 5; ++i) EXPECT_LT(session.position("crowd", i).x(), palm) << i;
  EXPECT_LT(session.velocity("crowd", 4).norm(), 1.0e-3);
}

}  // namespace
}  // namespace cordis::test
