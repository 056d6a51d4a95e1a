// tests/gallery/ratchet_test.cpp
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/gallery/gallery_session.h"

namespace cordis::test {
namespace {

constexpr double kTooth = 0.005;

TEST(Ratchet, GoesForwardByWholeTeethAndNeverBack) {
  GallerySession session("ratchet.yaml");
  session.play_until(2.0);
  double farthest = 0.0;
  double greatest_return = 0.0;
  const double start = session.position("rack").x();
  session.play_until(8.0, [&] {
    const double now = session.position("rack").x();
    farthest = std::max(farthest, now);
    greatest_return = std::max(greatest_return, farthest - now);
  });

  const double stroke = (session.position("rack").x() - start) / 3.0;  // three more to and fro
  EXPECT_NEAR(stroke, 5.0 * kTooth,
              1.0e-4);  // of 33 mm, less the play of two pawls and their springs
  // at most the play of a tooth, and what the pawl of the hand, 500 N/m, pushes that of the
  // ground, 800 N/m, together before it jumps
  EXPECT_LT(greatest_return, kTooth + kTooth * 500.0 / 800.0);
}

TEST(Ratchet, JumpsOneToothForEachThatItWins) {
  GallerySession session("ratchet.yaml");
  session.play_until(2.0);
  const std::uint64_t before = session.world().change_count(0, 0, 0);
  session.play_until(4.0);
  EXPECT_EQ(session.world().change_count(0, 0, 0) - before, 5u);
}

}  // namespace
}  // namespace cordis::test
