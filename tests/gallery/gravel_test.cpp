#include <cmath>

#include <gtest/gtest.h>

#include "tests/gallery/stage.h"

namespace cordis::test {
namespace {

constexpr double kTolerance = 1.0e-6;

/// Root of the mean square of the distances between the pebbles of two beds.
double distance_between(const Stage& a, const Stage& b) {
  const scene::NamedRange bed = a.mats("bed");
  double sum = 0.0;
  for (std::uint32_t i = 0; i < bed.count; ++i) {
    sum += (a.position("bed", i) - b.position("bed", i)).squaredNorm();
  }
  return std::sqrt(sum / bed.count);
}

TEST(Gravel, IsComputedWhereTheThumbWorksAndIsWhereItWouldBeAllTheSame) {
  const ChangedScene changed("gravel", {{", freeze: {tolerance_m: 1.0e-6}", ""}});
  Stage stage("gravel.yaml");
  Stage whole("gravel.yaml", changed.overrides());
  ASSERT_EQ(stage.mats("bed").count, 1404u);
  stage.play_until(1.8);  // the bed has settled, and the thumb was there once
  double awake = 0.0;
  double most = 0.0;
  stage.play_until(3.8, [&] {
    awake += stage.signal("awake") / 2000.0;
    most = std::max(most, stage.signal("awake"));
  });
  EXPECT_LT(awake, 0.15);
  EXPECT_GT(most, 0.3) << "a press moves the bed around it";

  whole.play_until(3.8);
  EXPECT_EQ(whole.signal("awake"), 1.0);
  EXPECT_LT(distance_between(stage, whole), 5.0 * kTolerance);
}

}  // namespace
}  // namespace cordis::test
