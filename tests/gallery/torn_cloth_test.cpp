// tests/gallery/torn_cloth_test.cpp
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/gallery/gallery_session.h"

namespace cordis::test {
namespace {

TEST(TornCloth, BillowsInTheGustsAndTearsInTheHand) {
  GallerySession session("torn_cloth.yaml");
  const double whole = 16 * 21 + 17 * 20;
  EXPECT_EQ(session.mats("cloth").count, 17u * 21u);
  double billow = 0.0;
  session.play_until(1.2, [&] { billow = std::max(billow, session.signal("billow")); });
  EXPECT_GT(billow, 0.06) << "in the gust";
  session.play_until(2.4);
  EXPECT_LT(session.signal("billow"), 0.5 * billow) << "in the calm";
  EXPECT_EQ(session.signal("whole"), whole) << "the wind alone tears nothing";

  double pulled = 0.0;
  session.play_until(7.0, [&] { pulled = std::min(pulled, session.signal("hand_force")); });
  EXPECT_LT(pulled, -1.0);
  EXPECT_LT(session.signal("whole"), whole - 10);
  EXPECT_LT(std::abs(session.energy_residual()), 1.0e-9);
}

}  // namespace
}  // namespace cordis::test
