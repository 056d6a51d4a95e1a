// tests/device/realtime_exchange_test.cpp -- answers in the tick of their sample, late and lost.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <deque>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "device_node/drivers/mock.h"
#include "device_node/exchange.h"
#include "tests/support/rounds.h"

namespace cordis::device {
namespace {

constexpr std::int64_t kPeriodNs = 1'000'000;
constexpr double kPeriodS = 1e-3;
constexpr double kSlew = 5000.0;  // [N/s]

std::int64_t time_nsec = 0;
std::int64_t time_now() noexcept {
  return time_nsec;
}

/// A scene at the end of a wire: its answers come when the test says. Waiting takes time.
class TimedChannel : public GestureChannel {
 public:
  struct Coming {
    std::int64_t at_nsec;
    GestureMessage answer;
  };

  bool send(const GestureMessage& sample) noexcept override {
    sent.push_back(sample);
    return true;
  }
  bool receive(GestureMessage& answer, std::chrono::nanoseconds at_most) noexcept override {
    const std::int64_t until = time_nsec + at_most.count();
    if (coming.empty() || coming.front().at_nsec > until) {
      time_nsec = until;
      return false;
    }
    time_nsec = std::max(time_nsec, coming.front().at_nsec);
    answer = coming.front().answer;
    coming.pop_front();
    return true;
  }

  /// The answer to the sample sent last, so long after it.
  void answer_newest(double value, std::int64_t after_nsec) {
    answer(sent.back(), value, after_nsec);
  }
  /// So long after the newest sample.
  void answer(const GestureMessage& sample, double value, std::int64_t after_nsec) {
    GestureMessage message;
    message.epoch = 5;
    message.sample = ++answers;
    message.answered_epoch = sample.epoch;
    message.answered_sample = sample.sample;
    message.answered_time_nsec = sample.time_nsec;
    message.time_nsec = sent.back().time_nsec + after_nsec;
    message.axis_count = 1;
    message.value[0] = value;
    coming.push_back({sent.back().time_nsec + after_nsec, message});
    std::ranges::stable_sort(coming, {}, &Coming::at_nsec);
  }

  std::vector<GestureMessage> sent;
  std::deque<Coming> coming;
  std::uint64_t answers = 0;
};

/// A device that changes its command within a period, and remembers when.
class PromptDriver : public Driver {
 public:
  struct Command {
    std::int64_t at_nsec;
    double value;
    double share;
  };

  bool can_play(Role) const noexcept override { return true; }
  void start(Role) noexcept override {}
  bool read(AxisValues& sensed) noexcept override {
    sensed.fill(0.0);
    sensed[0] = -0.001 * periods;
    time_nsec += reading_nsec;
    return true;
  }
  bool write(const AxisValues&) noexcept override {
    ++writes;
    return true;
  }
  bool changes_within_period() const noexcept override { return true; }
  bool begin_period() noexcept override {
    ++periods;
    return true;
  }
  bool change_command(const AxisValues& commanded, double share) noexcept override {
    commands.push_back({time_nsec, commanded[0], share});
    return commands.size() != refused;
  }
  void stop() noexcept override {}

  std::vector<Command> commands;
  std::size_t refused = 0;        // the one of this number fails, from 1
  std::int64_t reading_nsec = 0;  // how long the sensors take
  int periods = 0;
  int writes = 0;
};

DeviceConfig prompt_config() {
  DeviceConfig config;
  config.layout.count = 1;
  config.end_effector_map = EndEffectorMap(1);
  config.force_guard.ramp_s = 0.0;
  config.force_guard.slew_n_per_s = kSlew;
  config.position_guard.ramp_s = 0.0;
  return config;
}

/// An exchange, and what answers it: the sample of each period in so many nanoseconds; below 0 never.
struct PromptRig {
  explicit PromptRig(Role role = Role::kMass, std::int64_t repeat_nsec = 0)
      : exchange({.config = config,
                  .driver = driver,
                  .channel = channel,
                  .meter = meter,
                  .role = role,
                  .series = {77, 0},
                  .lockstep = false,
                  .clock = &time_now,
                  .repeat_nsec = repeat_nsec}) {}

  /// Slow motion: periods are so many times longer.
  void slow_down(int times) {
    period_nsec = times * kPeriodNs;
    exchange.set_time_scale(1.0 / times);
  }

  /// One period from now on. The channel answers at once to what is sent, after a delay.
  void period(double value, std::int64_t answered_after_nsec) {
    const std::int64_t begin = time_nsec;
    next_value = value;
    next_after = answered_after_nsec;
    channel.rig = this;
    exchange.play_period();
    exchange.use_late_answer(begin + period_nsec - 50'000);
    time_nsec = std::max(time_nsec, begin + period_nsec);
  }

  class Channel final : public TimedChannel {
   public:
    bool send(const GestureMessage& sample) noexcept override {
      sent.push_back(sample);
      if (rig == nullptr || rig->next_after < 0) return true;
      answer(sent[sent.size() - 1 - rig->next_lost], rig->next_value, rig->next_after);
      return true;
    }
    PromptRig* rig = nullptr;
  };

  DeviceConfig config = prompt_config();
  PromptDriver driver;
  Channel channel;
  LoopMeter meter;
  std::int64_t period_nsec = kPeriodNs;
  double next_value = 0.0;
  std::int64_t next_after = -1;
  std::size_t next_lost = 0;  // newest samples that the scene does not get
  Exchange exchange;
};

TEST(RealtimeExchange, AnswersGoToTheMotorsInTheTickOfTheirSample) {
  time_nsec = 1'000'000'000;
  PromptRig rig;

  rig.period(3.0, 120'000);
  rig.period(4.0, 250'000);

  ASSERT_EQ(rig.driver.commands.size(), 2u);
  EXPECT_EQ(rig.driver.commands[0].at_nsec, 1'000'120'000);
  EXPECT_DOUBLE_EQ(rig.driver.commands[0].share, 0.12);
  EXPECT_EQ(rig.driver.commands[0].value, 3.0);
  EXPECT_EQ(rig.driver.commands[1].at_nsec, 1'001'250'000);
  EXPECT_EQ(rig.driver.commands[1].value, 4.0);
  EXPECT_EQ(rig.driver.writes, 0) << "no whole period is played at once";
}

/// Periods of 100 ms are longer than any watchdog, and than what counts as a stall of the loop.
TEST(RealtimeExchange, InSlowMotionAgesCountInSimulatedTime) {
  time_nsec = 1'000'000'000;
  PromptRig rig;
  for (int i = 0; i < 5; ++i) rig.period(3.0, 120'000);
  rig.slow_down(100);
  for (int i = 0; i < 5; ++i) {
    rig.period(3.0, 12'000'000);
    EXPECT_EQ(rig.driver.commands.back().value, 3.0) << i;
    EXPECT_NEAR(rig.driver.commands.back().share, 0.12, 1e-9);
    EXPECT_EQ(rig.meter.phase(), Phase::kRunning) << i;
  }
  EXPECT_NEAR(rig.channel.sent.back().answer_delay_s, 120e-6, 1e-9);

  rig.slow_down(1);
  for (int i = 0; i < 5; ++i) {
    rig.period(3.0, 120'000);
    EXPECT_EQ(rig.driver.commands.back().value, 3.0) << i;
    EXPECT_EQ(rig.meter.phase(), Phase::kRunning) << i;
  }

  rig.slow_down(100);
  for (int i = 0; i < 40; ++i) rig.period(3.0, -1);
  EXPECT_EQ(rig.driver.commands.back().value, 0.0) << "a scene that is silent is still noticed";
  EXPECT_EQ(rig.meter.phase(), Phase::kLost);
}

/// A standby takes over 20 ms after a sample.
TEST(RealtimeExchange, InSlowMotionRepeatsItsSampleWhereAStandbyWouldTakeOver) {
  constexpr std::int64_t kRepeat = 5'000'000;
  time_nsec = 1'000'000'000;
  PromptRig rig(Role::kMass, kRepeat);
  rig.period(3.0, 120'000);
  rig.exchange.hold_port();
  EXPECT_EQ(rig.channel.sent.size(), 1u) << "not in real time";

  rig.slow_down(100);
  rig.exchange.hold_port();
  EXPECT_EQ(rig.channel.sent.size(), 1u) << "nothing of the slow pace is sent yet";
  rig.period(3.0, 120'000);
  rig.exchange.hold_port();
  ASSERT_EQ(rig.channel.sent.size(), 3u);
  EXPECT_EQ(rig.channel.sent[2].sample, rig.channel.sent[1].sample);

  rig.period(3.0, -1);  // it waits for an answer, and repeats its sample meanwhile
  EXPECT_GE(rig.channel.sent.size(), 3u + 100'000'000 / kRepeat - 2u);
  EXPECT_EQ(rig.channel.sent.back().sample, rig.channel.sent[2].sample + 1);

  PromptRig alone;
  alone.slow_down(100);
  alone.period(3.0, -1);
  alone.exchange.hold_port();
  EXPECT_EQ(alone.channel.sent.size(), 1u) << "where no standby waits";
}

TEST(RealtimeExchange, SamplesSayWhenTheSensorsWereReadAndHowOldTheirAnswerWas) {
  time_nsec = 1'000'000'000;
  PromptRig rig;
  rig.period(3.0, -1);
  rig.period(3.0, 120'000);
  rig.period(3.0, -1);
  rig.period(3.0, 70'000);
  rig.period(3.0, -1);

  const std::vector<GestureMessage>& sent = rig.channel.sent;
  ASSERT_EQ(sent.size(), 5u);
  EXPECT_EQ(sent[1].time_nsec, 1'001'000'000);
  EXPECT_EQ(sent[0].answer_delay_s, 0.0);
  EXPECT_EQ(sent[1].answer_delay_s, 0.0) << "there has been no answer yet";
  EXPECT_DOUBLE_EQ(sent[2].answer_delay_s, 120e-6);
  EXPECT_DOUBLE_EQ(sent[3].answer_delay_s, 120e-6) << "of the newest answer";
  EXPECT_DOUBLE_EQ(sent[4].answer_delay_s, 70e-6);
  EXPECT_EQ(sent[2].answered_sample, 1u);
  EXPECT_EQ(sent[4].answered_sample, 2u);
}

TEST(RealtimeExchange, TheAgeOfASampleCountsFromTheBeginningOfItsReading) {
  time_nsec = 1'000'000'000;
  PromptRig rig;
  rig.driver.reading_nsec = 40'000;

  rig.period(3.0, 120'000);
  rig.period(3.0, 120'000);

  ASSERT_EQ(rig.channel.sent.size(), 2u);
  EXPECT_EQ(rig.channel.sent[0].time_nsec, 1'000'000'000);
  EXPECT_EQ(rig.channel.sent[1].time_nsec, 1'001'000'000);
}

TEST(RealtimeExchange, AnAnswerToAnOldSampleOnceMoreSaysHowOldItIsNow) {
  time_nsec = 1'000'000'000;
  PromptRig rig;
  rig.period(3.0, 120'000);
  for (rig.next_lost = 1; rig.next_lost <= 3; ++rig.next_lost) rig.period(3.0, 120'000);
  rig.next_lost = 0;
  rig.period(3.0, 120'000);
  rig.period(3.0, 120'000);

  const std::vector<GestureMessage>& sent = rig.channel.sent;
  EXPECT_DOUBLE_EQ(sent[1].answer_delay_s, 120e-6);
  EXPECT_DOUBLE_EQ(sent[2].answer_delay_s, 1120e-6);
  EXPECT_DOUBLE_EQ(sent[3].answer_delay_s, 2120e-6);
  EXPECT_DOUBLE_EQ(sent[4].answer_delay_s, 3120e-6);
  EXPECT_DOUBLE_EQ(sent[5].answer_delay_s, 120e-6);
  rig.meter.publish_latency();
  msg::NodeStatus status;
  rig.meter.fill(status);
  EXPECT_EQ(status.latency_count(), 3u) << "of the first answer to a sample alone";
}

TEST(RealtimeExchange, MotorsWaitForHalfAPeriodAndTakeALateAnswerAsSoonAsItComes) {
  time_nsec = 1'000'000'000;
  PromptRig rig;
  rig.period(3.0, 100'000);

  rig.period(4.0, 800'000);

  ASSERT_EQ(rig.driver.commands.size(), 3u);
  EXPECT_EQ(rig.driver.commands[1].at_nsec, 1'001'500'000);
  EXPECT_EQ(rig.driver.commands[1].value, 3.0);
  EXPECT_EQ(rig.driver.commands[2].at_nsec, 1'001'800'000);
  EXPECT_EQ(rig.driver.commands[2].value, 4.0);
}

TEST(RealtimeExchange, AnAnswerThatComesInTheNextPeriodServesUntilThatOfItsOwn) {
  time_nsec = 1'000'000'000;
  PromptRig rig;
  rig.period(3.0, 100'000);
  rig.period(4.0, 1'200'000);
  rig.period(5.0, 400'000);

  ASSERT_EQ(rig.driver.commands.size(), 4u);
  EXPECT_EQ(rig.driver.commands[1].at_nsec, 1'001'500'000);
  EXPECT_EQ(rig.driver.commands[1].value, 3.0);
  EXPECT_EQ(rig.driver.commands[2].at_nsec, 1'002'200'000);
  EXPECT_EQ(rig.driver.commands[2].value, 4.0);
  EXPECT_EQ(rig.driver.commands[3].at_nsec, 1'002'400'000);
  EXPECT_EQ(rig.driver.commands[3].value, 5.0);
}

TEST(RealtimeExchange, ALatePositionIsReachedInTheNextPeriod) {
  time_nsec = 1'000'000'000;
  PromptRig rig(Role::kLiaison);
  rig.period(-0.001, 100'000);
  rig.period(-0.002, 800'000);
  ASSERT_EQ(rig.driver.commands.size(), 2u);
  EXPECT_EQ(rig.driver.commands[1].value, -0.001);

  rig.period(-0.0025, 100'000);
  rig.period(0.0, -1);

  ASSERT_EQ(rig.driver.commands.size(), 5u);
  EXPECT_EQ(rig.driver.commands[2].at_nsec, 1'002'000'000);
  EXPECT_EQ(rig.driver.commands[2].value, -0.002);
  EXPECT_EQ(rig.driver.commands[3].value, -0.0025);
  EXPECT_EQ(rig.channel.sent[2].answered_sample, 1u) << "the late one was not at the motors yet";
  EXPECT_EQ(rig.channel.sent[3].answered_sample, 3u);
}

TEST(RealtimeExchange, TwoPositionsOfAPeriodStayWithinTheSpeedOfOne) {
  time_nsec = 1'000'000'000;
  PromptRig rig(Role::kLiaison);
  rig.period(0.0, 100'000);
  rig.period(-0.03, 800'000);
  rig.period(-0.02, 100'000);  // 2 mm in a period of 1 ms, at 2 m/s

  ASSERT_EQ(rig.driver.commands.size(), 4u);
  EXPECT_NEAR(rig.driver.commands[2].value, -0.002, 1e-15);
  EXPECT_NEAR(rig.driver.commands[3].value, -0.002, 1e-15);
}

TEST(RealtimeExchange, ADriverThatRefusesOneOfTwoCommandsHasNoDeviceInThatPeriod) {
  for (const std::size_t which : {1u, 2u}) {
    SCOPED_TRACE(which);
    time_nsec = 1'000'000'000;
    PromptRig rig;
    rig.period(1.0, 100'000);
    rig.period(1.0, 100'000);
    rig.driver.refused = 2 + which;
    rig.period(1.0, 900'000);  // one at half of the period, and one for the answer
    ASSERT_EQ(rig.driver.commands.size(), 4u);
    ASSERT_EQ(rig.channel.sent.size(), 3u);

    rig.period(1.0, 100'000);
    EXPECT_EQ(rig.channel.sent.size(), 3u) << "nothing is sent";
    EXPECT_EQ(rig.meter.phase(), Phase::kLost);
    rig.period(1.0, 100'000);
    EXPECT_EQ(rig.channel.sent.size(), 4u);
  }
}

TEST(RealtimeExchange, TwoCommandsOfAPeriodStayWithinTheSlewOfOne) {
  time_nsec = 1'000'000'000;
  PromptRig rig;
  rig.period(0.0, 100'000);
  rig.period(10.0, 300'000);   // 5 N of them in this period
  rig.period(-10.0, 900'000);  // on to 10 N, and nothing is left to go back
  rig.period(-10.0, 100'000);  // 0.6 ms after the change: 3 N

  ASSERT_EQ(rig.driver.commands.size(), 5u);
  EXPECT_DOUBLE_EQ(rig.driver.commands[1].value, 5.0);
  EXPECT_DOUBLE_EQ(rig.driver.commands[2].value, 10.0);
  EXPECT_DOUBLE_EQ(rig.driver.commands[3].value, 10.0);
  EXPECT_DOUBLE_EQ(rig.driver.commands[4].value, 7.0);
}

TEST(RealtimeExchange, TwoCommandsOnBothSidesOfABorderOfPeriodsStayWithinTheSlewOfTheirTime) {
  time_nsec = 1'000'000'000;
  PromptRig rig;
  rig.period(0.0, 20'000);
  rig.period(0.0, 20'000);
  const std::int64_t last = rig.channel.sent.back().time_nsec;
  rig.channel.rig = nullptr;
  rig.exchange.play_period();
  rig.channel.answer_newest(20.0, 950'000);
  rig.exchange.use_late_answer(last + 2 * kPeriodNs);
  time_nsec = last + 2 * kPeriodNs;
  rig.period(20.0, 20'000);

  const std::vector<PromptDriver::Command>& commands = rig.driver.commands;
  ASSERT_GE(commands.size(), 2u);
  const PromptDriver::Command& first = commands[commands.size() - 2];
  const PromptDriver::Command& second = commands.back();
  ASSERT_EQ(second.at_nsec - first.at_nsec, 70'000);
  EXPECT_DOUBLE_EQ(first.value, 5.0);
  EXPECT_NEAR(second.value - first.value, kSlew * 70e-6, 1e-9);
}

/// No two of the commands are further apart than the time between them and one period allow.
double largest_excess(const std::vector<PromptDriver::Command>& commands, double per_s) {
  double excess = 0.0;
  for (std::size_t i = 1; i < commands.size(); ++i) {
    double changed = 0.0;
    for (std::size_t j = i; j > 0 && j + 20 > i; --j) {
      changed += std::abs(commands[j].value - commands[j - 1].value);
      const double span_s = static_cast<double>(commands[i].at_nsec - commands[j].at_nsec) * 1e-9;
      excess = std::max(excess, changed - per_s * (span_s + kPeriodS));
    }
  }
  return excess;
}

TEST(RealtimeExchange, NoSpanOfTimeHoldsMoreChangeThanItsOwnAndThatOfOnePeriod) {
  const int rounds = test::rounds(40);
  for (const Role role : {Role::kMass, Role::kLiaison}) {
    for (int round = 0; round < rounds; ++round) {
      SCOPED_TRACE("round " + std::to_string(round));
      std::mt19937_64 random(static_cast<std::uint64_t>(round));
      std::uniform_real_distribution<double> share(0.0, 1.0);
      time_nsec = 1'000'000'000;
      PromptRig rig(role);
      const bool is_mass = role == Role::kMass;
      for (int n = 0; n < 1000; ++n) {
        const double wanted = is_mass ? 40.0 * share(random) - 20.0 : -0.04 * share(random);
        rig.period(wanted, static_cast<std::int64_t>(share(random) * 1.2e6));
        time_nsec += share(random) < 0.3 ? static_cast<std::int64_t>(share(random) * 9e5) : 0;
      }

      ASSERT_GT(rig.driver.commands.size(), 900u);
      const double per_s = is_mass ? kSlew : rig.config.position_guard.speed_m_per_s;
      EXPECT_LE(largest_excess(rig.driver.commands, per_s), 1e-9);
    }
  }
}

TEST(RealtimeExchange, TheEnergyGivenIsThatOfTheForcesWhenTheyWereHeld) {
  time_nsec = 1'000'000'000;
  PromptRig rig;
  rig.period(2.0, 250'000);  // 2 N in three quarters of the period, in which the key goes down 1 mm
  rig.period(4.0, 500'000);  // then half a period of 2 N, and half of 4 N
  rig.period(4.0, 0);

  msg::NodeStatus status;
  rig.meter.fill(status);

  EXPECT_NEAR(status.port_energy_j(), -0.001 * (0.75 * 2.0 + 0.5 * 2.0 + 0.5 * 4.0), 1e-15);
}

TEST(RealtimeExchange, ForceIsZeroOnceItsSampleIsAsOldAsTheWatchdog) {
  time_nsec = 1'000'000'000;
  PromptRig rig;
  for (int n = 0; n < 5; ++n) rig.period(10.0, 100'000);
  const std::int64_t last = rig.channel.sent.back().time_nsec;
  for (int n = 0; n < 30; ++n) rig.period(10.0, -1);

  const double watchdog_s = rig.config.force_guard.watchdog_s;
  for (const PromptDriver::Command& command : rig.driver.commands) {
    const double age_s = static_cast<double>(command.at_nsec - last) * 1e-9;
    if (age_s <= 0.0) continue;
    EXPECT_LE(command.value, std::max(kSlew * (watchdog_s - age_s), 0.0) + 1e-9) << age_s;
  }
  EXPECT_EQ(rig.meter.phase(), Phase::kLost);
}

/// Whatever the answers hold, and however late they come or not at all.
TEST(RealtimeExchange, NoForceChangesFasterThanItsSlewAndNoAnswerIsUsedTwice) {
  const int rounds = test::rounds(40);
  for (int round = 0; round < rounds; ++round) {
    SCOPED_TRACE("round " + std::to_string(round));
    std::mt19937_64 random(static_cast<std::uint64_t>(round));
    std::uniform_real_distribution<double> share(0.0, 1.0);
    time_nsec = 1'000'000'000 + static_cast<std::int64_t>(share(random) * 1e6);
    PromptRig rig;
    const double typical = share(random);
    const double loss = 0.3 * share(random);
    for (int n = 0; n < 1000; ++n) {
      const double late = typical * 2.0 * share(random) + (share(random) < 0.05 ? 3.0 : 0.0);
      const bool lost = share(random) < loss;
      const std::size_t before = rig.driver.commands.size();
      const PromptDriver::Command held =
          before > 0 ? rig.driver.commands.back() : PromptDriver::Command{time_nsec, 0.0, 0.0};
      rig.period(share(random) < 0.02 ? std::nan("") : 60.0 * share(random) - 30.0,
                 lost ? -1 : static_cast<std::int64_t>(late * 1e6));
      if (share(random) < 0.01) time_nsec += static_cast<std::int64_t>(share(random) * 40e6);

      double changed = 0.0;
      double last = held.value;
      bool off = false;
      for (std::size_t i = before; i < rig.driver.commands.size(); ++i) {
        const double value = rig.driver.commands[i].value;
        ASSERT_LE(std::abs(value), rig.config.force_guard.limit_n);
        off = off || value == 0.0;  // the watchdog may take a force away at once
        changed += std::abs(value - std::exchange(last, value));
      }
      // What fades falls at the slew rate from one command to the other, however far apart they are.
      const double since_s =
          static_cast<double>(rig.driver.commands.back().at_nsec - held.at_nsec) * 1e-9;
      ASSERT_LE(off ? 0.0 : changed, kSlew * std::max(kPeriodS, since_s) + 1e-9) << n;
    }
    rig.meter.publish_latency();
    msg::NodeStatus status;
    rig.meter.fill(status);
    std::set<std::uint64_t> echoed;
    for (const GestureMessage& sample : rig.channel.sent)
      if (sample.answered_sample != 0) echoed.insert(sample.answered_sample);
    EXPECT_GE(status.latency_count(), echoed.size());
    EXPECT_LE(status.latency_count(), rig.channel.answers);
    std::uint64_t newest = 0;
    for (const GestureMessage& sample : rig.channel.sent) {
      ASSERT_GE(sample.answered_sample, newest) << "an answer came back";
      newest = sample.answered_sample;
    }
  }
}

/// A key without friction, which no hand touches.
MockSettings free_key() {
  MockSettings settings;
  settings.key.viscosity_n_s_per_m = 0.0;
  settings.key.friction_n = 0.0;
  return settings;
}

AxisValues axis(double value) {
  AxisValues values{};
  values[0] = value;
  return values;
}

TEST(RealtimeMock, AForceActsFromTheMomentOnAtWhichItIsGiven) {
  for (const double share : {0.0, 0.1, 0.33, 0.5, 0.987, 1.0}) {
    AxisLayout layout;
    layout.lowest_m = -1.0;
    layout.highest_m = 1.0;
    Mock mock(free_key(), layout);
    mock.start(Role::kMass);
    AxisValues sensed{};
    ASSERT_TRUE(mock.begin_period());
    ASSERT_TRUE(mock.change_command(axis(2.0), share));
    ASSERT_TRUE(mock.begin_period());
    ASSERT_TRUE(mock.read(sensed));
    const double first = sensed[0];
    ASSERT_TRUE(mock.change_command(axis(0.0), 0.0));
    ASSERT_TRUE(mock.begin_period());
    ASSERT_TRUE(mock.read(sensed));

    // Its speed is F (1 - share) T / m, and stays so without a force.
    const double speed = 2.0 * (1.0 - share) * 1e-3 / 0.05;
    EXPECT_NEAR(sensed[0] - first, speed * 1e-3, 1e-15) << share;
  }
}

TEST(RealtimeMock, LivesAsInLockstepWhenCommandsComeAtOnce) {
  for (const Role role : {Role::kMass, Role::kLiaison}) {
    MockSettings settings;
    settings.gesture = {Trajectory(0.0, {{0.1, 0.3, -0.02}}, Trajectory::Shape::kMinimumJerk, 0.0)};
    settings.played = {0};
    settings.position_sensor.noise = 1e-6;
    Mock whole(settings, AxisLayout{});
    Mock parts(settings, AxisLayout{});
    whole.start(role);
    parts.start(role);
    AxisValues one{};
    AxisValues other{};
    ASSERT_TRUE(parts.begin_period());
    for (int n = 0; n < 2000; ++n) {
      const AxisValues command =
          axis(role == Role::kMass ? std::sin(0.01 * n) : -0.01 + 0.01 * std::cos(0.01 * n));
      ASSERT_TRUE(whole.write(command));
      ASSERT_TRUE(parts.change_command(command, 0.0));
      ASSERT_TRUE(parts.begin_period());
      ASSERT_TRUE(whole.read(one));
      ASSERT_TRUE(parts.read(other));
      ASSERT_EQ(one, other) << n;
    }
  }
}

TEST(RealtimeMock, APositionIsReachedAtTheEndOfThePeriodInWhichItIsGiven) {
  MockSettings settings;
  settings.hand.mass_kg = 1e6;  // stays at 0, and holds the key with 2000 N/m
  settings.hand.holds = true;
  settings.gesture = {Trajectory(0.0, {}, Trajectory::Shape::kMinimumJerk, 0.0)};
  settings.played = {0};
  for (const double share : {0.0, 0.17, 0.5, 0.9}) {
    Mock mock(settings, AxisLayout{});
    mock.start(Role::kLiaison);
    ASSERT_TRUE(mock.begin_period());
    ASSERT_TRUE(mock.change_command(axis(-0.001), share));
    ASSERT_TRUE(mock.begin_period());
    ASSERT_TRUE(mock.change_command(axis(-0.001), share));
    ASSERT_TRUE(mock.begin_period());  // it has rested for a period

    AxisValues force{};
    ASSERT_TRUE(mock.read(force));
    EXPECT_NEAR(force[0], 2000.0 * 0.001, 1e-6) << share;
  }
}

}  // namespace
}  // namespace cordis::device
