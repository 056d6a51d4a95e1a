// tests/device/answer_poll_test.cpp
#include "device_node/answer_poll.h"

#include <gtest/gtest.h>

namespace cordis::device {
namespace {

TEST(AnswerPoll, GoesOnWhileItPays) {
  AnswerPoll poll;
  for (int n = 0; n < 1000; ++n) {
    EXPECT_TRUE(poll.is_on());
    poll.record(n % 8 != 0);  // seven of eight
  }
  EXPECT_TRUE(poll.pays());
}

TEST(AnswerPoll, RestsWhenAnswersOnlyComeToALoopThatSleeps) {
  AnswerPoll poll;
  int polled = 0;
  constexpr int kWaits = 100'000;
  for (int n = 0; n < kWaits; ++n) {
    polled += poll.is_on();
    poll.record(!poll.is_on());
  }
  EXPECT_FALSE(poll.pays());
  EXPECT_LE(polled, kWaits / AnswerPoll::kPause * AnswerPoll::kTrial + AnswerPoll::kTrial);
}

TEST(AnswerPoll, IsTriedAgain) {
  AnswerPoll poll;
  for (int n = 0; n < AnswerPoll::kTrial; ++n) poll.record(false);
  ASSERT_FALSE(poll.is_on());
  for (int n = 0; n < AnswerPoll::kPause; ++n) poll.record(false);
  ASSERT_TRUE(poll.is_on());
  for (int n = 0; n < AnswerPoll::kTrial; ++n) poll.record(true);
  EXPECT_TRUE(poll.is_on());
  EXPECT_TRUE(poll.pays());
}

}  // namespace
}  // namespace cordis::device
