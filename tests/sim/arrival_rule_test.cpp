// tests/sim/arrival_rule_test.cpp -- ticks against devices of other rates, late and lost samples.
#include "sim_node/arrival_rule.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace cordis::sim {
namespace {

constexpr double kSceneRate = 1000.0;  // [Hz]
constexpr std::int64_t kScenePeriod = 1'000'000;
constexpr std::int64_t kRuleStart = 7'000'000'000;

/// A sample on its way.
struct Coming {
  std::int64_t at_nsec;
  std::size_t device;
  std::uint64_t number;
};

/// A tick: when it began, and the newest sample of each device by then.
struct Tick {
  std::int64_t at_nsec;
  std::vector<std::uint64_t> newest;
};

/// Plays what comes until it has come, as a scene does that wakes for each message.
std::vector<Tick> ticks_of(std::size_t device_count, std::vector<Coming> coming) {
  std::ranges::stable_sort(coming, {}, &Coming::at_nsec);
  ArrivalRule rule(kSceneRate, kRuleStart);
  std::vector<ArrivalRule::Device> devices(device_count);
  for (std::size_t i = 0; i < device_count; ++i) devices[i].id = static_cast<std::uint32_t>(i + 1);
  std::vector<Tick> ticks;
  std::int64_t now = kRuleStart;
  std::size_t next = 0;
  while (next < coming.size()) {
    rule.begin_wait(devices);
    while (!rule.is_due(devices, now)) {
      const std::int64_t end = rule.grid().end_nsec();
      if (next == coming.size() || coming[next].at_nsec > end) {
        now = end;
        continue;
      }
      now = std::max(now, coming[next].at_nsec);
      ArrivalRule::Device& device = devices[coming[next].device];
      device.sent = coming[next].number;
      device.plays = true;
      ++next;
    }
    EXPECT_EQ(rule.begin_tick(devices, now), 0u);
    ticks.push_back({now, {}});
    for (const ArrivalRule::Device& device : devices) ticks.back().newest.push_back(device.sent);
  }
  return ticks;
}

/// How long each sample of a device waited for the tick that played it [periods].
std::vector<double> waits_of(std::size_t device, const std::vector<Coming>& coming,
                             const std::vector<Tick>& ticks, std::uint64_t from) {
  std::vector<double> waits;
  for (const Coming& sample : coming) {
    if (sample.device != device || sample.number < from) continue;
    const auto played = std::ranges::lower_bound(
        ticks, sample.number, {}, [&](const Tick& tick) { return tick.newest[device]; });
    if (played == ticks.end()) continue;
    waits.push_back(static_cast<double>(played->at_nsec - sample.at_nsec) / kScenePeriod);
  }
  return waits;
}

double median(std::vector<double> values) {
  std::ranges::sort(values);
  return values.at(values.size() / 2);
}

/// Samples of devices of several rates for ten seconds, each with a phase of its own and jitter.
std::vector<Coming> samples_of(const std::vector<double>& rates) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> jitter(0.0, 0.02);
  std::vector<Coming> coming;
  for (std::size_t d = 0; d < rates.size(); ++d) {
    const auto count = static_cast<std::uint64_t>(10.0 * rates[d]);
    for (std::uint64_t n = 1; n <= count; ++n) {
      const double at_s =
          static_cast<double>(n) / rates[d] + 1e-5 * static_cast<double>(d) + 1e-3 * jitter(random);
      coming.push_back({kRuleStart + std::llround(at_s * 1e9), d, n});
    }
  }
  return coming;
}

TEST(ArrivalRule, ADeviceOfALowerRateDoesNotDelayTheOthers) {
  for (const std::vector<double>& rates :
       {std::vector<double>{1000.0, 250.0}, std::vector<double>{1000.0, 500.0, 1000.0},
        std::vector<double>{1000.0, 300.0}}) {
    const std::vector<Coming> coming = samples_of(rates);
    const std::vector<Tick> ticks = ticks_of(rates.size(), coming);
    for (std::size_t d = 0; d < rates.size(); ++d) {
      SCOPED_TRACE("device " + std::to_string(d) + " of " + std::to_string(rates[d]) + " Hz, of " +
                   std::to_string(rates.size()) + ", the last of " + std::to_string(rates.back()));
      if (rates[d] == 300.0) continue;  // comes in any phase, now and then after the tick
      const std::vector<double> waits = waits_of(d, coming, ticks, 100);
      ASSERT_GT(waits.size(), 1000u);
      EXPECT_LT(median(waits), 0.05);
      const auto held = std::ranges::count_if(waits, [](double wait) { return wait > 0.1; });
      EXPECT_LT(held,
                static_cast<std::ptrdiff_t>(waits.size() / (rates.back() == 300.0 ? 4 : 100)));
    }
  }
}

TEST(ArrivalRule, ASampleThatIsMoreThanHalfAPeriodLateCostsTheNextOneNothing) {
  std::vector<Coming> coming;
  for (std::uint64_t n = 1; n <= 9000; ++n) {
    const bool is_late = n > 1000 && n % 100 == 20;
    coming.push_back(
        {kRuleStart + static_cast<std::int64_t>(n) * kScenePeriod + (is_late ? 700'000 : 0), 0, n});
  }
  const std::vector<Tick> ticks = ticks_of(1, coming);

  int late = 0;
  for (std::size_t i = 1; i < ticks.size(); ++i) {
    const std::uint64_t number = ticks[i].newest[0];
    const std::uint64_t before = ticks[i - 1].newest[0];
    if (number <= 1000 || number == before) continue;
    const std::int64_t due = kRuleStart + static_cast<std::int64_t>(number) * kScenePeriod;
    EXPECT_EQ(ticks[i].at_nsec, due) << "sample " << number << " is answered on arrival";
    EXPECT_LE(number - before, before % 100 == 19 ? 2u : 1u) << number;
    late += number % 100 == 21 && before % 100 == 19;
  }
  EXPECT_EQ(late, 80) << "late ones are played with the next";
}

TEST(ArrivalRule, ALostSampleHoldsOneTickAndNoOther) {
  std::vector<Coming> coming;
  for (std::uint64_t n = 1; n <= 9000; ++n) {
    if (n > 1000 && n % 100 == 20) continue;
    coming.push_back({kRuleStart + static_cast<std::int64_t>(n) * kScenePeriod, 0, n});
  }
  const std::vector<Tick> ticks = ticks_of(1, coming);

  const std::vector<double> waits = waits_of(0, coming, ticks, 1001);
  ASSERT_GT(waits.size(), 7000u);
  EXPECT_EQ(*std::ranges::max_element(waits), 0.0);
}

TEST(ArrivalRule, ADeviceThatPausesIsOwedNoMoreThanTwo) {
  std::vector<Coming> coming;
  std::uint64_t number = 0;
  for (int n = 1; n <= 5000; ++n) {
    if (n > 1000 && n % 500 < 7) continue;  // it takes no samples meanwhile
    coming.push_back({kRuleStart + static_cast<std::int64_t>(n) * kScenePeriod, 0, ++number});
  }
  const std::vector<Tick> ticks = ticks_of(1, coming);

  const std::vector<double> waits = waits_of(0, coming, ticks, 1000);
  const auto held = std::ranges::count_if(waits, [](double wait) { return wait > 0.0; });
  EXPECT_LE(held, 2 * 9) << "two after each pause";
}

TEST(ArrivalRule, WaitsForNoDeviceThatIsSilent) {
  ArrivalRule rule(kSceneRate, kRuleStart);
  std::vector<ArrivalRule::Device> devices{{.id = 1, .sent = 0, .plays = true},
                                           {.id = 2, .sent = 0, .plays = true}};
  std::int64_t now = kRuleStart;
  const auto plays_on_arrival = [&](bool of_both) {
    rule.begin_wait(devices);
    now = std::max(now, rule.grid().begin_nsec()) + 1000;
    EXPECT_FALSE(rule.is_due(devices, now)) << "nothing has come";
    ++devices[0].sent;
    devices[1].sent += of_both ? 1 : 0;
    const bool is_due = rule.is_due(devices, now);
    if (!is_due) now = rule.grid().end_nsec();
    rule.begin_tick(devices, now);
    return is_due;
  };
  for (int n = 0; n < 100; ++n) EXPECT_TRUE(plays_on_arrival(true)) << n;

  for (int n = 0; n < 20; ++n)
    EXPECT_FALSE(plays_on_arrival(false)) << "it may only be late: " << n;
  devices[1].plays = false;
  plays_on_arrival(false);  // it was owed two
  for (int n = 0; n < 100; ++n) EXPECT_TRUE(plays_on_arrival(false)) << n;
}

/// A device beside a scene of 1000 Hz, which has sent a sample in every fourth period and in the last one.
struct SlowDevice {
  ArrivalRule rule{kSceneRate, kRuleStart};
  std::vector<ArrivalRule::Device> devices{{.id = 1, .sent = 0, .plays = true}};

  SlowDevice() {
    for (int n = 1; n <= 400; ++n) tick(n % 4 == 0);
  }
  /// @return true if the sample is played on arrival, in the middle of the period; else the tick comes at the end
  bool tick(bool sends, int periods_late = 0) {
    rule.begin_wait(devices);
    const std::int64_t middle = rule.grid().end_nsec() - kScenePeriod / 2;
    EXPECT_FALSE(rule.is_due(devices, middle - 1)) << "nothing has come";
    devices[0].sent += sends ? 1 : 0;
    const bool is_due = rule.is_due(devices, middle);
    const std::int64_t end = rule.grid().end_nsec() + periods_late * kScenePeriod;
    EXPECT_EQ(rule.begin_tick(devices, is_due ? middle : end),
              static_cast<std::uint64_t>(periods_late));
    return is_due;
  }
};

TEST(ArrivalRule, CountsSkippedPeriodsTowardsTheNextSampleOfASlowDevice) {
  SlowDevice slow;
  slow.tick(false, 2);  // stands for three periods
  EXPECT_TRUE(slow.tick(true)) << "the fourth period after the last sample";
  EXPECT_FALSE(slow.tick(true)) << "none is due in the next one";
}

TEST(ArrivalRule, KnowsNothingOfADeviceThatComesInPlaceOfAnother) {
  SlowDevice other;
  other.devices[0].id = 2;
  EXPECT_TRUE(other.tick(true)) << "it may send in every period";
  SlowDevice again;  // counted from the start, as in a scene that is loaded again
  again.devices[0].sent = 0;
  EXPECT_TRUE(again.tick(true));
}

TEST(ArrivalRule, RestartsAtAnotherRateAsIfItWereNew) {
  const std::int64_t now = kRuleStart + 123'456'789;
  ArrivalRule restarted(kSceneRate, kRuleStart);
  std::vector<ArrivalRule::Device> devices{{.id = 1, .sent = 5, .plays = true}};
  restarted.begin_wait(devices);
  restarted.begin_tick(devices, kRuleStart + kScenePeriod);

  restarted.restart(250.0, now);

  ArrivalRule fresh(250.0, now);
  EXPECT_EQ(restarted.grid().end_nsec(), fresh.grid().end_nsec());
  for (ArrivalRule* rule : {&restarted, &fresh}) rule->begin_wait(devices);
  EXPECT_EQ(restarted.is_due(devices, now + 1), fresh.is_due(devices, now + 1));
  devices[0].sent = 6;
  EXPECT_TRUE(restarted.is_due(devices, now + 1));
}

}  // namespace
}  // namespace cordis::sim
