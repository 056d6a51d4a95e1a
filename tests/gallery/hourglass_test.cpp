// tests/gallery/hourglass_test.cpp
#include <cmath>

#include <gtest/gtest.h>

#include "tests/gallery/gallery_session.h"
#include "tests/support/rounds.h"

namespace cordis::test {
namespace {

/// How many grains are in the half below the neck.
int grains_below(const GallerySession& session) {
  const scene::NamedRange& sand = session.scene().matter.at(1);
  int count = 0;
  for (std::uint32_t i = 0; i < sand.count; ++i)
    count += session.world().position(sand.first + i).y() < 0.0 ? 1 : 0;
  return count;
}

TEST(Hourglass, RunsAsFastWhenFullAsWhenNearlyEmpty) {
  constexpr int kGrains = 340;
  GallerySession session("hourglass.yaml");
  const auto in_the_glass = [&] {
    ASSERT_GT(session.signal("lowest"), -0.17);
    ASSERT_LT(session.signal("highest"), 0.17);
  };
  const auto time_of = [&](int grains) {
    while (session.time_s() < 5.0 && grains_below(session) < grains) {
      session.play_until(session.time_s() + 0.01, in_the_glass);
    }
    return session.time_s();
  };
  const double first = time_of(kGrains / 5);
  const double half = time_of(kGrains / 2);
  if (rounds(2) < 2) return;
  const double late = time_of(4 * kGrains / 5);
  // Water would take 1.2 times as long for the second part: its speed is the root of its depth.
  EXPECT_NEAR((late - half) / (half - first), 1.0, 0.1);

  session.play_until(4.9, in_the_glass);
  EXPECT_EQ(grains_below(session), kGrains) << "nothing stays above";
  EXPECT_LT(session.signal("fastest"), 1e-3);

  session.play_until(9.0, in_the_glass);
  EXPECT_EQ(grains_below(session), 0) << "turned over, it runs back";
  EXPECT_LT(session.signal("fastest"), 1e-3);
  EXPECT_LT(std::abs(session.energy_residual()), 1.0e-9);
}

}  // namespace
}  // namespace cordis::test
