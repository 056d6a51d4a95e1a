// tests/cli/traffic_test.cpp -- the rates that `cordis hz` prints.
#include "cli/hz/traffic.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace cordis::cli {
namespace {

constexpr std::int64_t kMsec = 1'000'000;

ReceivedMessage message(std::uint8_t writer, std::uint64_t sequence, std::int64_t msec) {
  ReceivedMessage received;
  received.writer[0] = writer;
  received.sequence = sequence;
  received.reception_nsec = msec * kMsec;
  received.source_nsec = received.reception_nsec - 1000;
  received.size = 100;
  return received;
}

TEST(Traffic, TheTimeOfAWriterBeginsWithItsFirstMessage) {
  Traffic traffic;
  for (std::uint64_t i = 0; i <= 50; ++i)
    traffic.add(message(1, 7 + i, 40 + 10 * static_cast<std::int64_t>(i)));

  EXPECT_DOUBLE_EQ(traffic.messages_per_s(540 * kMsec), 100.0);
  EXPECT_DOUBLE_EQ(traffic.bytes_per_s(540 * kMsec), 10000.0);
  EXPECT_EQ(traffic.missing(), 0u);

  traffic.begin_again(540 * kMsec);
  for (std::uint64_t i = 51; i <= 60; ++i)
    traffic.add(message(1, 7 + i, 40 + 10 * static_cast<std::int64_t>(i)));
  EXPECT_DOUBLE_EQ(traffic.messages_per_s(640 * kMsec), 100.0);
  EXPECT_DOUBLE_EQ(traffic.longest_s(), 0.01) << "the one over the table, too";
}

TEST(Traffic, LeavesOutWhatIsSentAgainToALateReader) {
  Traffic traffic;
  for (std::int64_t i = 0; i <= 200; ++i) {
    const auto sequence = static_cast<std::uint64_t>(i) + 1;
    // Written every 10 ms; the first hundred come at once, at 1000 ms.
    ReceivedMessage one = message(1, sequence, std::max<std::int64_t>(10 * i, 1000));
    one.source_nsec = 10 * i * kMsec;
    traffic.add(one);
  }
  EXPECT_NEAR(traffic.messages_per_s(2000 * kMsec), 100.0, 1.5);
  EXPECT_DOUBLE_EQ(traffic.shortest_s(), 0.01);
  EXPECT_DOUBLE_EQ(traffic.longest_s(), 0.01);
}

TEST(Traffic, CountsAWriterWhoseClockIsBehind) {
  Traffic traffic;
  for (std::int64_t i = 0; i <= 300; ++i) {
    ReceivedMessage one = message(1, static_cast<std::uint64_t>(i) + 1, 5000 + 10 * i);
    one.source_nsec = 10 * i * kMsec;
    traffic.add(one);
    if (i == 100) traffic.begin_again(6000 * kMsec);
  }
  EXPECT_NEAR(traffic.messages_per_s(8000 * kMsec), 100.0, 1.5);
}

TEST(Traffic, HasNoNegativeInterval) {
  Traffic traffic;
  for (const std::int64_t msec : {10, 30, 20, 40}) {
    ReceivedMessage one = message(1, 1, msec);
    one.source_nsec = 20 * kMsec;
    traffic.add(one);
  }
  EXPECT_DOUBLE_EQ(traffic.shortest_s(), 0.02);
}

TEST(Traffic, AddsUpTheRatesOfItsWriters) {
  Traffic traffic;
  for (std::int64_t i = 0; i <= 10; ++i) {
    traffic.add(message(1, static_cast<std::uint64_t>(i) + 1, 100 * i));
    if (i >= 5) traffic.add(message(2, static_cast<std::uint64_t>(i) + 1, 100 * i));
  }
  EXPECT_DOUBLE_EQ(traffic.messages_per_s(1000 * kMsec), 20.0);
}

TEST(Traffic, CountsWhatDidNotCome) {
  Traffic traffic;
  ReceivedMessage late = message(1, 7, 0);
  late.missing = 6;
  traffic.add(late);
  EXPECT_EQ(traffic.missing(), 0u) << "what was written before the first message that came";
  late = message(1, 11, 100);
  late.missing = 3;
  traffic.add(late);
  EXPECT_EQ(traffic.missing(), 3u);
  EXPECT_EQ(Traffic().messages_per_s(1000 * kMsec), 0.0);
}

}  // namespace
}  // namespace cordis::cli
