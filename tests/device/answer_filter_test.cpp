// tests/device/answer_filter_test.cpp -- no answer that cannot be one is taken, whatever is sent.
#include "device_node/answer_filter.h"

#include <random>

#include <gtest/gtest.h>

namespace cordis::device {
namespace {

constexpr std::uint64_t kOwnEpoch = 7;
constexpr std::uint64_t kFirstSample = 100;
constexpr std::int64_t kBegunNsec = 1'000'000;

GestureMessage answer_to(std::uint64_t sample, std::uint64_t number) {
  GestureMessage answer;
  answer.epoch = 1;
  answer.sample = number;
  answer.answered_epoch = kOwnEpoch;
  answer.answered_sample = sample;
  answer.answered_time_nsec = kBegunNsec;
  answer.axis_count = 1;
  return answer;
}

TEST(AnswerFilter, TakesNoAnswerThatIsForeignMalformedOrOlderThanTheOneBefore) {
  constexpr unsigned kSeed = 20131;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  std::mt19937 random(kSeed);
  const auto below = [&random](std::uint64_t bound) { return random() % bound; };
  int taken = 0;
  for (int series = 0; series < 200; ++series) {
    const bool lockstep = below(2) == 0;
    AnswerFilter filter({kOwnEpoch, kFirstSample, kBegunNsec}, lockstep, 0);
    std::uint64_t last_sample = kFirstSample;
    std::int64_t now_nsec = kBegunNsec;
    std::uint64_t newest = 0;
    for (int message = 0; message < 100; ++message) {
      last_sample += below(2);
      now_nsec += 1'000'000;
      GestureMessage answer = answer_to(last_sample - 3 + below(6), below(200));
      answer.epoch = 1 + below(2);
      answer.answered_epoch = below(4) == 0 ? below(9) : kOwnEpoch;
      answer.answered_time_nsec =
          now_nsec - 3'000'000 + static_cast<std::int64_t>(below(4'000'000));
      answer.axis_count = static_cast<std::uint32_t>(below(20));
      if (filter.consider(answer, last_sample, now_nsec) != AnswerFilter::Outcome::kTaken) continue;

      ++taken;
      EXPECT_EQ(answer.answered_epoch, kOwnEpoch);
      EXPECT_GE(answer.answered_sample, kFirstSample);
      EXPECT_LE(answer.answered_sample, last_sample);
      EXPECT_GE(answer.answered_time_nsec, kBegunNsec);
      EXPECT_LE(answer.answered_time_nsec, now_nsec);
      EXPECT_GE(answer.axis_count, 1u);
      EXPECT_LE(answer.axis_count, 16u);
      EXPECT_GE(answer.answered_sample, lockstep ? newest + 1 : newest);
      newest = answer.answered_sample;
      EXPECT_TRUE(filter.has_answered(newest));
    }
  }
  EXPECT_GT(taken, 1000);
}

TEST(AnswerFilter, UsesInLockstepTheAnswerSoManySamplesBefore) {
  constexpr int kDelay = 3;
  AnswerFilter filter({kOwnEpoch, 1, kBegunNsec}, true, kDelay);

  for (std::uint64_t sample = 1; sample <= 20; ++sample) {
    ASSERT_EQ(filter.consider(answer_to(sample, sample), sample, kBegunNsec),
              AnswerFilter::Outcome::kTaken);
    EXPECT_EQ(filter.newest().answered_sample, sample);
    EXPECT_EQ(filter.in_use().answered_sample, sample > kDelay ? sample - kDelay : 0);
  }
}

TEST(AnswerFilter, KnowsForAWhileThatAnotherNodeIsAnswered) {
  AnswerFilter filter({kOwnEpoch, kFirstSample, kBegunNsec}, false, 0);
  EXPECT_FALSE(filter.answers_another(1.0, kBegunNsec));

  GestureMessage foreign = answer_to(5, 1);
  foreign.answered_epoch = kOwnEpoch + 1;
  EXPECT_EQ(filter.consider(foreign, kFirstSample, kBegunNsec), AnswerFilter::Outcome::kForeign);

  EXPECT_TRUE(filter.answers_another(0.02, kBegunNsec + 19'000'000));
  EXPECT_FALSE(filter.answers_another(0.02, kBegunNsec + 21'000'000));
  EXPECT_FALSE(filter.has_any());
}

}  // namespace
}  // namespace cordis::device
