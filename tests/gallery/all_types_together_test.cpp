// tests/gallery/all_types_together_test.cpp
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include <gtest/gtest.h>

#include "tests/gallery/gallery_session.h"

namespace cordis::test {
namespace {

/// The largest distance between two balls of a body [m].
double width_of(const GallerySession& session, const std::string& body) {
  double width = 0.0;
  const std::uint32_t count = session.mats(body).count;
  for (std::uint32_t a = 0; a < count; ++a) {
    for (std::uint32_t b = 0; b < a; ++b)
      width = std::max(width, (session.position(body, a) - session.position(body, b)).norm());
  }
  return width;
}

TEST(AllTypesTogether, RigidBodyIsGraspedAndBreaksThroughToTheOthers) {
  GallerySession session("all_types_together.yaml");
  const double rigid = width_of(session, "rigid");
  const double deformable = width_of(session, "deformable");
  session.play_until(0.75);
  EXPECT_GE(session.signal("held"), 2.0) << "the operator holds the rigid body";
  EXPECT_EQ(session.signal("shards"), 1.0);

  double blow = 0.0;
  session.play_until(2.0, [&] { blow = std::max(blow, session.signal("blow")); });
  EXPECT_GT(session.signal("rigid_y"), 0.0);
  EXPECT_GE(session.signal("shards"), 3.0) << "rupture";
  EXPECT_GT(blow, 0.05) << "it has met the plate";

  session.play_until(6.0);
  EXPECT_GE(session.signal("stuck"), 3.0) << "collage";
  EXPECT_NEAR(width_of(session, "rigid"), rigid, 0.01 * rigid);
  EXPECT_NEAR(width_of(session, "deformable"), deformable, 0.1 * deformable);
  EXPECT_LT(std::abs(session.energy_residual()), 1.0e-9);
}

}  // namespace
}  // namespace cordis::test
