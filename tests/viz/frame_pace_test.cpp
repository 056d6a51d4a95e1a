// tests/viz/frame_pace_test.cpp
#include "viz_node/frame_pace.h"

#include <gtest/gtest.h>

namespace cordis::viz {
namespace {

constexpr std::int64_t kMsec = 1'000'000;
constexpr std::int64_t kStart = 5'000'000'000;

/// Frames let through of `count` that come every `period_msec`, each shaken by up to `jitter_msec`.
int let_through(FramePace& pace, int count, std::int64_t period_msec, std::int64_t jitter_msec) {
  int through = 0;
  for (int i = 0; i < count; ++i) {
    const std::int64_t shaken = i % 3 == 0 ? jitter_msec : (i % 3 == 1 ? -jitter_msec : 0);
    through += pace.lets_through(kStart + (i * period_msec + shaken) * kMsec) ? 1 : 0;
  }
  return through;
}

TEST(FramePace, LetsEveryFrameThroughThatComesAtItsRateHoweverShaken) {
  FramePace pace(25.0);
  EXPECT_EQ(let_through(pace, 1000, 40, 8), 1000);
}

TEST(FramePace, HoldsItsRateAgainstFramesThatComeFaster) {
  FramePace pace(25.0);
  EXPECT_NEAR(let_through(pace, 1000, 10, 0), 250, 1);
}

TEST(FramePace, HoldsItsRateAgainstFramesOfAnOddRate) {
  FramePace pace(25.0);
  // 1000 frames every 17 ms last 17 s.
  EXPECT_NEAR(let_through(pace, 1000, 17, 0), 425, 1);
}

TEST(FramePace, DoesNotCatchUpAfterAPause) {
  FramePace pace(25.0);
  ASSERT_TRUE(pace.lets_through(kStart));
  const std::int64_t later = kStart + 10'000 * kMsec;
  int through = 0;
  for (int i = 0; i < 100; ++i) through += pace.lets_through(later + i * kMsec) ? 1 : 0;
  EXPECT_LE(through, 4);  // in 100 ms, at 25 Hz
}

}  // namespace
}  // namespace cordis::viz
