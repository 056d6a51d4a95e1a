// tests/gallery/plastic_bar_test.cpp
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/gallery/gallery_session.h"

namespace cordis::test {
namespace {

constexpr double kLinks = 10.0;
constexpr double kStiffness = 2000.0;
constexpr double kYield = 0.001;
constexpr double kPlasticLength = 0.2;

TEST(PlasticBar, KeepsAllOfAPullButTheElasticPart) {
  GallerySession session("plastic_bar.yaml");
  double longest = 0.0;
  double force = 0.0;
  const auto watch = [&] {
    longest = std::max(longest, session.signal("end"));
    force = std::max(force, std::abs(session.signal("hand_force")));
  };
  session.play_until(3.4, watch);
  const double first = session.signal("end");
  EXPECT_NEAR(first, longest - kLinks * kYield, 2.0e-5);
  EXPECT_NEAR(force, kStiffness * kYield, 0.05);  // and what the air and the liaisons take at speed
  EXPECT_NEAR(session.velocity("bar", 10).norm(), 0.0, 1.0e-6);

  session.play_until(7.0, watch);
  EXPECT_NEAR(session.signal("end"), longest - kLinks * kYield, 2.0e-5);
  EXPECT_GT(session.signal("end"), first + 0.02);
}

TEST(PlasticBar, ComesBackFromAPullBelowItsYieldPoint) {
  GallerySession session(
      "plastic_bar.yaml",
      {"hand.script.positions=[{at_s: 0, m: 0}, {at_s: 1.5, m: 0.008}, {at_s: 2.5, m: 0}]"});
  double force = 0.0;
  session.play_until(3.4, [&] { force = std::max(force, std::abs(session.signal("hand_force"))); });

  EXPECT_GT(force, 0.5 * kStiffness * kYield);
  EXPECT_LT(force, kStiffness * kYield);
  EXPECT_NEAR(session.signal("end"), kPlasticLength, 1.0e-5);
}

}  // namespace
}  // namespace cordis::test
