// tests/record/sample_queue_test.cpp
#include "record_node/sample_queue.h"

#include <vector>

#include <gtest/gtest.h>

namespace cordis::record {
namespace {

using namespace std::chrono_literals;

std::vector<std::uint8_t> bytes(std::size_t count, std::uint8_t value) {
  return std::vector<std::uint8_t>(count, value);
}

TEST(SampleQueue, GivesMessagesInTheirOrderWithTheirBytes) {
  SampleQueue queue(100);
  EXPECT_TRUE(queue.push({.channel = 3, .sequence = 1}, bytes(10, 1), false));
  EXPECT_TRUE(queue.push({.channel = 4, .sequence = 7}, bytes(20, 2), true));
  SampleBatch batch;
  queue.take(batch, 0ms);
  ASSERT_EQ(batch.samples.size(), 2u);
  EXPECT_EQ(batch.samples[0].channel, 3u);
  EXPECT_EQ(batch.samples[1].sequence, 7u);
  const auto second = batch.data(batch.samples[1]);
  EXPECT_EQ(std::vector<std::uint8_t>(second.begin(), second.end()), bytes(20, 2));
  queue.take(batch, 0ms);
  EXPECT_TRUE(batch.samples.empty());
}

TEST(SampleQueue, DropsFramesBeforeGestures) {
  SampleQueue queue(100);
  EXPECT_TRUE(queue.push({}, bytes(45, 0), true));
  EXPECT_FALSE(queue.push({}, bytes(45, 0), true)) << "frames have half of the room";
  EXPECT_TRUE(queue.push({}, bytes(50, 0), false));
  EXPECT_FALSE(queue.push({}, bytes(10, 0), false));
  EXPECT_TRUE(queue.push({}, bytes(5, 0), false));
  SampleBatch batch;
  queue.take(batch, 0ms);
  EXPECT_EQ(batch.samples.size(), 3u);
  EXPECT_TRUE(queue.push({}, bytes(45, 0), true)) << "there is room again";
}

TEST(SampleQueue, TakesOneFrameThatIsLargerThanItsRoom) {
  SampleQueue queue(100);
  EXPECT_TRUE(queue.push({}, bytes(1000, 0), true));
  EXPECT_FALSE(queue.push({}, bytes(1000, 0), true));
}

}  // namespace
}  // namespace cordis::record
