// tests/node/tick_rate_test.cpp
#include "node/tick_rate.h"

#include <gtest/gtest.h>

namespace cordis::node {
namespace {

constexpr std::int64_t kMsec = 1'000'000;

TEST(TickRate, DoesNotCountTheWaitForTheFirstTick) {
  TickRate rate(5'000 * kMsec);
  rate.update(5'500 * kMsec, 0);
  rate.update(6'000 * kMsec, 100);  // began 100 ms ago
  rate.update(7'000 * kMsec, 1'100);
  EXPECT_EQ(rate.mean_hz(), 1'000.0);
  rate.update(8'000 * kMsec, 2'000);
  EXPECT_EQ(rate.mean_hz(), 950.0);
  EXPECT_EQ(rate.reached_hz(), 900.0);
}

TEST(TickRate, OfARunTooShortForTwoLooksIsThatSinceTheLastLookWithoutTicks) {
  TickRate rate(0);
  rate.update(400 * kMsec, 0);
  rate.update(500 * kMsec, 50);
  EXPECT_EQ(rate.mean_hz(), 500.0);
  rate.update(501 * kMsec, 60);  // too close
  EXPECT_EQ(rate.mean_hz(), 500.0);
  EXPECT_EQ(rate.reached_hz(), 500.0);
}

TEST(TickRate, TheMeanCountsNoPause) {
  TickRate rate(0);
  rate.update(500 * kMsec, 500);
  rate.update(2'500 * kMsec, 2'500);  // the pause begins
  rate.skip_pause(3'000 * kMsec, 2'500);
  rate.update(3'000 * kMsec, 2'500);
  EXPECT_EQ(rate.reached_hz(), 0.0);
  rate.skip_pause(7'500 * kMsec, 2'507);  // seven single ticks
  rate.update(7'500 * kMsec, 2'507);
  EXPECT_EQ(rate.mean_hz(), 1'000.0);
  rate.update(8'500 * kMsec, 3'407);
  EXPECT_NEAR(rate.mean_hz(), 2'900.0 / 3.0, 1e-9);
}

TEST(TickRate, APauseBeforeTheFirstTickIsPartOfTheWait) {
  TickRate rate(0);
  rate.update(500 * kMsec, 0);
  rate.skip_pause(1'500 * kMsec, 0);
  rate.update(1'500 * kMsec, 0);
  rate.update(2'500 * kMsec, 1'000);
  EXPECT_EQ(rate.mean_hz(), 1'000.0);
}

TEST(TickRate, TheMeanBeginsAgainWhenTheLoopAimsAtAnotherRate) {
  TickRate rate(0);
  rate.update(500 * kMsec, 500);
  rate.update(9'500 * kMsec, 9'500);
  rate.restart(9'500 * kMsec, 9'500);
  EXPECT_EQ(rate.mean_hz(), 1'000.0) << "until ticks of the other rate are counted";
  rate.update(10'500 * kMsec, 9'600);
  EXPECT_EQ(rate.mean_hz(), 100.0);
  EXPECT_EQ(rate.reached_hz(), 100.0);
}

}  // namespace
}  // namespace cordis::node
