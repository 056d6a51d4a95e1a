// tests/device/answer_poll_test.cpp
#include "device_node/answer_poll.h"

#include <gtest/gtest.h>

namespace cordis::device {
namespace {

using Wait = AnswerPoll::Wait;
using Verdict = AnswerPoll::Verdict;

/// One that has had its first answer.
AnswerPoll answered_once() {
  AnswerPoll poll;
  poll.record(Wait::kInTime);
  return poll;
}

/// Waits that poll, of so many in which an answer comes only to a loop that sleeps.
int polled_in_vain(AnswerPoll& poll, int waits) {
  int polled = 0;
  for (int n = 0; n < waits; ++n) {
    polled += poll.is_on();
    poll.record(poll.is_on() ? Wait::kLate : Wait::kInTime);
  }
  return polled;
}

/// Waits until it polls again.
int pause_of(AnswerPoll& poll) {
  int waits = 0;
  for (; !poll.is_on(); ++waits) poll.record(Wait::kInTime);
  return waits;
}

void fail(AnswerPoll& poll) {
  while (poll.is_on()) poll.record(Wait::kLate);
}

TEST(AnswerPoll, GoesOnWhileThreeOfFourAnswersCome) {
  AnswerPoll poll = answered_once();
  for (int n = 0; n < 1000; ++n) {
    ASSERT_TRUE(poll.is_on()) << n;
    poll.record(n % 4 == 0 ? Wait::kLate : Wait::kInTime);
  }
  EXPECT_EQ(poll.verdict(), Verdict::kPays);
}

TEST(AnswerPoll, EndsATrialAtItsNinthMiss) {
  AnswerPoll poll = answered_once();
  for (int n = 0; n < 9; ++n) {
    ASSERT_TRUE(poll.is_on()) << n;
    EXPECT_EQ(poll.record(Wait::kLate), n == 8) << "the verdict changes with the ninth";
  }
  EXPECT_FALSE(poll.is_on());
  EXPECT_EQ(poll.verdict(), Verdict::kFails);
}

TEST(AnswerPoll, PausesTwiceAsLongAfterEachTrialThatFailsUpToABound) {
  AnswerPoll poll = answered_once();
  for (const int expected : {250, 500, 1000, 2000, 4000, 8000, 16000, 16000, 16000}) {
    fail(poll);
    EXPECT_EQ(pause_of(poll), expected);
  }
}

TEST(AnswerPoll, PausesShortlyAgainAfterATrialThatHasPassed) {
  AnswerPoll poll = answered_once();
  for (int n = 0; n < 3; ++n) {
    fail(poll);
    pause_of(poll);
  }
  for (int n = 0; n < AnswerPoll::kTrial; ++n) poll.record(Wait::kInTime);
  ASSERT_EQ(poll.verdict(), Verdict::kPays);

  fail(poll);
  EXPECT_EQ(poll.verdict(), Verdict::kFails);
  EXPECT_EQ(pause_of(poll), AnswerPoll::kPause);
}

TEST(AnswerPoll, PollsInOneOfAThousandWaitsWhereAnswersOnlyComeToALoopThatSleeps) {
  constexpr int kWaits = 1'000'000;
  AnswerPoll poll = answered_once();
  const int polled = polled_in_vain(poll, kWaits);

  EXPECT_LT(polled, kWaits / 1000);
  EXPECT_GT(polled, kWaits / 16009 * 9 - 1) << "it is tried again and again";
}

TEST(AnswerPoll, SleepsBesideASceneThatAnswersNothingAndHoldsNothingAgainstPolling) {
  AnswerPoll poll;
  for (int n = 0; n < 100; ++n) {
    EXPECT_FALSE(poll.is_on()) << "no answer has come yet";
    poll.record(Wait::kInVain);
  }
  poll.record(Wait::kInTime);
  EXPECT_TRUE(poll.is_on());
  EXPECT_EQ(poll.verdict(), Verdict::kNone);

  poll.record(Wait::kInVain);
  for (int n = 0; n < 5000; ++n) {
    EXPECT_FALSE(poll.is_on());
    poll.record(Wait::kInVain);
  }
  poll.record(Wait::kInTime);
  EXPECT_TRUE(poll.is_on());
  EXPECT_EQ(poll.verdict(), Verdict::kNone);
}

TEST(AnswerPoll, FailsWhenEverySecondWaitIsInVain) {
  AnswerPoll poll = answered_once();
  int polled = 0;
  while (poll.verdict() != Verdict::kFails && polled < 1000) {
    polled += poll.is_on();
    poll.record(poll.is_on() ? Wait::kInVain : Wait::kInTime);
  }
  EXPECT_EQ(polled, 9);
}

}  // namespace
}  // namespace cordis::device
