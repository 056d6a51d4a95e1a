// tests/device/exchange_test.cpp
#include "device_node/exchange.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace cordis::device {
namespace {

using std::chrono::nanoseconds;

constexpr std::uint64_t kEpoch = 77;
constexpr std::uint64_t kSceneEpoch = 5;
constexpr std::int64_t kPeriodNsec = 1'000'000;  // [ns]

std::int64_t now_nsec = 0;
std::int64_t now() noexcept {
  return now_nsec;
}

std::int64_t slept_nsec = 0;
std::int64_t since_boot() noexcept {
  return now_nsec + slept_nsec;
}

/// A scene that answers what the test puts into it.
class FakeChannel : public GestureChannel {
 public:
  bool send(const GestureMessage& sample) noexcept override {
    sent.push_back(sample);
    return works;
  }
  bool receive(GestureMessage& answer, nanoseconds) noexcept override {
    if (waiting.empty()) return false;
    answer = waiting.front();
    waiting.pop_front();
    return true;
  }

  std::vector<GestureMessage> sent;
  std::deque<GestureMessage> waiting;
  bool works = true;
};

/// A device whose sensors say how many periods it has lived, and that remembers its commands.
class FakeDriver : public Driver {
 public:
  bool can_play(Role) const noexcept override { return true; }
  void start(Role role) noexcept override { started_as = role; }
  bool read(AxisValues& sensed) noexcept override {
    sensed.fill(0.0);
    sensed[0] = lies ? std::nan("") : -0.001 * static_cast<double>(commands.size());
    return present;
  }
  void record_age(double age_s) noexcept override { age = age_s; }
  bool write(const AxisValues& commanded) noexcept override {
    commands.push_back(commanded);
    return present;
  }
  bool has_motors() const noexcept override { return motors; }
  void stop() noexcept override { stopped = true; }

  Role started_as = Role::kMass;
  std::vector<AxisValues> commands;
  double age = -1.0;  // of the last of them [s]
  bool motors = false;
  bool present = true;
  bool lies = false;
  bool stopped = false;
};

DeviceConfig config_of_two_axes(double watchdog_s = 0.02) {
  DeviceConfig config;
  config.name = "keyboard";
  config.device_id = 4711;
  config.layout.count = 2;
  config.end_effector_map = EndEffectorMap(2);
  config.force_guard.ramp_s = 0.0;
  config.force_guard.watchdog_s = watchdog_s;
  config.position_guard.watchdog_s = watchdog_s;
  config.position_guard.ramp_s = 0.0;
  return config;
}

struct Rig {
  explicit Rig(bool lockstep, Role role = Role::kMass, Exchange::Series series = {kEpoch, 0},
               DeviceConfig device = config_of_two_axes())
      : config(std::move(device)),
        exchange({.config = config,
                  .driver = driver,
                  .channel = channel,
                  .meter = meter,
                  .role = role,
                  .series = series,
                  .lockstep = lockstep,
                  .clock = &now,
                  .since_boot = &since_boot}) {}

  /// The scene's answer to the sample sent last.
  GestureMessage answer(double value) {
    const GestureMessage& sample = channel.sent.back();
    GestureMessage message;
    message.epoch = kSceneEpoch;
    message.sample = ++scene_sample;
    message.answered_epoch = sample.epoch;
    message.answered_sample = sample.sample;
    message.answered_time_nsec = sample.time_nsec;
    message.time_nsec = now_nsec + 500;
    message.axis_count = 2;
    message.value[0] = value;
    message.value[1] = value;
    return message;
  }

  /// One period of the realtime clock, with an answer or without.
  double period(bool answered, double value = 0.0) {
    exchange.send_sample();
    if (answered) channel.waiting.push_back(answer(value));
    now_nsec += kPeriodNsec;
    exchange.receive();
    exchange.step();
    return driver.commands.back()[0];
  }

  DeviceConfig config;
  FakeDriver driver;
  FakeChannel channel;
  LoopMeter meter;
  std::uint64_t scene_sample = 100;
  Exchange exchange;
};

TEST(Exchange, NumbersItsSamplesAndEchoesTheAnswerInUse) {
  now_nsec = 1000;
  Rig rig(false);

  rig.period(true, 2.0);
  rig.period(false);
  rig.exchange.send_sample();

  ASSERT_EQ(rig.channel.sent.size(), 3u);
  const GestureMessage& first = rig.channel.sent[0];
  EXPECT_EQ(first.epoch, kEpoch);
  EXPECT_EQ(first.sample, 1u);
  EXPECT_EQ(first.answered_epoch, 0u);
  EXPECT_EQ(first.answered_sample, 0u);
  EXPECT_EQ(first.time_nsec, 1000);
  EXPECT_EQ(first.axis_count, 2u);
  EXPECT_EQ(first.value[0], 0.0);
  const GestureMessage& third = rig.channel.sent[2];
  EXPECT_EQ(third.sample, 3u);
  EXPECT_EQ(third.answered_epoch, kSceneEpoch);
  EXPECT_EQ(third.answered_sample, 101u);
  EXPECT_EQ(third.answered_time_nsec, 1500);
  EXPECT_EQ(third.value[0], -0.002);
}

TEST(Exchange, GoesOnWithTheNumbersOfItsProcess) {
  Rig rig(false, Role::kLiaison, {kEpoch, 41});

  rig.exchange.send_sample();

  EXPECT_EQ(rig.driver.started_as, Role::kLiaison);
  EXPECT_EQ(rig.channel.sent.back().sample, 42u);
  EXPECT_EQ(rig.exchange.last_sample(), 42u);
}

TEST(Exchange, HandsTheNewestAnswerToTheMotorThroughTheGuard) {
  Rig rig(false);

  EXPECT_EQ(rig.period(true, 3.0), 3.0);
  EXPECT_EQ(rig.period(true, 100.0), 8.0);  // 5 N per period at 5000 N/s
  EXPECT_EQ(rig.period(true, 100.0), 13.0);
  EXPECT_EQ(rig.period(true, 100.0), 18.0);
  EXPECT_EQ(rig.period(true, 100.0), 20.0);  // the limit
  EXPECT_EQ(rig.period(true, NAN), 15.0);    // on its way to zero
  EXPECT_EQ(rig.meter.dropped(), 1u);
}

TEST(Exchange, CarriesToPositionsInRoleLiaison) {
  Rig rig(false, Role::kLiaison);

  EXPECT_EQ(rig.period(true, -0.001), -0.001);
  EXPECT_NEAR(rig.period(true, -0.04), -0.003, 1e-15);  // 2 m/s
}

TEST(Exchange, GivesTheDriverTheAgeOfItsCommand) {
  now_nsec = 1'000'000'000;
  Rig rig(false, Role::kLiaison);
  rig.period(false);
  EXPECT_GE(rig.driver.age, rig.config.force_guard.watchdog_s) << "no force was ever commanded";
  rig.period(true, -0.001);
  EXPECT_NEAR(rig.driver.age, 0.001, 1e-12);
  for (int n = 0; n < 30; ++n) rig.period(false);
  EXPECT_NEAR(rig.driver.age, 0.031, 1e-12);
}

TEST(Exchange, ReportsTheEnergyGivenToTheHandInBothRoles) {
  const auto given_by = [](Role role, double answer) {
    Rig rig(false, role);
    for (int n = 0; n < 5; ++n) rig.period(true, answer);
    msg::NodeStatus status;
    rig.meter.fill(status);
    return status.port_energy_j();
  };
  // The sensors say -1 mm more after every period: four of them under a force of 2 N.
  EXPECT_NEAR(given_by(Role::kMass, 2.0), 4 * 2.0 * -0.001, 1e-12);
  // As forces they say -1 mN more. The hand is at -2 mm after the first period, is carried by -2 mm
  // in the second, while its push grows from -1 mN to -2 mN, and stays: it has given 3 uJ.
  EXPECT_NEAR(given_by(Role::kLiaison, -0.004), -0.0015 * 0.002, 1e-15);
}

TEST(Exchange, BeyondItsTravelTheHandGivesAsIfItWentOn) {
  Rig rig(false, Role::kLiaison);

  EXPECT_EQ(rig.period(true, 0.001), 0.0);
  EXPECT_EQ(rig.period(true, 0.003), 0.0);
  rig.exchange.send_sample();

  EXPECT_NEAR(rig.channel.sent.back().work_j, -0.0015 * 0.002, 1e-15);  // -1 mN, then -2 mN
}

TEST(Exchange, ForceIsZeroOnceItsSampleIsAsOldAsTheWatchdog) {
  Rig rig(false);
  rig.period(true, 10.0);
  rig.period(true, 10.0);
  ASSERT_EQ(rig.period(true, 10.0), 10.0);
  ASSERT_EQ(rig.meter.phase(), Phase::kRunning);

  for (int n = 2; n <= 19; ++n) {
    rig.period(false);
    ASSERT_EQ(rig.meter.phase(), Phase::kRunning) << n;
  }
  EXPECT_EQ(rig.period(false), 0.0);  // 20 ms after the sample that was answered last
  EXPECT_EQ(rig.meter.phase(), Phase::kLost);

  EXPECT_GT(rig.period(true, 10.0), 0.0);
  EXPECT_EQ(rig.meter.phase(), Phase::kRunning);
}

TEST(Exchange, RecordsThatADeviceWithMotorsWasNeverConnected) {
  for (const bool lockstep : {false, true}) {
    Rig rig(lockstep);
    rig.driver.motors = true;
    rig.driver.present = false;
    rig.exchange.step();
    EXPECT_EQ(rig.meter.last_phase(), Phase::kNeverConnected);
    rig.driver.present = true;
    rig.exchange.step();
    EXPECT_EQ(rig.meter.last_phase(), Phase::kStopped);
  }
  Rig simulated(false);
  simulated.driver.present = false;
  simulated.exchange.step();
  EXPECT_EQ(simulated.meter.last_phase(), Phase::kStopped) << "it has no board";
}

TEST(Exchange, ASceneThatTalksButDoesNotListenIsSilent) {
  Rig rig(false);
  rig.period(true, 4.0);
  const GestureMessage old = rig.answer(4.0);

  for (int n = 0; n < 25; ++n) {
    GestureMessage again = old;
    again.sample += static_cast<std::uint64_t>(n + 1);
    rig.channel.waiting.push_back(again);
    rig.period(false);
  }

  EXPECT_EQ(rig.driver.commands.back()[0], 0.0);
  EXPECT_EQ(rig.meter.phase(), Phase::kLost);
}

TEST(Exchange, WaitsInPhaseWaitingForTheFirstAnswer) {
  Rig rig(false);

  for (int n = 0; n < 100; ++n) rig.period(false);

  EXPECT_EQ(rig.meter.phase(), Phase::kWaiting);
  EXPECT_EQ(rig.driver.commands.back(), AxisValues{});
}

TEST(Exchange, DropsWhatIsNotAnAnswerToIt) {
  Rig rig(false);
  rig.period(true, 1.0);
  rig.period(true, 1.0);
  const auto dropped_by = [&rig](auto change) {
    GestureMessage message = rig.answer(9.0);
    change(message);
    const std::uint64_t before = rig.meter.dropped();
    rig.channel.waiting.push_back(message);
    rig.exchange.receive();
    rig.exchange.step();
    EXPECT_EQ(rig.driver.commands.back()[0], 1.0);
    return rig.meter.dropped() - before;
  };

  EXPECT_EQ(dropped_by([](GestureMessage& m) { m.axis_count = 0; }), 1u);
  EXPECT_EQ(dropped_by([](GestureMessage& m) { m.axis_count = 17; }), 1u);
  EXPECT_EQ(dropped_by([](GestureMessage& m) { m.answered_sample += 1; }), 1u);
  EXPECT_EQ(dropped_by([](GestureMessage& m) { m.answered_sample -= 1; }), 1u);
  EXPECT_EQ(dropped_by([](GestureMessage& m) { m.answered_time_nsec = now_nsec + 1; }), 1u);
  EXPECT_EQ(dropped_by([](GestureMessage& m) { m.sample = 101; }), 1u);
  // A scene that has not received this device yet, or that answers another node, is no fault.
  EXPECT_EQ(dropped_by([](GestureMessage& m) { m.answered_epoch = kEpoch - 1; }), 0u);
  EXPECT_EQ(dropped_by([](GestureMessage& m) { m.answered_epoch = m.answered_sample = 0; }), 0u);
}

TEST(Exchange, DoesNotTakeAnswersToAnEarlierRole) {
  Rig rig(false, Role::kMass, {kEpoch, 10});
  rig.exchange.send_sample();
  GestureMessage late = rig.answer(9.0);
  late.answered_sample = 10;

  rig.channel.waiting.push_back(late);
  rig.exchange.receive();
  rig.exchange.step();

  EXPECT_EQ(rig.driver.commands.back(), AxisValues{});
  EXPECT_EQ(rig.meter.dropped(), 1u);
}

TEST(Exchange, ANewRunOfTheSceneIsKnownByWhatItAnswers) {
  for (const bool lockstep : {false, true}) {
    Rig rig(lockstep);
    rig.period(true, 1.0);
    rig.exchange.send_sample();
    GestureMessage fresh = rig.answer(2.0);
    fresh.epoch = kSceneEpoch - 1;  // the number of a run says nothing about its age
    fresh.sample = 1;

    rig.channel.waiting.push_back(fresh);
    rig.exchange.receive();
    rig.exchange.step();

    EXPECT_EQ(rig.driver.commands.back()[0], 2.0);
    EXPECT_EQ(rig.meter.dropped(), 0u);
  }
}

TEST(Exchange, ANewRunOfTheSceneMayAnswerWhatAnEarlierOneHasAnswered) {
  Rig rig(false);
  rig.period(true, 1.0);
  GestureMessage fresh = rig.answer(2.0);
  fresh.epoch = kSceneEpoch + 1;
  fresh.sample = 1;

  rig.channel.waiting.push_back(fresh);
  rig.exchange.receive();
  rig.exchange.step();

  EXPECT_EQ(rig.driver.commands.back()[0], 2.0);
}

TEST(Exchange, MissesASceneThatAnswersNoNewSampleForLongerThanTheWatchdog) {
  now_nsec = 0;
  Rig rig(false);
  for (int n = 0; n < 100; ++n) rig.period(false);
  EXPECT_FALSE(rig.exchange.misses_the_scene()) << "it has never answered";

  for (int n = 0; n < 5; ++n) rig.period(true, 1.0);
  const GestureMessage last = rig.answer(1.0);
  for (int n = 0; n < 19; ++n) rig.period(false);
  EXPECT_FALSE(rig.exchange.misses_the_scene());
  rig.period(false);
  EXPECT_TRUE(rig.exchange.misses_the_scene());

  GestureMessage again = last;  // the scene goes on, and receives nothing of this device
  again.sample = ++rig.scene_sample;
  rig.channel.waiting.push_back(again);
  rig.period(false);
  EXPECT_TRUE(rig.exchange.misses_the_scene());

  rig.period(true, 1.0);
  EXPECT_FALSE(rig.exchange.misses_the_scene());
}

TEST(Exchange, BlamesNoSceneForTheTimeInWhichItStoodStillItself) {
  now_nsec = 0;
  Rig rig(false);
  for (int n = 0; n < 5; ++n) rig.period(true, 1.0);

  now_nsec += 1'000 * kPeriodNsec;
  rig.period(false);

  EXPECT_EQ(rig.driver.commands.back()[0], 0.0);
  EXPECT_FALSE(rig.exchange.misses_the_scene());
}

TEST(Exchange, MeasuresFromSendingToTakingTheAnswer) {
  now_nsec = 0;
  Rig rig(false);
  for (int n = 0; n < 10; ++n) rig.period(true, 1.0);
  rig.channel.waiting.push_back(rig.answer(1.0));  // a second answer to the same sample: no news
  rig.exchange.receive();

  rig.meter.publish_latency();
  msg::NodeStatus status;
  rig.meter.fill(status);

  EXPECT_EQ(status.latency_count(), 10u);
  EXPECT_NEAR(status.latency_p50_s(), 1e-3, 0.04e-3);  // bins of 3 %
  EXPECT_DOUBLE_EQ(status.latency_max_s(), 1e-3);
}

TEST(Exchange, InLockstepTakesTheAnswerToItsOwnSampleAlone) {
  Rig rig(true);
  rig.exchange.send_sample();
  const GestureMessage first = rig.answer(1.0);
  rig.channel.waiting.push_back(first);
  ASSERT_TRUE(rig.exchange.await_answer(nanoseconds(1)));
  rig.exchange.step();
  rig.exchange.send_sample();

  rig.channel.waiting.push_back(first);
  EXPECT_FALSE(rig.exchange.await_answer(nanoseconds(1)));

  rig.channel.waiting.push_back(first);
  rig.channel.waiting.push_back(rig.answer(2.0));
  EXPECT_TRUE(rig.exchange.await_answer(nanoseconds(1)));
  rig.exchange.step();
  EXPECT_EQ(rig.driver.commands.back()[0], 2.0);
  EXPECT_EQ(rig.meter.dropped(), 2u);
}

TEST(Exchange, InLockstepRepeatsTheVerySameSample) {
  Rig rig(true);
  rig.exchange.send_sample();
  now_nsec += 100 * kPeriodNsec;

  rig.exchange.repeat_sample();

  ASSERT_EQ(rig.channel.sent.size(), 2u);
  EXPECT_EQ(rig.channel.sent[1].sample, rig.channel.sent[0].sample);
  EXPECT_EQ(rig.channel.sent[1].time_nsec, rig.channel.sent[0].time_nsec);
  EXPECT_EQ(rig.channel.sent[1].value, rig.channel.sent[0].value);
}

TEST(Exchange, InLockstepMotorsFadeInASilenceAndGrowAnewAfterIt) {
  Rig rig(true);
  rig.driver.motors = true;
  for (int n = 0; n < 3; ++n) rig.period(true, 12.0);
  ASSERT_EQ(rig.driver.commands.back()[0], 12.0);

  rig.exchange.send_sample();
  double before = 12.0;
  for (int n = 0; n < 60; ++n) {
    rig.exchange.age_answer();
    const double now = rig.driver.commands.back()[0];
    EXPECT_LE(before - now, 5.0 + 1e-12) << "the slew limit of a period";
    EXPECT_LE(now, before);
    before = now;
  }
  EXPECT_EQ(before, 0.0) << "older than the watchdog";

  rig.channel.waiting.push_back(rig.answer(12.0));
  ASSERT_TRUE(rig.exchange.await_answer(nanoseconds(1)));
  rig.exchange.step();
  EXPECT_LE(rig.driver.commands.back()[0], 5.0);
  EXPECT_EQ(rig.period(true, 12.0), 10.0);
}

TEST(Exchange, InLockstepDoesNotDependOnTheClock) {
  const auto commands_when_a_period_takes = [](std::int64_t nsec) {
    now_nsec = 0;
    Rig rig(true);
    for (int n = 0; n < 50; ++n) {
      rig.exchange.send_sample();
      now_nsec += nsec;
      rig.channel.waiting.push_back(rig.answer(std::sin(0.3 * n) * 30.0));
      EXPECT_TRUE(rig.exchange.await_answer(nanoseconds(1)));
      rig.exchange.step();
    }
    return rig.driver.commands;
  };

  EXPECT_EQ(commands_when_a_period_takes(1), commands_when_a_period_takes(3'000'000'000));
}

TEST(Exchange, FeelsEveryAnswerSoManyPeriodsLaterInLockstep) {
  for (const int delay : {0, 1, 3}) {
    now_nsec = 1000;
    DeviceConfig config = config_of_two_axes();
    config.limits.delay_periods = delay;
    Rig rig(true, Role::kMass, {kEpoch, 0}, config);
    for (int n = 1; n <= 8; ++n) {
      rig.exchange.send_sample();
      rig.channel.waiting.push_back(rig.answer(0.5 * n));
      ASSERT_TRUE(rig.exchange.await_answer(nanoseconds(1)));
      rig.exchange.step();
      EXPECT_DOUBLE_EQ(rig.driver.commands.back()[0], std::max(0.0, 0.5 * (n - delay))) << delay;
    }
  }
}

TEST(Exchange, PutsTheEndEffectorMapBetweenWireAndMotors) {
  now_nsec = 1000;
  DeviceConfig config = config_of_two_axes();
  config.end_effector_map = EndEffectorMap({{0.5, 0.5}}, 2);
  Rig rig(true, Role::kMass, {kEpoch, 0}, config);
  rig.exchange.send_sample();
  GestureMessage answer = rig.answer(3.0);
  answer.axis_count = 1;
  rig.channel.waiting.push_back(answer);
  ASSERT_TRUE(rig.exchange.await_answer(nanoseconds(1)));
  rig.exchange.step();
  rig.exchange.send_sample();

  EXPECT_EQ(rig.channel.sent.back().axis_count, 1u);
  EXPECT_DOUBLE_EQ(rig.channel.sent.back().value[0], -0.0005);  // half of -1 mm and 0
  EXPECT_DOUBLE_EQ(rig.driver.commands.back()[0], 1.5);
  EXPECT_DOUBLE_EQ(rig.driver.commands.back()[1], 1.5);
}

TEST(Exchange, IsLostWhileItsDriverHasNoDevice) {
  Rig rig(false);
  rig.period(true, 15.0);
  rig.period(true, 15.0);
  rig.driver.present = false;

  rig.period(true, 15.0);
  EXPECT_EQ(rig.meter.phase(), Phase::kLost);

  rig.driver.present = true;
  EXPECT_EQ(rig.period(true, 15.0), 0.0);
  EXPECT_EQ(rig.period(true, 15.0), 5.0);  // from zero again
  EXPECT_EQ(rig.meter.phase(), Phase::kRunning);
}

TEST(Exchange, SendsNothingWhileItsDriverHasNoDevice) {
  Rig rig(false);
  rig.period(true, 1.0);
  rig.driver.present = false;
  rig.period(true, 1.0);  // finds out
  ASSERT_EQ(rig.channel.sent.size(), 2u);

  rig.period(false);
  rig.driver.present = true;
  rig.period(false);
  EXPECT_EQ(rig.channel.sent.size(), 2u);
  rig.period(false);

  ASSERT_EQ(rig.channel.sent.size(), 3u);
  EXPECT_EQ(rig.channel.sent.back().sample, 3u) << "no number is missing";
}

TEST(Exchange, SendsNothingBeforeItsDriverHasADeviceThatSensesANumber) {
  for (const bool present : {false, true}) {
    Rig rig(false);
    rig.driver.present = present;
    rig.driver.lies = present;
    Exchange exchange({.config = rig.config,
                       .driver = rig.driver,
                       .channel = rig.channel,
                       .meter = rig.meter,
                       .role = Role::kMass,
                       .series = {kEpoch, 0},
                       .lockstep = false,
                       .clock = &now,
                       .since_boot = &since_boot});
    exchange.send_sample();
    EXPECT_TRUE(rig.channel.sent.empty()) << present;
  }
}

TEST(Exchange, StandsByWhileAnotherNodeIsAnswered) {
  Rig rig(false);
  const auto period_of_another = [&rig] {
    rig.exchange.send_sample();
    GestureMessage message = rig.answer(9.0);
    message.answered_epoch = kEpoch + 1;
    rig.channel.waiting.push_back(message);
    now_nsec += kPeriodNsec;
    rig.exchange.receive();
    rig.exchange.step();
    return rig.driver.commands.back()[0];
  };
  EXPECT_EQ(period_of_another(), 0.0);
  EXPECT_EQ(rig.meter.phase(), Phase::kStandby);

  rig.period(true, 1.0);
  EXPECT_EQ(rig.period(true, 1.0), 1.0);
  EXPECT_EQ(rig.meter.phase(), Phase::kRunning) << "it has taken over";

  for (int n = 0; n < 30; ++n) period_of_another();
  EXPECT_EQ(period_of_another(), 0.0);
  EXPECT_EQ(rig.meter.phase(), Phase::kStandby) << "and handed back";
}

TEST(Exchange, StopsItsDriverAtTheEnd) {
  const DeviceConfig config = config_of_two_axes();
  FakeDriver driver;
  FakeChannel channel;
  LoopMeter meter;
  {
    const Exchange exchange({.config = config,
                             .driver = driver,
                             .channel = channel,
                             .meter = meter,
                             .series = {kEpoch, 0},
                             .lockstep = false,
                             .clock = &now});
    EXPECT_FALSE(driver.stopped);
  }
  EXPECT_TRUE(driver.stopped);
}

TEST(Exchange, BeginsAnewAfterItStoodStillWhateverTheWatchdog) {
  now_nsec = 1'000'000'000;
  Rig rig(false, Role::kMass, {kEpoch, 0}, config_of_two_axes(/*watchdog_s=*/0.05));
  EXPECT_EQ(rig.period(true, 3.0), 3.0);

  now_nsec += 22 * kPeriodNsec;  // the board has let go, and the answers are not old yet

  EXPECT_EQ(rig.period(true, 3.0), 0.0);
  EXPECT_EQ(rig.driver.age, 0.05) << "a driver with a guard of its own restarts as well";
  EXPECT_EQ(rig.period(true, 3.0), 3.0);
}

TEST(Exchange, BeginsAnewAfterTheMachineHasSlept) {
  now_nsec = 1'000'000'000;
  Rig rig(false);
  EXPECT_EQ(rig.period(true, 3.0), 3.0);

  slept_nsec += 3'600'000'000'000;  // no time passes for the scene, but for a board

  EXPECT_EQ(rig.period(true, 3.0), 0.0);
  EXPECT_EQ(rig.period(true, 3.0), 3.0);
}

TEST(Exchange, LeavesWithoutAJumpOfForce) {
  now_nsec = 1'000'000'000;
  Rig rig(false);
  double before = 0.0;
  for (int n = 0; n < 8; ++n) before = rig.period(true, 20.0);
  EXPECT_EQ(before, 20.0);
  double age_before = rig.driver.age;
  rig.exchange.leave();

  int periods = 0;
  for (; !rig.exchange.has_left(); ++periods) {
    ASSERT_LT(periods, 10);
    rig.channel.waiting.push_back(rig.answer(20.0));  // is not taken
    now_nsec += kPeriodNsec;
    rig.exchange.step();
    EXPECT_LE(before - rig.driver.commands.back()[0], 5.0 + 1e-9);  // 5000 N/s
    EXPECT_GT(rig.driver.age, age_before) << "a driver with a guard of its own fades as well";
    before = rig.driver.commands.back()[0];
    age_before = rig.driver.age;
  }

  EXPECT_EQ(before, 0.0);
  EXPECT_EQ(periods, 4) << "20 N at 5000 N/s";
  EXPECT_EQ(rig.meter.phase(), Phase::kRunning) << "its loss is not reported";
}

TEST(Exchange, LeavesWithinHalfASecondHoweverSlowlyForcesMayFade) {
  now_nsec = 1'000'000'000;
  Rig rig(false, Role::kMass, {kEpoch, 0}, config_of_two_axes(/*watchdog_s=*/60.0));
  rig.config.force_guard.slew_n_per_s = 1.0;
  rig.period(true, 20.0);
  rig.exchange.leave();

  int periods = 0;
  for (; !rig.exchange.has_left() && periods < 1000; ++periods) {
    now_nsec += kPeriodNsec;
    rig.exchange.step();
  }

  EXPECT_NEAR(periods, 500, 1);
}

TEST(Exchange, LeavesAtOnceWhenNothingHoldsItsMotors) {
  now_nsec = 1'000'000'000;
  Rig rig(false);
  rig.period(false);

  rig.exchange.leave();

  EXPECT_TRUE(rig.exchange.has_left());
}

TEST(Exchange, CountsSamplesThatCouldNotBeSent) {
  Rig rig(true);
  rig.channel.works = false;

  rig.exchange.send_sample();
  rig.exchange.repeat_sample();

  EXPECT_EQ(rig.meter.dropped(), 2u);
}

TEST(Exchange, TenThousandAnswersOfAnyKindNeverReachTheDriverAboveLimitOrSlew) {
  now_nsec = 1000;
  std::mt19937_64 random(1990);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  Rig rig(false);
  double before = 0.0;
  int pushed = 0;

  for (int n = 0; n < 10000; ++n) {
    const double kind = share(random);
    double force = std::pow(10.0, 320.0 * share(random)) * (share(random) < 0.5 ? -1.0 : 1.0);
    if (kind < 0.05) force = std::nan("");
    if (kind > 0.5) force = 60.0 * share(random) - 30.0;
    rig.driver.present = kind > 0.001;
    rig.driver.lies = kind > 0.98;  // a sensor that is no number
    const double now = rig.period(share(random) < (n % 1000 < 900 ? 0.7 : 0.0), force);

    ASSERT_LE(std::abs(now), rig.config.force_guard.limit_n) << n;
    if (now != 0.0) {                                      // off is allowed at once
      ASSERT_LE(std::abs(now - before), 5.0 + 1e-9) << n;  // 5000 N/s
    }
    pushed += now != 0.0;
    before = now;
  }

  EXPECT_GT(pushed, 3000);
}

}  // namespace
}  // namespace cordis::device
