// tests/node/period_grid_test.cpp
#include "node/period_grid.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/rounds.h"

namespace cordis::node {
namespace {

constexpr double kRate = 1000.0;         // [Hz]
constexpr double kPeriod = 1e9 / kRate;  // [ns]

/// A sender with a clock of its own.
struct Sender {
  double phase = 0.0;   // of its samples [periods of the grid]
  double drift = 0.0;   // of its clock: +200e-6 is 200 ppm slow
  double jitter = 0.0;  // largest delay of a sample on its way [periods]
  double loss = 0.0;    // share of samples
  double rate = 1.0;    // samples per period
};

/// What came of a number of periods.
struct Played {
  std::vector<double> phases;  // of the ticks played on arrival, after the begin of the period
  std::uint64_t on_arrival = 0;
  std::uint64_t at_the_end = 0;
  std::uint64_t skipped = 0;
  double time_nsec = 0.0;  // that has passed
};

/// A loop that plays on arrival or at the end of the period, against one sender.
class Loop {
 public:
  Loop(const Sender& sender, std::uint64_t seed)
      : sender_(sender), random_(seed), grid_(kRate, kStart), begun_(grid_.begin_nsec()) {
    find_next();
  }

  Played play(int ticks) {
    Played played;
    const std::int64_t from = grid_.begin_nsec();
    std::int64_t before = from;
    for (int n = 0; n < ticks; ++n) {
      const std::int64_t begin = grid_.begin_nsec();
      const std::int64_t end = grid_.end_nsec();
      while (arrival_ < begin) find_next();  // after the tick of its period: for the next one
      const bool in_time = arrival_ < end;
      const std::int64_t now = in_time ? arrival_ : end;
      EXPECT_GE(now, begin) << "two ticks of a period";
      EXPECT_LE(now, end);
      EXPECT_GE(now, before);
      before = now;
      if (in_time) {
        played.phases.push_back(static_cast<double>(now - begin) / kPeriod);
        grid_.follow(now);
        find_next();
      }
      (in_time ? played.on_arrival : played.at_the_end) += 1;
      played.skipped += grid_.advance(now);
    }
    played.time_nsec = static_cast<double>(grid_.begin_nsec() - from);
    return played;
  }

 private:
  static constexpr std::int64_t kStart = 7'000'123'456'789;

  void find_next() {
    std::uniform_real_distribution<double> share(0.0, 1.0);
    do {
      const double sent = static_cast<double>(++number_) / sender_.rate * (1.0 + sender_.drift) +
                          sender_.phase + sender_.jitter * share(random_);
      arrival_ = begun_ + std::llround(sent * kPeriod);
    } while (share(random_) < sender_.loss);
  }

  Sender sender_;
  std::mt19937_64 random_;
  PeriodGrid grid_;
  std::int64_t begun_;
  std::int64_t number_ = 0;
  std::int64_t arrival_ = 0;
};

TEST(PeriodGrid, FollowsADeviceOfAnyPhaseAndAClockThatIsOffBy200Ppm) {
  for (const double drift : {-200e-6, 0.0, 200e-6}) {
    for (int phase = 0; phase < 20; ++phase) {
      SCOPED_TRACE("phase " + std::to_string(phase) + "/20, drift " + std::to_string(drift));
      Loop loop({.phase = phase / 20.0, .drift = drift}, 1);
      loop.play(500);  // to find the phase

      const Played played = loop.play(20'000);

      EXPECT_EQ(played.at_the_end, 0u);
      EXPECT_EQ(played.skipped, 0u);
      // The error of a first-order loop against a drift r is r / gain: 200 ppm x 16 = 0.32 %.
      for (const double played_phase : played.phases) ASSERT_NEAR(played_phase, 0.5, 0.004);
      EXPECT_NEAR(played.time_nsec / kPeriod, 20'000 * (1.0 + drift), 0.01);
    }
  }
}

TEST(PeriodGrid, PlaysOneTickInEachPeriodWhateverComes) {
  std::mt19937_64 random(1990);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  const int rounds = test::rounds(100);
  for (int round = 0; round < rounds; ++round) {
    const Sender sender{.phase = share(random),
                        .drift = 1e-3 * (share(random) - 0.5),
                        .jitter = 3.0 * share(random) * share(random),
                        .loss = share(random) < 0.3 ? 1.0 - share(random) * share(random) : 0.0,
                        .rate = share(random) < 0.2 ? 4.0 * share(random) + 0.1 : 1.0};
    SCOPED_TRACE("round " + std::to_string(round) + ": phase " + std::to_string(sender.phase) +
                 ", drift " + std::to_string(sender.drift) + ", jitter " +
                 std::to_string(sender.jitter) + ", loss " + std::to_string(sender.loss) +
                 ", rate " + std::to_string(sender.rate));
    constexpr int kTicks = 20'000;

    const Played played = Loop(sender, 5).play(kTicks);

    EXPECT_EQ(played.on_arrival + played.at_the_end, static_cast<std::uint64_t>(kTicks));
    EXPECT_EQ(played.skipped, 0u);
    EXPECT_NEAR(played.time_nsec / kPeriod, kTicks, 1.0 + kTicks * PeriodGrid::kLargestDrift);
  }
}

TEST(PeriodGrid, MovesByNoMoreThanOnePercentOfAPeriodAtOnce) {
  Loop loop({.phase = 0.95}, 1);
  double before = loop.play(1).time_nsec;
  for (int n = 0; n < 200; ++n) {
    const double now = loop.play(1).time_nsec;
    ASSERT_NEAR(now, kPeriod, PeriodGrid::kLargestShift * kPeriod + 1.0) << n;
    before = now;
  }
  EXPECT_NEAR(before, kPeriod, 1e-3 * kPeriod) << "it has arrived";
}

TEST(PeriodGrid, KeepsItsRateAgainstASenderOfTwiceTheRate) {
  const Played played = Loop({.phase = 0.1, .rate = 2.0}, 1).play(100'000);

  EXPECT_NEAR(played.time_nsec / kPeriod, 100'000, 1.0 + 100.0);
}

TEST(PeriodGrid, EndsAtTheMiddleBetweenWholeMultiplesWhenNothingComes) {
  PeriodGrid grid(kRate, 1'234'600'000);

  EXPECT_EQ(grid.end_nsec(), 1'235'500'000);
  EXPECT_EQ(grid.begin_nsec(), 1'234'500'000);
  EXPECT_EQ(grid.advance(1'235'500'001), 0u);
  EXPECT_EQ(grid.end_nsec(), 1'236'500'000);
}

TEST(PeriodGrid, SkipsThePeriodsThatATickMissed) {
  PeriodGrid grid(kRate, 1'234'600'000);

  EXPECT_EQ(grid.advance(1'236'499'999), 0u) << "less than a period late";
  EXPECT_EQ(grid.end_nsec(), 1'236'500'000);
  EXPECT_EQ(grid.advance(1'240'600'000), 4u);
  EXPECT_EQ(grid.end_nsec(), 1'241'500'000);
}

}  // namespace
}  // namespace cordis::node
