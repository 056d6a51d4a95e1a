// tests/device/haply_test.cpp -- the kinematics of a pantograph, and the driver against an emulated
// board on a pseudo-terminal.
#include "device_node/drivers/haply.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "device_node/drivers/pantograph.h"
#include "tests/device/pantograph_board.h"
#include "tests/device/wired.h"

namespace cordis::device {
namespace {

using test::PantographBoard;

TEST(Pantograph, InverseAndForwardAreEachOthersReverse) {
  for (const double base : {0.0, 0.03}) {
    Pantograph arms;
    arms.base_m = base;
    for (double x = -0.06; x <= 0.0601; x += 0.02) {
      for (double y = 0.06; y <= 0.1201; y += 0.02) {
        Pantograph::Pair angle{};
        ASSERT_TRUE(arms.inverse({x, y}, angle)) << x << " " << y;
        const Pantograph::Pose pose = arms.forward(angle);
        ASSERT_TRUE(pose.exists) << x << " " << y;
        EXPECT_NEAR(pose.pen_m[0], x, 1e-12);
        EXPECT_NEAR(pose.pen_m[1], y, 1e-12);
      }
    }
  }
}

TEST(Pantograph, KnowsWhatItCannotReach) {
  Pantograph arms;  // 0.07 m and 0.09 m
  Pantograph::Pair angle{};
  EXPECT_FALSE(arms.inverse({0.0, 0.2}, angle)) << "too far";
  EXPECT_FALSE(arms.inverse({0.0, 0.1601}, angle)) << "just too far";
  EXPECT_TRUE(arms.inverse({0.0, 0.1599}, angle));
  EXPECT_FALSE(arms.inverse({0.0, 0.01}, angle)) << "too near for arms that fold up";
  EXPECT_FALSE(arms.inverse({0.0, 0.0}, angle)) << "in the base itself";
  const Pantograph wide{0.07, 0.09, 0.1};
  EXPECT_TRUE(wide.inverse({0.0, 0.09}, angle));
  EXPECT_FALSE(wide.inverse({0.0, 0.03}, angle)) << "the pen would hang below its elbows";
  EXPECT_FALSE(arms.inverse({std::nan(""), 0.1}, angle));

  // Motors turned so far apart that the outer arms do not meet, or in line: no pose.
  EXPECT_FALSE(Pantograph({0.07, 0.06, 0.0}).forward({std::numbers::pi, 0.0}).exists);
  EXPECT_FALSE(Pantograph({0.07, 0.07, 0.0}).forward({std::numbers::pi, 0.0}).exists);
  EXPECT_FALSE(arms.forward({1.0, 1.0}).exists) << "elbows on one another: the pen is anywhere";
  EXPECT_FALSE(arms.forward({std::nan(""), 1.0}).exists);
}

TEST(Pantograph, TorquesStayWithinTheirLimitUpToASingularPose) {
  const Pantograph arms{0.07, 0.09, 0.1};
  const double stretched = std::acos((0.18 - 0.1) / 0.14);  // elbows two outer arms apart
  double largest = 0.0;
  for (double bend = 0.5; bend > 1e-9; bend *= 0.3) {
    const double right = stretched + bend;
    const Pantograph::Pose pose = arms.forward({std::numbers::pi - right, right});
    ASSERT_TRUE(pose.exists) << bend;
    const Pantograph::Pair wanted = Pantograph::torques(pose, {1.0, 2.0}, 1e9);
    const Pantograph::Pair torque = Pantograph::torques(pose, {1.0, 2.0}, 0.3);
    largest = std::max(largest, std::abs(wanted[0]));
    EXPECT_LE(std::max(std::abs(torque[0]), std::abs(torque[1])), 0.3 + 1e-12) << bend;
    EXPECT_NEAR(torque[0] * wanted[1], torque[1] * wanted[0], 1e-9 * std::abs(wanted[0]))
        << "the direction stays";
  }
  EXPECT_GT(largest, 100.0) << "N m, of 2 N at the pen";
}

TEST(Pantograph, TorquesDoTheWorkOfTheForce) {
  Pantograph arms;
  arms.base_m = 0.02;
  Pantograph::Pair angle{};
  ASSERT_TRUE(arms.inverse({0.02, 0.09}, angle));
  const Pantograph::Pair force{1.5, -0.7};
  const Pantograph::Pair torque = Pantograph::torques(arms.forward(angle), force, 10.0);

  // Virtual work over a small turn of each motor, by central differences.
  constexpr double kTurn = 1e-6;
  for (std::size_t k = 0; k < 2; ++k) {
    Pantograph::Pair more = angle;
    Pantograph::Pair less = angle;
    more[k] += kTurn;
    less[k] -= kTurn;
    const auto end = arms.forward(more).pen_m;
    const auto begin = arms.forward(less).pen_m;
    const double work = force[0] * (end[0] - begin[0]) + force[1] * (end[1] - begin[1]);
    EXPECT_NEAR(torque[k], work / (2.0 * kTurn), 1e-9);
  }
}

class HaplyTest : public Wired {
 protected:
  HaplyTest() {
    layout_.count = 2;
    layout_.lowest_m = -0.05;
    layout_.highest_m = 0.05;
  }

  /// The driver of a board that is plugged in.
  std::unique_ptr<Driver> pen_of(PantographBoard& board, const Pantograph::Pair& place) {
    board.put_pen(place);
    board.plug.into_serial_line(link());
    return driver("haply", port() + ", rest_m: [0, 0.1]", layout_);
  }

  AxisLayout layout_;
};

TEST_F(HaplyTest, TurnsAnglesIntoThePenAndForcesIntoTorques) {
  PantographBoard board;
  const auto pen = pen_of(board, {0.02, 0.09});
  pen->start(Role::kMass);

  Pantograph::Pair angle{};
  ASSERT_TRUE(Pantograph().inverse({0.02, 0.09}, angle));
  const auto wanted = Pantograph::torques(Pantograph().forward(angle), {1.0, 2.0}, 10.0);
  ASSERT_TRUE(until(*pen, {1.0, 2.0}, [&](bool there) {
    return there && std::abs(board.torques[1] - wanted[0]) < 1e-5 &&
           std::abs(board.torques[0] - wanted[1]) < 1e-5;
  }));
  AxisValues sensed{};
  ASSERT_TRUE(pen->read(sensed));
  EXPECT_NEAR(sensed[0], 0.02, 1e-6);
  EXPECT_NEAR(sensed[1], -0.01, 1e-6);
  EXPECT_GE(board.configurations, 1);
}

TEST_F(HaplyTest, LivesThroughEveryHarmAndUnpluggingAtOneKilohertz) {
  const auto pen = std::make_unique<Haply>(wire_at(port()), patient(), layout_, HaplySettings{});
  pen->start(Role::kMass);
  EXPECT_FALSE(pen->write({}));  // nothing is there yet
  for (const double x : {0.0, 0.03, -0.02}) {
    PantographBoard board;
    board.put_pen({x, 0.1});
    // Without a checksum a damaged place is believed when a hand could be there: 10 m/s.
    constexpr double kBelieved = 0.01;

    const auto check = [x](const AxisValues& sensed) {
      EXPECT_NEAR(sensed[0], x, kBelieved + 1e-6);
      EXPECT_NEAR(sensed[1], 0.0, kBelieved + 1e-6);
    };
    live_through_harm(*pen, board.plug, link(), {0.5, 0.0}, check,
                      [&] { return board.torques[0] != 0.0f; });

    EXPECT_GE(board.configurations, 1);
  }
}

TEST_F(HaplyTest, RefusesAnglesThatNoPenHas) {
  PantographBoard board;
  const auto pen = pen_of(board, {0.0, 0.1});
  auto& hardware = dynamic_cast<Hardware&>(*pen);
  pen->start(Role::kMass);
  ASSERT_TRUE(until(*pen, {}, [](bool there) { return there; }));

  board.degrees[0] = std::nanf("");
  ASSERT_TRUE(until(*pen, {}, [&](bool) { return hardware.bad_count() > 0; }));
  AxisValues sensed{};
  ASSERT_TRUE(pen->read(sensed));
  EXPECT_NEAR(sensed[0], 0.0, 1e-6) << "the last good place";
}

TEST_F(HaplyTest, AnAnswerThatIsNotBelievedDoesNotStandForTheNext) {
  PantographBoard board;
  const auto pen = pen_of(board, {0.0, 0.1});
  auto& hardware = dynamic_cast<Hardware&>(*pen);
  pen->start(Role::kMass);
  ASSERT_TRUE(until(*pen, {}, [](bool there) { return there; }));

  board.says_nonsense_before = true;
  std::uint64_t late = hardware.late_count();
  const std::uint64_t bad = hardware.bad_count();
  int in_time = 0;
  EXPECT_TRUE(until(*pen, {}, [&](bool) {  // sooner or later one after the other
    in_time = hardware.late_count() == late ? in_time + 1 : 0;
    late = hardware.late_count();
    return in_time == 20 && hardware.bad_count() >= bad + 20;
  }));
}

}  // namespace
}  // namespace cordis::device
