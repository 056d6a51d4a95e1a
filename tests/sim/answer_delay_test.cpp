// tests/sim/answer_delay_test.cpp
#include "sim_node/devices/answer_delay.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "sim_node/checks/port_check.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/rounds.h"

namespace cordis::sim {
namespace {

constexpr std::int64_t kSecondNsec = 1'000'000'000;
constexpr std::uint64_t kMeasuredEpoch = 7;

/// Delays of a process of 1 kHz.
struct Measured {
  std::unique_ptr<AnswerDelays> delays;
  std::uint64_t samples = 0;
  std::uint64_t answers = 0;

  explicit Measured(double quantile = 0.95) : delays(std::make_unique<AnswerDelays>(quantile)) {
    delays->add(kMeasuredEpoch, 1000.0, 0);
  }
  void answer(double delay_s, int times = 1) {
    for (int i = 0; i < times; ++i) report(++answers, delay_s);
  }
  void report(std::uint64_t answered_sample, double delay_s) {
    delays->record(kMeasuredEpoch, {++samples, answered_sample, delay_s}, 0);
  }
  void lose(int count) { samples += static_cast<std::uint64_t>(count); }
  std::optional<double> at(std::int64_t now_nsec) {
    return delays->delay_s(kMeasuredEpoch, now_nsec);
  }
};

TEST(AnswerDelays, AreKnownAfterAThousandAnswers) {
  Measured measured;
  measured.answer(1e-4, 999);
  EXPECT_FALSE(measured.at(kSecondNsec));
  measured.answer(1e-4);
  ASSERT_TRUE(measured.at(kSecondNsec));
  EXPECT_GE(*measured.at(kSecondNsec), 1e-4);
  EXPECT_LE(*measured.at(kSecondNsec), 1e-4 * (1.0 + 1.0 / 32.0));
}

TEST(AnswerDelays, AreNeverLessThanTheQuantileOrTheMeanOfWhatWasMeasured) {
  std::mt19937_64 random(11);
  for (int round = 0; round < test::rounds(200); ++round) {
    const double quantile = std::uniform_real_distribution<double>(0.5, 1.0)(random);
    const double spread = std::uniform_real_distribution<double>(0.0, 1.5)(random);
    std::lognormal_distribution<double> delay(
        std::log(std::pow(10.0, std::uniform_real_distribution<double>(-6.0, -2.0)(random))),
        spread);
    Measured measured(quantile);
    std::vector<double> all(3000);
    for (double& one : all) {
      one = std::clamp(delay(random), kFastestAnswer, 1.0);
      measured.answer(one);
    }
    std::sort(all.begin(), all.end());
    const double mean = std::accumulate(all.begin(), all.end(), 0.0) / 3000.0;
    const double exact =
        std::max(mean, all[static_cast<std::size_t>(std::ceil(quantile * 3000.0)) - 1]);

    const double found = measured.at(kSecondNsec).value();

    EXPECT_GE(found, exact);
    EXPECT_LE(found, exact * (1.0 + 1.0 / 32.0) + std::ldexp(1.0, -20));
  }
}

TEST(AnswerDelays, BelieveNoNumberThatMakesNoSense) {
  Measured measured;
  for (const double bad : {0.0, -1e-4, std::nan(""), HUGE_VAL, -HUGE_VAL, 1e300, 1.001,
                           std::numeric_limits<double>::denorm_min() * -1.0}) {
    measured.answer(bad, 2000);
    for (int i = 0; i < 2000; ++i) measured.report(measured.answers, bad);
    measured.lose(20);
    measured.answer(bad);
  }
  EXPECT_FALSE(measured.at(kSecondNsec));
  measured.answer(1e-3, 1000);
  EXPECT_LE(measured.at(kSecondNsec).value(), 1.04e-3);
  measured.delays->record(8, {1, 1, 0.5}, 0);  // of an unknown process
  EXPECT_LE(measured.at(kSecondNsec).value(), 1.04e-3);
}

TEST(AnswerDelays, CountAPeriodMoreForEverySampleWithoutANewAnswer) {
  Measured measured;
  for (int i = 0; i < 1000; ++i) {
    measured.answer(1e-4);
    measured.report(measured.answers, 1e-4);
    measured.report(measured.answers, 1e-4);
  }
  EXPECT_GE(measured.at(kSecondNsec).value(), 2.1e-3);
  EXPECT_LE(measured.at(kSecondNsec).value(), 2.2e-3);
}

TEST(AnswerDelays, LeaveOutWhatComesAfterTheForceWasTakenOff) {
  Measured measured(1.0);
  measured.answer(1e-4, 2000);
  for (int i = 0; i < 500; ++i) measured.report(measured.answers, 1e-4);
  EXPECT_LE(measured.at(kSecondNsec).value(), 0.021);
}

TEST(AnswerDelays, CountABurstOfTenLostSamplesAsTen) {
  Measured measured;
  for (int i = 0; i < 20; ++i) {
    measured.answer(1e-4, 89);
    measured.lose(10);
    measured.answer(10.1e-3);  // the position before the burst was answered until now
  }
  // More than 5 of 100 samples are those of 2.1 to 10.1 ms.
  EXPECT_GE(measured.at(kSecondNsec).value(), 5e-3);
  EXPECT_LE(measured.at(kSecondNsec).value(), 7e-3);
}

/// The scene stalls for so long, takes the newest sample then, and answers at once again.
void stall(Measured& measured, double stall_s) {
  measured.lose(static_cast<int>(1000.0 * stall_s) - 1);
  measured.answer(stall_s);
}

TEST(AnswerDelays, CountAStallOfTheSceneAsOneLateAnswer) {
  std::mt19937_64 random(17);
  for (int round = 0; round < test::rounds(100); ++round) {
    const double stall_s = std::uniform_real_distribution<double>(0.05, 1.0)(random);
    Measured measured;
    measured.answer(1.5e-4, std::uniform_int_distribution<int>(1, 50)(random));
    stall(measured, stall_s);
    measured.answer(1.5e-4, 1000);
    const double at_start_s = measured.at(kSecondNsec).value();
    // At 20 lost samples, up to 20 ms, the force before was on the motors; the late answer counts once.
    const double expected_s = (stall_s + 0.5 * 0.0205 * 20.0) / 1000.0;
    EXPECT_GE(at_start_s, 1.5e-4 + expected_s / 1.1) << stall_s;
    EXPECT_LE(at_start_s, 1.5e-4 + expected_s * 1.1) << stall_s;
  }
}

TEST(AnswerDelays, AreNotShortenedByLostSamplesOfASlowLink) {
  Measured measured;
  for (int i = 0; i < 200; ++i) {
    measured.answer(0.05, 10);
    measured.lose(10);
    measured.answer(0.06);
  }
  EXPECT_GE(measured.at(kSecondNsec).value(), 0.059);
}

TEST(AnswerDelays, CountAPeriodMoreForEverySampleThatIsLostWithoutANewAnswer) {
  Measured measured;
  for (int i = 0; i < 500; ++i) {
    measured.answer(1e-4);
    measured.lose(3);
    measured.report(measured.answers, 1e-4);
  }
  EXPECT_GE(measured.at(kSecondNsec).value(), 4.1e-3);
  EXPECT_LE(measured.at(kSecondNsec).value(), 4.3e-3);
}

TEST(AnswerDelays, LeaveOutSamplesThatWereGivenNoAnswer) {
  Measured measured(1.0);
  measured.answer(1e-4, 2000);
  for (int i = 0; i < 250; ++i) {
    measured.lose(1);
    measured.delays->leave_out(kMeasuredEpoch, 0);
  }
  measured.answer(1e-4, 10);
  EXPECT_LE(measured.at(kSecondNsec).value(), 1.04e-4);
}

TEST(AnswerDelays, AreNeverShorterThanTheFastestAnswer) {
  Measured measured;
  measured.answer(1e-9, 2000);
  EXPECT_GE(measured.at(kSecondNsec).value(), kFastestAnswer);
}

TEST(AnswerDelays, AreNeverShorterThanTheSampleWasHere) {
  constexpr std::int64_t kHere = 300'000;  // [ns]
  constexpr std::uint64_t kBefore = 700;   // answers before the first sample: they have numbers of
                                           // their own
  Measured measured(1.0);
  for (std::uint64_t n = 1; n <= 2000; ++n) {
    const auto now = static_cast<std::int64_t>(n) * 1'000'000;
    measured.delays->record(kMeasuredEpoch, {n, kBefore + 2 * (n - 1), 50e-6}, now);
    measured.delays->answer(kMeasuredEpoch, n, kBefore + 2 * n, now + kHere);
    measured.delays->answer(kMeasuredEpoch, n, kBefore + 2 * n + 1, now + 900'000);  // once more
  }
  EXPECT_GE(measured.at(kSecondNsec).value(), 300e-6);
  EXPECT_LE(measured.at(kSecondNsec).value(), 310e-6);
}

TEST(AnswerDelays, OfAnotherProcessSayNothingOfThis) {
  Measured measured(1.0);
  measured.delays->record(5, {1, 0, 0.0}, 0);
  measured.delays->answer(5, 1, 1, 900'000'000);
  measured.delays->answer(kMeasuredEpoch, 1, 1, 900'000'000);  // a sample that was not taken
  measured.answer(1e-4, 2000);
  EXPECT_LE(measured.at(kSecondNsec).value(), 1.04e-4);
}

TEST(AnswerDelays, OfAPlayingProcessOutliveAnyNumberOfOthers) {
  Measured measured;
  std::uint64_t epoch = 100;
  for (std::int64_t now = 0; now < 20 * kSecondNsec; now += kSecondNsec) {
    for (int i = 0; i < 1000; ++i)
      measured.delays->record(kMeasuredEpoch, {++measured.samples, ++measured.answers, 1e-4}, now);
    for (int i = 0; i < 20; ++i) measured.delays->add(++epoch, 1000.0, now);
    ASSERT_TRUE(measured.at(now)) << now;
  }
  EXPECT_LE(*measured.at(19 * kSecondNsec), 1.04e-4);
  // Processes that have fallen silent make room.
  const std::int64_t later = 25 * kSecondNsec;
  measured.delays->add(5, 1000.0, later);
  for (std::uint64_t i = 1; i <= 1000; ++i) measured.delays->record(5, {i, i, 2e-4}, later);
  EXPECT_TRUE(measured.delays->delay_s(5, later));
}

TEST(AnswerDelays, AreForgottenWithinTenSeconds) {
  Measured measured;
  measured.at(kSecondNsec);
  measured.answer(8e-3, 2000);
  EXPECT_GT(measured.at(2 * kSecondNsec).value(), 7e-3);
  for (int second = 3; second <= 12; ++second) {
    measured.answer(1e-4, 1000);
    measured.at(second * kSecondNsec);
  }
  EXPECT_LT(measured.at(12 * kSecondNsec).value(), 1.1e-4);
  EXPECT_FALSE(measured.at(40 * kSecondNsec)) << "silent";
}

TEST(AnswerDelays, RiseWithinHalfASecondAfterTenSecondsOfQuickAnswers) {
  Measured measured;
  for (int second = 1; second <= 10; ++second) {
    measured.answer(1e-4, 1000);
    measured.at(second * kSecondNsec);
  }
  measured.answer(3e-3, 550);
  EXPECT_GT(measured.at(10 * kSecondNsec + kSecondNsec / 2).value(), 2.9e-3);
}

TEST(AnswerDelays, RecordWithoutAllocating) {
  Measured measured;
  const test::AllocationGuard guard;
  measured.answer(1e-4, 100);
  EXPECT_EQ(guard.count(), 0u);
}

TEST(DelayInUse, IsOnePeriodUntilMeasured) {
  DelayInUse delay;
  EXPECT_EQ(delay.periods(), 1.0);
  EXPECT_FALSE(delay.update({}, kSecondNsec));
  EXPECT_TRUE(delay.update(0.2, 2 * kSecondNsec));
  EXPECT_TRUE(delay.is_measured());
  EXPECT_NEAR(delay.periods(), 0.22, 1e-12);
  EXPECT_TRUE(delay.update({}, 3 * kSecondNsec)) << "silent";
  EXPECT_EQ(delay.periods(), 1.0);
}

TEST(DelayInUse, LeavesOutTheRoomForAnAnswerOfOnePeriod) {
  const auto counted = [](double measured) {
    DelayInUse delay;
    delay.update(measured, kSecondNsec);
    return delay.periods();
  };
  EXPECT_NEAR(counted(0.9), 0.99, 1e-12);
  EXPECT_EQ(counted(0.95), 1.0);
  EXPECT_EQ(counted(1.0), 1.0);
  EXPECT_EQ(counted(1.0376), 1.0376) << "up to 37 us of jitter at 1 kHz";
  EXPECT_NEAR(counted(1.06), 1.166, 1e-12);
}

TEST(DelayInUse, IsNeverLessThanMeasured) {
  std::mt19937_64 random(3);
  for (int round = 0; round < 200; ++round) {
    DelayInUse delay;
    double measured = 0.3;
    for (std::int64_t now = kSecondNsec; now < 100 * kSecondNsec; now += kSecondNsec / 4) {
      measured *= std::exp(std::normal_distribution<double>(0.0, 0.2)(random));
      const bool known = random() % 20 != 0;
      delay.update(known ? std::optional(measured) : std::nullopt, now);
      ASSERT_GE(delay.periods(), known ? measured : 1.0);
    }
  }
}

TEST(DelayInUse, DoesNotFlap) {
  std::mt19937_64 random(4);
  DelayInUse delay;
  int changes = 0;
  for (std::int64_t now = kSecondNsec; now < 300 * kSecondNsec; now += kSecondNsec / 4) {
    changes += delay.update(std::uniform_real_distribution<double>(0.2, 0.4)(random), now);
  }
  EXPECT_LE(changes, 4) << "up to the largest, and once down at most";
}

TEST(DelayInUse, FollowsDownAfterTenCalmSeconds) {
  DelayInUse delay;
  delay.update(2.0, kSecondNsec);
  for (std::int64_t now = 2 * kSecondNsec; now < 12 * kSecondNsec; now += kSecondNsec / 4) {
    EXPECT_FALSE(delay.update(0.1, now));
  }
  EXPECT_TRUE(delay.update(0.1, 12 * kSecondNsec));
  EXPECT_NEAR(delay.periods(), 0.11, 1e-12);
}

}  // namespace
}  // namespace cordis::sim
