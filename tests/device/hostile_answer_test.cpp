// tests/device/hostile_answer_test.cpp -- whoever takes part in a session may write an answer: no
// number in it drives a motor beyond its guard, or keeps the device from the answers of the scene.
#include <cmath>
#include <deque>
#include <string>

#include <gtest/gtest.h>

#include "device_node/exchange.h"
#include "tests/support/hostile.h"
#include "tests/support/rounds.h"

namespace cordis::device {
namespace {

using test::Hostile;

constexpr std::uint64_t kEpoch = 77;
constexpr std::uint64_t kSceneEpoch = 5;
constexpr std::int64_t kPeriodNsec = 1'000'000;

std::int64_t fake_nsec = 0;
std::int64_t fake_clock() noexcept {
  return fake_nsec;
}

/// What the device sends, and what comes back.
class Line : public GestureChannel {
 public:
  bool send(const GestureMessage& sample) noexcept override {
    newest = sample;
    return true;
  }
  bool receive(GestureMessage& answer, std::chrono::nanoseconds) noexcept override {
    if (waiting.empty()) return false;
    answer = waiting.front();
    waiting.pop_front();
    return true;
  }
  GestureMessage newest;
  std::deque<GestureMessage> waiting;
};

/// A key that a hand holds at one place, with one force.
class HeldKey : public Driver {
 public:
  bool can_play(Role) const noexcept override { return true; }
  void start(Role role) noexcept override { role_ = role; }
  bool read(AxisValues& sensed) noexcept override {
    sensed.fill(0.0);
    sensed[0] = role_ == Role::kMass ? -0.01 : 1.0;
    return true;
  }
  bool write(const AxisValues& wanted) noexcept override {
    commanded = wanted;
    return true;
  }
  void stop() noexcept override {}

  AxisValues commanded{};

 private:
  Role role_ = Role::kMass;
};

struct Rig {
  Rig(Role role, bool lockstep, bool has_map)
      : exchange({.config = config_with(has_map),
                  .driver = driver,
                  .channel = line,
                  .meter = meter,
                  .role = role,
                  .series = {kEpoch, 0},
                  .lockstep = lockstep,
                  .clock = &fake_clock}) {}

  const DeviceConfig& config_with(bool has_map) {
    config.layout.count = 2;
    config.end_effector_map =
        has_map ? EndEffectorMap({{0.5, 0.5}, {1.0, -1.0}}, 2) : EndEffectorMap(2);
    return config;
  }

  GestureMessage true_answer(double value) {
    GestureMessage answer;
    answer.epoch = kSceneEpoch;
    answer.sample = ++answers;
    answer.answered_epoch = line.newest.epoch;
    answer.answered_sample = line.newest.sample;
    answer.answered_time_nsec = line.newest.time_nsec;
    answer.time_nsec = fake_nsec;
    answer.axis_count = 2;
    answer.value.fill(0.0);
    answer.value[0] = value;
    return answer;
  }

  /// A period with what is in the line, and the answer of the scene behind it.
  void period(double value) {
    line.waiting.push_back(true_answer(value));
    fake_nsec += kPeriodNsec;
    exchange.receive();
    exchange.step();
    exchange.send_sample();
  }

  DeviceConfig config;
  HeldKey driver;
  Line line;
  LoopMeter meter;
  std::uint64_t answers = 0;
  Exchange exchange;
};

GestureMessage spoilt(GestureMessage answer, Hostile& hostile) {
  const auto whole = [&] { return hostile.whole(); };
  const auto time = [&] { return hostile.time(); };
  answer.epoch = hostile.or_true(answer.epoch, whole);
  answer.sample = hostile.or_true(answer.sample, whole);
  answer.answered_epoch = hostile.or_true(answer.answered_epoch, whole);
  answer.answered_sample = hostile.or_true(answer.answered_sample, whole);
  answer.answered_time_nsec = hostile.or_true(answer.answered_time_nsec, time);
  answer.time_nsec = hostile.or_true(answer.time_nsec, time);
  answer.axis_count = hostile.or_true(answer.axis_count, [&] { return hostile.word(); });
  for (double& value : answer.value) value = hostile.or_true(value, [&] { return hostile.real(); });
  return answer;
}

class HostileAnswer : public ::testing::TestWithParam<std::tuple<Role, bool, bool>> {};

TEST_P(HostileAnswer, NeverPassesTheGuardNorSilencesTheScene) {
  const auto [role, lockstep, has_map] = GetParam();
  const double value = role == Role::kMass ? 2.0 : -0.02;
  for (std::uint64_t seed = 1; seed <= static_cast<std::uint64_t>(test::rounds(40)); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Hostile hostile(seed);
    fake_nsec = 1'000'000'000;
    Rig rig(role, lockstep, has_map);
    rig.exchange.send_sample();
    double before = 0.0;
    for (int period = 0; period < 1500; ++period) {
      if (period < 1000 && hostile.chance(0.5))
        rig.line.waiting.push_back(spoilt(rig.true_answer(value), hostile));
      rig.period(value);
      for (const double commanded : rig.driver.commanded) {
        ASSERT_TRUE(std::isfinite(commanded));
        ASSERT_LE(std::abs(commanded),
                  role == Role::kMass ? rig.config.force_guard.limit_n : 0.04 + 1e-12);
      }
      const double step = role == Role::kMass ? rig.config.force_guard.slew_n_per_s * 1e-3
                                              : rig.config.position_guard.speed_m_per_s * 1e-3;
      ASSERT_LE(std::abs(rig.driver.commanded[0] - before), step + 1e-12);
      before = rig.driver.commanded[0];
      ASSERT_TRUE(std::isfinite(rig.line.newest.work_j));
      ASSERT_LT(std::abs(rig.line.newest.work_j), 1e6);
    }
    const AxisValues wanted{value};
    const double there = role == Role::kMass ? rig.config.end_effector_map.axis_forces_of(wanted)[0]
                                             : rig.config.end_effector_map.axes_of(wanted)[0];
    EXPECT_NEAR(rig.driver.commanded[0], there, 1e-9)
        << "the answers of the scene are no longer taken";
    EXPECT_EQ(rig.meter.phase(), Phase::kRunning);
  }
}

INSTANTIATE_TEST_SUITE_P(Roles, HostileAnswer,
                         ::testing::Combine(::testing::Values(Role::kMass, Role::kLiaison),
                                            ::testing::Bool(), ::testing::Bool()));

TEST(HostileAnswer, ThatEchoesATimeBeforeTheDeviceBeganIsDropped) {
  for (const std::int64_t time : {std::numeric_limits<std::int64_t>::min(), std::int64_t{0},
                                  std::numeric_limits<std::int64_t>::max()}) {
    fake_nsec = 1'000'000'000;
    Rig rig(Role::kMass, /*lockstep=*/false, /*has_map=*/false);
    rig.exchange.send_sample();
    GestureMessage answer = rig.true_answer(2.0);
    answer.answered_time_nsec = time;
    rig.line.waiting.push_back(answer);
    fake_nsec += kPeriodNsec;
    rig.exchange.receive();
    EXPECT_EQ(rig.meter.dropped(), 1u) << time;
  }
}

}  // namespace
}  // namespace cordis::device
