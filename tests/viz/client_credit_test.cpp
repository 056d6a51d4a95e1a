// tests/viz/client_credit_test.cpp
#include "viz_node/web/client_credit.h"

#include <gtest/gtest.h>

namespace cordis::viz {
namespace {

TEST(ClientCredit, LetsTwoFramesOutAndThenNoneUntilOneIsAcknowledged) {
  ClientCredit credit;
  ASSERT_TRUE(credit.may_send(1));
  credit.sent(1, 10);
  ASSERT_TRUE(credit.may_send(2));
  credit.sent(2, 20);

  EXPECT_FALSE(credit.may_send(3));
  EXPECT_EQ(credit.acknowledge(1), 10);
  EXPECT_TRUE(credit.may_send(3));
}

TEST(ClientCredit, SendsNoFrameTwice) {
  ClientCredit credit;
  credit.sent(7, 70);

  EXPECT_FALSE(credit.may_send(7));
  EXPECT_FALSE(credit.may_send(6));
  EXPECT_TRUE(credit.may_send(8));
}

TEST(ClientCredit, CountsTheFramesThatPassedItBy) {
  ClientCredit credit;
  credit.sent(100, 0);  // joined late: the 99 before do not count
  credit.sent(101, 0);
  EXPECT_EQ(credit.dropped(), 0u);

  credit.acknowledge(101);
  credit.sent(110, 0);

  EXPECT_EQ(credit.dropped(), 8u);
}

TEST(ClientCredit, TakesAnAcknowledgementForAllFramesUpToIt) {
  ClientCredit credit;
  credit.sent(1, 10);
  credit.sent(2, 20);

  EXPECT_EQ(credit.acknowledge(2), 20);
  EXPECT_EQ(credit.unacknowledged(), 0u);
}

TEST(ClientCredit, IgnoresAcknowledgementsOfFramesThatAreNotOnTheirWay) {
  ClientCredit credit;
  credit.sent(5, 50);

  EXPECT_EQ(credit.acknowledge(4), std::nullopt);
  EXPECT_EQ(credit.unacknowledged(), 1u);
  EXPECT_EQ(credit.acknowledge(5), 50);
  EXPECT_EQ(credit.acknowledge(5), std::nullopt);
  EXPECT_EQ(credit.unacknowledged(), 0u);
}

TEST(ClientCredit, GivesNoMoreCreditForAcknowledgingTheFuture) {
  ClientCredit credit;
  credit.sent(1, 10);
  credit.sent(2, 20);

  EXPECT_EQ(credit.acknowledge(4'000'000'000u), std::nullopt);
  EXPECT_EQ(credit.unacknowledged(), 0u);
  EXPECT_FALSE(credit.may_send(2));
  credit.sent(3, 30);
  credit.sent(4, 40);
  EXPECT_FALSE(credit.may_send(5));
}

}  // namespace
}  // namespace cordis::viz
