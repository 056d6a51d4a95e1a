// tests/viz/flow_credit_test.cpp
#include "viz_node/web/flow_credit.h"

#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/test_seed.h"

namespace cordis::viz {
namespace {

constexpr std::int64_t kBegin = 1'000'000'000'000;
constexpr std::int64_t kAckTimeout = FlowCredit::kAckTimeoutNsec;

TEST(FlowCredit, LetsTwoFramesOutAndThenNoneUntilOneIsAcknowledged) {
  FlowCredit credit;
  ASSERT_TRUE(credit.may_send(1, kBegin));
  credit.sent(1, 10, kBegin);
  ASSERT_TRUE(credit.may_send(2, kBegin));
  credit.sent(2, 20, kBegin);

  EXPECT_FALSE(credit.may_send(3, kBegin));
  EXPECT_EQ(credit.acknowledge(1), 10);
  EXPECT_TRUE(credit.may_send(3, kBegin));
}

TEST(FlowCredit, SendsNoFrameTwice) {
  FlowCredit credit;
  credit.sent(7, 70, kBegin);

  EXPECT_FALSE(credit.may_send(7, kBegin));
  EXPECT_FALSE(credit.may_send(6, kBegin));
  EXPECT_TRUE(credit.may_send(8, kBegin));
}

TEST(FlowCredit, CountsTheFramesThatPassedItBy) {
  FlowCredit credit;
  credit.sent(100, 0, kBegin);  // joined late: the 99 before do not count
  credit.sent(101, 0, kBegin);
  EXPECT_EQ(credit.dropped(), 0u);

  credit.acknowledge(101);
  credit.sent(110, 0, kBegin);

  EXPECT_EQ(credit.dropped(), 8u);
}

TEST(FlowCredit, SendsOneOfSoManyFramesAndCountsNoOtherAsDropped) {
  FlowCredit credit(4);
  ASSERT_TRUE(credit.may_send(2, kBegin));
  credit.sent(2, 0, kBegin);
  EXPECT_FALSE(credit.may_send(5, kBegin));
  ASSERT_TRUE(credit.may_send(6, kBegin));
  credit.sent(6, 0, kBegin);
  EXPECT_EQ(credit.dropped(), 0u);

  credit.acknowledge(6);
  credit.sent(13, 0, kBegin);
  EXPECT_EQ(credit.dropped(), 3u);
}

TEST(FlowCredit, TakesAnAcknowledgementForAllFramesUpToIt) {
  FlowCredit credit;
  credit.sent(1, 10, kBegin);
  credit.sent(2, 20, kBegin);

  EXPECT_EQ(credit.acknowledge(2), 20);
  EXPECT_EQ(credit.unacknowledged(), 0u);
}

TEST(FlowCredit, IgnoresAcknowledgementsOfFramesThatAreNotOnTheirWay) {
  FlowCredit credit;
  credit.sent(5, 50, kBegin);

  EXPECT_EQ(credit.acknowledge(4), std::nullopt);
  EXPECT_EQ(credit.unacknowledged(), 1u);
  EXPECT_EQ(credit.acknowledge(5), 50);
  EXPECT_EQ(credit.acknowledge(5), std::nullopt);
  EXPECT_EQ(credit.unacknowledged(), 0u);
}

TEST(FlowCredit, GivesNoMoreCreditForAcknowledgingTheFuture) {
  FlowCredit credit;
  credit.sent(1, 10, kBegin);
  credit.sent(2, 20, kBegin);

  EXPECT_EQ(credit.acknowledge(4'000'000'000u), std::nullopt);
  EXPECT_EQ(credit.unacknowledged(), 0u);
  EXPECT_FALSE(credit.may_send(2, kBegin));
  credit.sent(3, 30, kBegin);
  credit.sent(4, 40, kBegin);
  EXPECT_FALSE(credit.may_send(5, kBegin));
}

TEST(FlowCredit, GivesUpTheOldestFrameThatIsNotAcknowledgedInTime) {
  FlowCredit credit;
  credit.sent(1, 10, kBegin);
  credit.sent(2, 20, kBegin);
  EXPECT_FALSE(credit.may_send(3, kBegin + kAckTimeout - 1));

  ASSERT_TRUE(credit.may_send(3, kBegin + kAckTimeout));
  credit.sent(3, 30, kBegin + kAckTimeout);

  EXPECT_FALSE(credit.may_send(4, kBegin + kAckTimeout)) << "one frame per time-out, no burst";
  EXPECT_EQ(credit.acknowledge(1), std::nullopt) << "given up";
  EXPECT_EQ(credit.acknowledge(3), 30);
  EXPECT_EQ(credit.unacknowledged(), 0u);
}

TEST(FlowCredit, HasAllOfItAgainAfterAReset) {
  FlowCredit credit;
  credit.sent(1, 10, kBegin);
  credit.sent(2, 20, kBegin);

  credit.reset();

  EXPECT_EQ(credit.acknowledge(2), std::nullopt) << "of the scene before";
  EXPECT_TRUE(credit.may_send(3, kBegin));
  EXPECT_FALSE(credit.may_send(2, kBegin)) << "no frame twice";
}

/// A client as bad as can be, and a server that sends it whatever it may: every frame that comes is
/// sent as soon as the credit allows.
struct OddClient {
  explicit OddClient(std::uint32_t seed) : random(seed) {}

  bool one_in(int n) { return std::uniform_int_distribution<int>(1, n)(random) == 1; }

  /// An acknowledgement of anything: early, late, twice, never sent.
  void acknowledge_anything() {
    const std::uint32_t range = one_in(10) ? 0xffffffffu : newest + 3;
    credit.acknowledge(std::uniform_int_distribution<std::uint32_t>(0, range)(random));
  }

  void one_event() {
    now_nsec += std::uniform_int_distribution<std::int64_t>(
        0, one_in(50) ? 2 * kAckTimeout : 40'000'000)(random);
    if (!one_in(4)) ++newest;
    if (credit.may_send(newest, now_nsec)) {
      credit.sent(newest, now_nsec, now_nsec);
      last_sent_nsec = now_nsec;
    }
    if (silent ? one_in(400) : one_in(100)) silent = !silent;
    if (!silent && one_in(2)) acknowledge_anything();
    if (one_in(60)) credit.reset();
  }

  std::mt19937 random;
  FlowCredit credit;
  std::uint32_t newest = 1;
  std::int64_t now_nsec = kBegin;
  std::int64_t last_sent_nsec = kBegin;
  bool silent = false;
};

TEST(FlowCredit, SendsAgainWithinTheTimeoutWhateverTheClientDoes) {
  const std::uint32_t seed = test::test_seed();
  SCOPED_TRACE("seed " + std::to_string(seed));
  for (std::uint32_t life = 0; life < 200; ++life) {
    OddClient client(seed + life);
    for (int i = 0; i < 500; ++i) {
      client.one_event();

      ASSERT_LE(client.credit.unacknowledged(), FlowCredit::kMaxUnacknowledged);
      ASSERT_TRUE(client.credit.may_send(client.newest + 1, client.last_sent_nsec + kAckTimeout))
          << "life " << life << ", event " << i;
    }
  }
}

TEST(FlowCredit, NeverSendsMoreThanTwoFramesPerTimeoutToAClientThatAcknowledgesNothing) {
  const std::uint32_t seed = test::test_seed();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  FlowCredit credit;
  std::int64_t now_nsec = kBegin;
  std::vector<std::int64_t> sent_nsec;
  for (std::uint32_t frame = 1; frame < 5000; ++frame) {
    now_nsec += std::uniform_int_distribution<std::int64_t>(0, 80'000'000)(random);
    if (!credit.may_send(frame, now_nsec)) continue;
    credit.sent(frame, now_nsec, now_nsec);
    sent_nsec.push_back(now_nsec);
  }

  for (std::size_t i = 2; i < sent_nsec.size(); ++i)
    ASSERT_GE(sent_nsec[i] - sent_nsec[i - 1], kAckTimeout) << "frame " << i;
  EXPECT_GT(sent_nsec.size(), 20u);
}

}  // namespace
}  // namespace cordis::viz
