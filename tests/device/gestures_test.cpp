// tests/device/gestures_test.cpp
#include "device_node/drivers/gestures.h"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "device_node/drivers/mock.h"
#include "node/config/yaml_reader.h"

namespace cordis::device {
namespace {

std::vector<Trajectory> gesture_of(const std::string& text, std::size_t axis_count) {
  config::Problems problems;
  config::MappingReader reader(config::load_text(text, "hand", problems), "hand", problems);
  std::vector<Trajectory> paths = read_gesture(reader, axis_count, problems);
  EXPECT_EQ(problems.text(), "");
  return paths;
}

std::string problems_of(const std::string& text, std::size_t axis_count) {
  config::Problems problems;
  config::MappingReader reader(config::load_text(text, "hand", problems), "hand", problems);
  read_gesture(reader, axis_count, problems);
  return problems.text();
}

TEST(Gestures, MovesMayGiveEachAxisItsOwnPlace) {
  const auto paths =
      gesture_of("{start_m: 0, moves: [{at_s: 0, in_s: 1, to_m: [0.01, -0.02]}]}", 2);

  ASSERT_EQ(paths.size(), 2u);
  EXPECT_EQ(paths[0].value_at(1.0), 0.01);
  EXPECT_EQ(paths[1].value_at(1.0), -0.02);
}

TEST(Gestures, AMoveMayBeginWhenTheOneBeforeEnds) {
  const auto paths = gesture_of(  // 0.1 + 0.2 is more than 0.3 by the last bit
      "{moves: [{at_s: 0.1, in_s: 0.2, to_m: 0}, {at_s: 0.3, in_s: 0, to_m: 1}], repeat_s: 0.3}",
      1);

  EXPECT_EQ(paths.size(), 1u);
}

TEST(Gestures, PluckDrawsSlowlyAndLetsGoAtOnce) {
  const auto paths = gesture_of(
      "gesture: {kind: pluck, above_m: 0.005, depth_m: -0.02, after_s: 0.2, in_s: 1, stay_s: 0.5}",
      1);

  EXPECT_EQ(paths[0].value_at(0.2), 0.005);
  EXPECT_EQ(paths[0].value_at(1.2), -0.02);
  EXPECT_EQ(paths[0].value_at(1.7), -0.02);
  EXPECT_EQ(paths[0].value_at(1.76), 0.005);
  EXPECT_EQ(paths[0].value_at(2.26 + 1.2), -0.02) << "and again";
}

TEST(Gestures, ReachAndPressComesUpAsItWentDown) {
  const auto paths = gesture_of(
      "gesture: {kind: reach_and_press, depth_m: -0.03, after_s: 0, "
      "in_s: 0.4, stay_s: 1, repeats: false}",
      1);

  EXPECT_EQ(paths[0].value_at(0.9), -0.03);
  EXPECT_NEAR(paths[0].value_at(1.6), 0.5 * (0.005 - 0.03), 1e-12);
  EXPECT_EQ(paths[0].value_at(100.0), 0.005);
}

TEST(Gestures, BowStrokesAtItsSpeedWhileItPresses) {
  const auto paths = gesture_of(
      "gesture: {kind: bow, stroke_m: 0.1, speed_m_per_s: 0.2, depth_m: -0.01, after_s: 0}", 2);

  ASSERT_EQ(paths.size(), 2u);
  EXPECT_NEAR(paths[0].rate_at(0.4), 0.2, 1e-12);
  EXPECT_EQ(paths[1].value_at(0.4), -0.01);
  EXPECT_NEAR(paths[0].value_at(0.7), 0.05, 1e-12) << "the end of a stroke of 0.5 s after 0.2 s";
}

TEST(Gestures, GraspAndDragMovesTwoFingersTogether) {
  const auto paths = gesture_of(
      "gesture: {kind: grasp_and_drag, open_m: 0.04, grip_m: 0.01, "
      "drag_m: [0.03, 0.02], after_s: 0, in_s: 1}",
      4);

  ASSERT_EQ(paths.size(), 4u);
  EXPECT_EQ(paths[2].value_at(1.0) - paths[0].value_at(1.0), 0.02) << "closed";
  EXPECT_NEAR(paths[2].value_at(2.0) - paths[0].value_at(2.0), 0.02, 1e-15) << "on the way";
  EXPECT_EQ(paths[1].value_at(2.0), 0.02);
  EXPECT_NEAR(paths[0].value_at(2.0), 0.03 - 0.01, 1e-15);
}

TEST(Gestures, GraspAndDragGoesFromItsPlaceAndBack) {
  const auto paths = gesture_of(
      "gesture: {kind: grasp_and_drag, open_m: 0.04, grip_m: 0.01, from_m: [0.1, -0.05], "
      "drag_m: [0.03, 0.02], after_s: 0, in_s: 1, stay_s: 0, repeats: false}",
      4);

  ASSERT_EQ(paths.size(), 4u);
  const auto expect_fingers = [&](double at_s, double half, double x, double y) {
    SCOPED_TRACE(at_s);
    EXPECT_NEAR(paths[0].value_at(at_s), x - half, 1e-15);
    EXPECT_NEAR(paths[1].value_at(at_s), y, 1e-15);
    EXPECT_NEAR(paths[2].value_at(at_s), x + half, 1e-15);
    EXPECT_NEAR(paths[3].value_at(at_s), y, 1e-15);
  };
  expect_fingers(0.0, 0.04, 0.1, -0.05);
  expect_fingers(1.0, 0.01, 0.1, -0.05);
  expect_fingers(2.0, 0.01, 0.13, -0.03);
  expect_fingers(3.0, 0.04, 0.13, -0.03);
  expect_fingers(4.0, 0.04, 0.1, -0.05);
}

TEST(Gestures, KneadPressesAndPartsSeveralTimes) {
  const auto paths = gesture_of(
      "gesture: {kind: knead, open_m: 0.05, grip_m: 0.005, depth_m: "
      "-0.02, times: 3, after_s: 0, in_s: 1, stay_s: 0, repeats: false}",
      4);

  for (const double begin : {0.0, 2.0, 4.0}) {
    EXPECT_EQ(paths[2].value_at(begin + 1.0), 0.005);
    EXPECT_EQ(paths[3].value_at(begin + 1.0), -0.02);
    EXPECT_EQ(paths[2].value_at(begin + 2.0), 0.05);
  }
  EXPECT_EQ(paths[2].value_at(60.0), 0.05);
}

TEST(Gestures, HoldStays) {
  const auto paths = gesture_of("gesture: {kind: hold, at_m: [0.01, -0.02]}", 2);

  EXPECT_EQ(paths[0].value_at(5.0), 0.01);
  EXPECT_EQ(paths[1].value_at(5.0), -0.02);
}

TEST(Gestures, ReportWhatIsWrong) {
  EXPECT_NE(problems_of("gesture: {kind: knead, open_m: 0.1, grip_m: 0.1}", 2).find("four axes"),
            std::string::npos);
  EXPECT_NE(problems_of("{gesture: {kind: hold, at_m: 0}, start_m: 0}", 1).find("either"),
            std::string::npos);
  EXPECT_NE(problems_of("moves: [{at_s: 0, in_s: 1, to_m: [0, 0, 0]}]", 2).find("one per axis"),
            std::string::npos);
}

TEST(Sensor, NoiseAndGridAreAsSetAndTheSameForTheSameSeed) {
  Sensor sensor({.noise = 1e-4, .quantum = 1e-5}, 42);
  Sensor same({.noise = 1e-4, .quantum = 1e-5}, 42);
  double sum = 0.0;
  double squares = 0.0;
  constexpr int kReadings = 20000;

  for (int n = 0; n < kReadings; ++n) {
    const double error = sensor.read(0.01) - 0.01;
    ASSERT_EQ(error, same.read(0.01) - 0.01);
    const double steps = (0.01 + error) / 1e-5;
    ASSERT_NEAR(steps, std::round(steps), 1e-9);
    sum += error;
    squares += error * error;
  }

  // Mean and variance of 20000 readings: within 4 standard errors; the grid adds q^2 / 12.
  EXPECT_NEAR(sum / kReadings, 0.0, 4.0 * 1e-4 / std::sqrt(kReadings));
  EXPECT_NEAR(std::sqrt(squares / kReadings), 1e-4, 0.03e-4);
}

}  // namespace
}  // namespace cordis::device
