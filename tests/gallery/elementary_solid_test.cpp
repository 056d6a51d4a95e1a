// tests/gallery/elementary_solid_test.cpp
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/gallery/gallery_session.h"

namespace cordis::test {
namespace {

/// Largest change of the length of a spring since the start, relative to it.
double deformation(const GallerySession& session) {
  const engine::NetworkDescription& network = session.world().network().description();
  double largest = 0.0;
  for (const engine::Link& link : network.links) {
    const double length =
        (session.world().position(link.mat_b) - session.world().position(link.mat_a)).norm();
    largest = std::max(largest, std::abs(length / link.rest_length - 1.0));
  }
  return largest;
}

TEST(ElementarySolid, KeepsItsShapeThroughTheFall) {
  GallerySession session("elementary_solid.yaml");
  session.play_until(0.1);  // before the landing
  EXPECT_LT(deformation(session), 1.0e-6);
  EXPECT_EQ(session.world().change_count(0, 0, 1), 0u);

  double largest = 0.0;
  session.play_until(3.0, [&] { largest = std::max(largest, deformation(session)); });
  EXPECT_GT(session.world().change_count(0, 0, 1), 4u);  // it has landed
  EXPECT_GT(largest, 0.005);                             // which has squeezed it
  EXPECT_LT(largest, 0.2);
  EXPECT_LT(deformation(session), 0.02);  // and it is a cube again
}

TEST(ElementarySolid, RestsOnTheStonesWithItsWholeWeight) {
  GallerySession session("elementary_solid.yaml");
  session.play_until(3.0);
  double force = 0.0;
  const scene::NamedRange bowl = session.mats("bowl");
  for (std::uint32_t i = 0; i < bowl.count; ++i) {
    force += session.world().link_force(bowl.first + i).y();
  }
  EXPECT_NEAR(force, -27 * 0.01 * 9.81, 0.05 * 27 * 0.01 * 9.81);
}

}  // namespace
}  // namespace cordis::test
