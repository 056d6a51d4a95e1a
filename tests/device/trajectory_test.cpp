// tests/device/trajectory_test.cpp
#include "device_node/drivers/trajectory.h"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

namespace cordis::device {
namespace {

using Shape = Trajectory::Shape;

TEST(Trajectory, RestsBeforeBetweenAndAfterItsMoves) {
  const Trajectory path(1.0, {{0.5, 0.25, 3.0}, {1.0, 0.5, -2.0}}, Shape::kMinimumJerk, 0.0);

  EXPECT_EQ(path.value_at(-1.0), 1.0);
  EXPECT_EQ(path.value_at(0.5), 1.0);
  EXPECT_EQ(path.value_at(0.75), 3.0);
  EXPECT_EQ(path.value_at(1.0), 3.0);
  EXPECT_EQ(path.value_at(1.5), -2.0);
  EXPECT_EQ(path.value_at(1000.0), -2.0);
  EXPECT_EQ(path.rate_at(0.9), 0.0);
}

TEST(Trajectory, GoesStraightWhenLinear) {
  const Trajectory path(0.0, {{1.0, 4.0, 2.0}}, Shape::kLinear, 0.0);

  EXPECT_DOUBLE_EQ(path.value_at(2.0), 0.5);
  EXPECT_DOUBLE_EQ(path.value_at(4.0), 1.5);
  EXPECT_DOUBLE_EQ(path.rate_at(2.0), 0.5);
}

TEST(Trajectory, GoesWithTheLeastJerk) {
  // Flash and Hogan 1985: half way after half the time, at 15/8 of the mean speed; speed and
  // acceleration are 0 at both ends.
  const double distance = 0.03;
  const double duration = 0.4;
  const Trajectory path(0.0, {{0.0, duration, distance}}, Shape::kMinimumJerk, 0.0);

  EXPECT_DOUBLE_EQ(path.value_at(duration / 2.0), distance / 2.0);
  EXPECT_DOUBLE_EQ(path.rate_at(duration / 2.0), 15.0 / 8.0 * distance / duration);
  EXPECT_DOUBLE_EQ(path.value_at(0.1), distance * (10.0 / 64.0 - 15.0 / 256.0 + 6.0 / 1024.0));
  const double early = 1e-4 * duration;
  EXPECT_LT(path.rate_at(early), 1e-6 * distance / duration);
  EXPECT_LT(path.rate_at(duration - early), 1e-6 * distance / duration);
}

TEST(Trajectory, HasTheRateOfItsValue) {
  const Trajectory path(0.5, {{0.2, 0.7, -1.0}, {1.0, 0.3, 2.0}}, Shape::kMinimumJerk, 1.5);
  const double h = 1e-5;

  for (double t = 0.01; t < 3.0; t += 0.0137) {
    // central difference: its error is h^2/6 times the third derivative, at most 60 * 3 / 0.3^3
    EXPECT_NEAR(path.rate_at(t), (path.value_at(t + h) - path.value_at(t - h)) / (2.0 * h), 2e-7)
        << t;
  }
}

TEST(Trajectory, RepeatsFromWhereItsLastMoveEnded) {
  const Trajectory path(9.0, {{0.1, 0.1, 1.0}, {0.3, 0.1, 2.0}}, Shape::kLinear, 0.5);

  EXPECT_EQ(path.value_at(0.0), 9.0);
  EXPECT_EQ(path.value_at(0.5), 2.0);
  EXPECT_NEAR(path.value_at(0.65), 1.5, 1e-12);
  for (int n = 1; n < 10000; ++n) {
    const double begin = 0.5 * n;
    ASSERT_EQ(path.value_at(begin + 0.05), 2.0) << n;
    ASSERT_EQ(path.value_at(begin + 0.25), 1.0) << n;
  }
}

TEST(Trajectory, JumpsInTheVerySampleItsTimeNames) {
  // 0.1 and 0.3 have no exact binary form, and the sum of ten tenths is not 1.
  const Trajectory first(0.0, {{0.0, 0.0, 1.0}, {0.1, 0.0, 0.0}}, Shape::kLinear, 0.3);
  const Trajectory second(0.0, {{0.1, 0.0, 1.0}, {0.2, 0.0, 0.0}}, Shape::kLinear, 0.3);
  const Trajectory short_one(0.0, {{0.0, 0.0, 1.0}, {0.05, 0.0, 0.0}}, Shape::kLinear, 0.1);

  for (int n = 0; n < 300000; ++n) {
    ASSERT_EQ(first.value_at(n / 10.0), n % 3 == 0 ? 1.0 : 0.0) << n;
    ASSERT_EQ(second.value_at(n / 10.0), n % 3 == 1 ? 1.0 : 0.0) << n;
    ASSERT_EQ(short_one.value_at(n / 100.0), n % 10 < 5 ? 1.0 : 0.0) << n;
  }
}

TEST(Trajectory, TakesMovesThatEndWhenTheNextBegins) {
  // 0.1 + 0.2 is more than 0.3 by the last bit.
  EXPECT_NO_THROW(Trajectory(0.0, {{0.1, 0.2, 1.0}, {0.3, 0.1, 0.0}}, Shape::kLinear, 0.4));
  EXPECT_NO_THROW(Trajectory(0.0, {{0.1, 0.2, 1.0}}, Shape::kLinear, 0.3));
}

TEST(Trajectory, RefusesMovesThatDoNotFit) {
  EXPECT_THROW(Trajectory(0.0, {{0.0, 1.0, 1.0}, {0.5, 1.0, 0.0}}, Shape::kLinear, 0.0),
               std::invalid_argument);
  EXPECT_THROW(Trajectory(0.0, {{-0.1, 1.0, 1.0}}, Shape::kLinear, 0.0), std::invalid_argument);
  EXPECT_THROW(Trajectory(0.0, {{0.0, 2.0, 1.0}}, Shape::kLinear, 1.0), std::invalid_argument);
  EXPECT_THROW(Trajectory(0.0, {{0.0, 1.0, NAN}}, Shape::kLinear, 0.0), std::invalid_argument);
}

}  // namespace
}  // namespace cordis::device
