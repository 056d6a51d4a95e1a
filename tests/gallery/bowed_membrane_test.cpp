// tests/gallery/bowed_membrane_test.cpp
#include <algorithm>
#include <cmath>
#include <utility>

#include <gtest/gtest.h>

#include "tests/gallery/gallery_session.h"

namespace cordis::test {
namespace {

constexpr double kLowestNoteHz = 131.4;  // sqrt(2 K / m) sin(pi / 28) / pi

TEST(BowedMembrane, SingsWhileTheBowDraws) {
  GallerySession session("bowed_membrane.yaml");
  session.play_until(0.85);
  double before = session.signal("under_bow");
  double fastest = 0.0;
  int crossings = 0;
  session.play_until(1.15, [&] {
    const double now = session.signal("under_bow");
    if ((std::exchange(before, now) < 0.0) != (now < 0.0)) ++crossings;
    fastest = std::max(fastest, std::abs(now));
  });
  // What is only dragged moves slowly under the bow. What sings swings at its lowest note or above, nearly as fast
  // as the bow, which goes at 0.31 m/s.
  EXPECT_GE(crossings, 2.0 * 0.3 * kLowestNoteHz - 2.0);
  EXPECT_GT(fastest, 0.15);
  EXPECT_LT(std::abs(session.energy_residual()), 1.0e-9);

  // Each turn of the bow lets the skin come to rest, stretched by the bow.
  session.play_until(1.5);
  EXPECT_LT(std::abs(session.signal("under_bow")), 0.02);
}

TEST(BowedMembrane, FeelsTheFinger) {
  GallerySession session("bowed_membrane.yaml");
  session.play_until(3.0);
  EXPECT_GT(session.signal("finger_force"), 0.1);
  EXPECT_EQ(session.bound_text(), "");
}

}  // namespace
}  // namespace cordis::test
