// tests/sim/sample_sequence_test.cpp -- lost, repeated and older samples, and restarts.
#include "sim_node/devices/sample_sequence.h"

#include <cstdint>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace cordis::sim {
namespace {

using Order = SampleSequence::Order;

constexpr double kRateHz = 1000.0;
constexpr int kPatience = 20;
constexpr std::uint64_t kEpoch = 7;

std::int64_t time_of(std::uint64_t number) {
  return static_cast<std::int64_t>(number) * 1'000'000;
}

SampleSequence::Position receive(SampleSequence& sequence, std::uint64_t number,
                                 std::uint64_t epoch = kEpoch) {
  return sequence.receive(epoch, number, time_of(number));
}

TEST(SampleSequence, CountsEverySampleThatNeverCame) {
  for (std::uint32_t seed = 1; seed <= 200; ++seed) {
    std::mt19937 random(seed);
    SampleSequence sequence(kRateHz, kPatience);
    // Every other sequence passes 2^32, as a device at 1 kHz does after 50 days.
    std::uint64_t number =
        (seed % 2 == 0 ? 0 : (std::uint64_t{1} << 32) - 1000) + 1 + random() % 1000;
    std::uint64_t lost = 0;
    EXPECT_EQ(receive(sequence, number).order, Order::kNew);
    for (int n = 0; n < 300; ++n) {
      const bool is_long = random() % 20 == 0;
      const std::uint64_t on_the_way = random() % 3 == 0 ? random() % (is_long ? 999 : 10) : 0;
      lost += on_the_way;
      number += on_the_way + 1;
      const SampleSequence::Position position = receive(sequence, number);
      ASSERT_EQ(position.order, Order::kNew) << "seed " << seed;
      ASSERT_FALSE(position.restarts) << "seed " << seed;
      // The samples are 1 ms apart: the gap is one period longer than the lost samples.
      ASSERT_EQ(position.after_gap, on_the_way + 1 > kPatience) << "seed " << seed;
      ASSERT_EQ(receive(sequence, number).order, Order::kRepeated) << "seed " << seed;
    }
    ASSERT_EQ(sequence.lost_count(), lost) << "seed " << seed;
    ASSERT_EQ(sequence.number(), number) << "seed " << seed;
  }
}

TEST(SampleSequence, CountsOneSecondOfAJumpAndRestarts) {
  SampleSequence sequence(kRateHz, kPatience);
  receive(sequence, 1);
  const SampleSequence::Position position = sequence.receive(
      kEpoch, std::numeric_limits<std::uint64_t>::max(), std::numeric_limits<std::int64_t>::min());
  EXPECT_EQ(position.order, Order::kNew);
  EXPECT_TRUE(position.restarts);
  EXPECT_TRUE(position.after_gap) << "a time at the far end";
  EXPECT_EQ(sequence.lost_count(), 1000u);
}

TEST(SampleSequence, RestartsAfterAPatienceOfOlderSamples) {
  SampleSequence sequence(kRateHz, kPatience);
  receive(sequence, 500);
  for (std::uint64_t number = 1; number < kPatience; ++number)
    EXPECT_EQ(receive(sequence, number).order, Order::kOlder) << number;
  EXPECT_EQ(sequence.number(), 500u);
  const SampleSequence::Position position = receive(sequence, kPatience);
  EXPECT_EQ(position.order, Order::kNew);
  EXPECT_TRUE(position.restarts);
  EXPECT_EQ(receive(sequence, kPatience + 1).order, Order::kNew);
  EXPECT_EQ(sequence.lost_count(), 0u);
}

TEST(SampleSequence, ForgetsOlderSamplesWhenANewOneComes) {
  SampleSequence sequence(kRateHz, kPatience);
  receive(sequence, 500);
  for (std::uint64_t round = 0; round < 5; ++round) {
    for (std::uint64_t number = 1; number < kPatience; ++number)
      ASSERT_EQ(receive(sequence, number).order, Order::kOlder) << round;
    ASSERT_EQ(receive(sequence, 501 + round).order, Order::kNew) << round;
  }
}

TEST(SampleSequence, RestartsWithAnotherEpochAndLosesNothing) {
  SampleSequence sequence(kRateHz, kPatience);
  EXPECT_TRUE(receive(sequence, 500).restarts) << "the first sample";
  const SampleSequence::Position position = receive(sequence, 3, kEpoch + 1);
  EXPECT_EQ(position.order, Order::kNew);
  EXPECT_TRUE(position.restarts);
  EXPECT_FALSE(position.after_gap);
  EXPECT_EQ(sequence.lost_count(), 0u);
  EXPECT_EQ(sequence.epoch(), kEpoch + 1);
}

TEST(SampleSequence, ContinuesFromTheOneBefore) {
  SampleSequence before(kRateHz, kPatience);
  receive(before, 1);
  receive(before, 5);
  SampleSequence sequence(2000.0, kPatience);
  sequence.continue_from(before);
  EXPECT_EQ(receive(sequence, 5).order, Order::kRepeated);
  EXPECT_EQ(receive(sequence, 8).order, Order::kNew);
  EXPECT_EQ(sequence.lost_count(), 5u);  // 2, 3, 4; 6, 7
}

}  // namespace
}  // namespace cordis::sim
