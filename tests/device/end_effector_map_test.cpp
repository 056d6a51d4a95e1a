// tests/device/end_effector_map_test.cpp
#include "device_node/end_effector_map.h"

#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

#include "device_node/device_config.h"
#include "node/config/yaml_reader.h"

namespace cordis::device {
namespace {

double product(const AxisValues& a, const AxisValues& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

TEST(EndEffectorMap, WithoutAMapCoordinatesAreTheAxes) {
  const EndEffectorMap axes(3);
  const AxisValues values{1.0, -2.0, 3.0};

  EXPECT_EQ(axes.coordinate_count(), 3);
  EXPECT_EQ(axes.coordinates_of(values), values);
  EXPECT_EQ(axes.axis_forces_of(values), values);
  EXPECT_EQ(axes.axes_of(values), values);
  EXPECT_EQ(axes.coordinate_forces_of(values), values);
}

TEST(EndEffectorMap, ALeverOfTwoSlicesMovesByMeanAndDifference) {
  const EndEffectorMap lever({{0.5, 0.5}, {1.0, -1.0}}, 2);

  const AxisValues handle = lever.coordinates_of({0.01, 0.03});
  EXPECT_DOUBLE_EQ(handle[0], 0.02);
  EXPECT_DOUBLE_EQ(handle[1], -0.02);
  const AxisValues motors = lever.axis_forces_of({4.0, 1.0});
  EXPECT_DOUBLE_EQ(motors[0], 3.0);
  EXPECT_DOUBLE_EQ(motors[1], 1.0);
}

TEST(EndEffectorMap, GivesAHandleThePowerOfItsAxes) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  for (int coordinates = 1; coordinates <= kMaxCoordinates; ++coordinates) {
    const int axes = kMaxAxes;
    std::vector<std::vector<double>> map(static_cast<std::size_t>(coordinates),
                                         std::vector<double>(kMaxAxes));
    for (auto& row : map) {
      for (double& entry : row) entry = normal(random);
    }
    const EndEffectorMap end_effector(map, axes);
    AxisValues moved{};
    AxisValues force{};
    AxisValues carried{};
    for (std::size_t a = 0; a < kMaxAxes; ++a) moved[a] = normal(random);
    for (std::size_t c = 0; c < static_cast<std::size_t>(coordinates); ++c) {
      force[c] = normal(random);
      carried[c] = normal(random);
    }

    // Role mass: F dq = f dx.
    EXPECT_NEAR(product(force, end_effector.coordinates_of(moved)),
                product(end_effector.axis_forces_of(force), moved), 1e-12);
    // Role liaison: the handle goes where it is carried, with the same power.
    const AxisValues axes_carried = end_effector.axes_of(carried);
    const AxisValues reached = end_effector.coordinates_of(axes_carried);
    for (std::size_t c = 0; c < kMaxAxes; ++c) EXPECT_NEAR(reached[c], carried[c], 1e-10);
    EXPECT_NEAR(product(end_effector.coordinate_forces_of(moved), carried),
                product(moved, axes_carried), 1e-10);
  }
}

TEST(EndEffectorMap, RefusesMapsThatNoHandleHas) {
  EXPECT_THROW(EndEffectorMap({{1.0, 1.0}, {2.0, 2.0}}, 2), std::invalid_argument);
  EXPECT_THROW(EndEffectorMap({{1.0, 1.0}}, 3), std::invalid_argument);
  EXPECT_THROW(EndEffectorMap({{1.0}, {1.0}}, 1), std::invalid_argument);
  EXPECT_THROW(EndEffectorMap({}, 1), std::invalid_argument);
}

TEST(EndEffectorMap, IsReadFromADeviceFile) {
  config::Problems problems;
  const LoadedDevice device = read_device(
      config::load_text("{axes: 3, end_piece: {map: [[1, 0, 0], [0, 0.5, 0.5]]}}", "d", problems),
      "handle", problems);

  EXPECT_EQ(device.config.end_effector_map.coordinate_count(), 2);
  EXPECT_EQ(device.config.limits.coordinate_count, 2);
  EXPECT_EQ(device.config.end_effector_map.entry(1, 2), 0.5);
  EXPECT_THROW(
      read_device(config::load_text("{axes: 2, end_piece: {map: [[1, 1], [1, 1]]}}", "d", problems),
                  "handle", problems),
      config::ConfigError);
}

}  // namespace
}  // namespace cordis::device
