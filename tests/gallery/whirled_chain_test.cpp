// tests/gallery/whirled_chain_test.cpp
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "tests/gallery/gallery_session.h"

namespace cordis::test {
namespace {

/// The end of a rod, in the frame that turns with the crank: along it, and how far from the axis.
struct Place {
  double along = 0.0;
  double away = 0.0;
};

Place place_of(const GallerySession& session, const std::string& rod, std::uint32_t end) {
  const engine::Vec3 crank = session.position("crank");
  const engine::Vec3 place = session.position(rod, end);
  const double radius = std::hypot(crank.x(), crank.z());
  return {(place.x() * crank.x() + place.z() * crank.z()) / radius,
          std::hypot(place.x(), place.z())};
}

TEST(WhirledChain, HangsInItsSecondMode) {
  GallerySession session("whirled_chain.yaml");
  session.play_until(30.0);
  // One bow to the other side of the axis, and the tip on the side of the crank: one knot.
  const Place middle = place_of(session, "rods[8].ends", 0);
  const Place tip = place_of(session, "rods[15].ends", 1);
  EXPECT_GT(middle.away, 0.02);
  EXPECT_GT(tip.away, 0.02);
  const engine::Vec3 middle_place = session.position("rods[8].ends", 0);
  const engine::Vec3 tip_place = session.position("rods[15].ends", 1);
  EXPECT_LT(middle_place.x() * tip_place.x() + middle_place.z() * tip_place.z(), 0.0);

  // It turns as one body: a turn of the crank later it is where it was.
  session.play_until(30.0 + 5.0 / 1.6);
  EXPECT_NEAR(session.position("rods[15].ends", 1).x(), tip_place.x(), 0.1 * tip.away);
  EXPECT_NEAR(session.position("rods[15].ends", 1).z(), tip_place.z(), 0.1 * tip.away);
  // Each rod keeps its length: K is 1e5 times the weight of the chain over a rod.
  const double rod =
      (session.position("rods[3].ends", 1) - session.position("rods[3].ends", 0)).norm();
  EXPECT_NEAR(rod, 0.05, 2e-4);
  EXPECT_LT(std::abs(session.energy_residual()), 1.0e-9);
}

}  // namespace
}  // namespace cordis::test
