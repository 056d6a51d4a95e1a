// tests/gallery/gravel_test.cpp
#include <cmath>

#include <gtest/gtest.h>

#include "tests/gallery/gallery_session.h"

namespace cordis::test {
namespace {

constexpr double kTolerance = 1.0e-5;

/// Root of the mean square of the distances between the pebbles of two beds.
double distance_between(const GallerySession& a, const GallerySession& b) {
  const scene::NamedRange bed = a.mats("bed");
  double sum = 0.0;
  for (std::uint32_t i = 0; i < bed.count; ++i) {
    sum += (a.position("bed", i) - b.position("bed", i)).squaredNorm();
  }
  return std::sqrt(sum / bed.count);
}

TEST(Gravel, IsComputedWhereTheThumbWorksAndIsWhereItWouldBeAllTheSame) {
  const ChangedScene changed("gravel", {{", freeze: {tolerance_m: 1.0e-5}", ""}});
  GallerySession session("gravel.yaml");
  GallerySession whole("gravel.yaml", changed.overrides());
  ASSERT_EQ(session.mats("bed").count, 1404u);
  session.play_until(3.8);  // the bed has settled, and the thumb was there once
  double awake = 0.0;
  double most = 0.0;
  session.play_until(5.8, [&] {
    awake += session.signal("awake") / 2000.0;
    most = std::max(most, session.signal("awake"));
  });
  EXPECT_LT(awake, 0.2);
  EXPECT_GT(most, 0.3) << "a press moves the bed around it";

  whole.play_until(5.8);
  EXPECT_EQ(whole.signal("awake"), 1.0);
  EXPECT_LT(distance_between(session, whole), 0.5 * kTolerance);
}

}  // namespace
}  // namespace cordis::test
