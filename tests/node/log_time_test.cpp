// tests/node/log_time_test.cpp -- what a loop has sent later keeps its order in the take.
#include "node/log_time.h"

#include <algorithm>
#include <cstdint>
#include <random>

#include <gtest/gtest.h>

namespace cordis::node {
namespace {

constexpr std::uint64_t kBegin = 1'800'000'000'000'000'000;  // UTC [ns]
constexpr std::uint64_t kMsec = 1'000'000;

TEST(LogTime, OfALoopIsWhenItWroteHoweverLateTheMessageCame) {
  std::mt19937 random(3);
  for (int run = 0; run < 200; ++run) {
    LogTime log_time;
    std::uint64_t sent = kBegin;  // by the other thread
    std::uint64_t received = kBegin;
    for (int n = 0; n < 500; ++n) {
      const std::uint64_t published = kBegin + static_cast<std::uint64_t>(n) * kMsec;
      const bool is_stopped = random() % 100 == 0;  // the thread, or the recorder
      sent = std::max(sent, published + (is_stopped ? random() % 12'000 * kMsec : 0));
      received = std::max(received, sent) + 1 + random() % 100'000;
      ASSERT_EQ(log_time.next(received, published, true), published) << "run " << run;
    }
  }
}

TEST(LogTime, OfALoopNeverGoesBackWhateverTheClocksSay) {
  std::mt19937 random(4);
  for (int run = 0; run < 200; ++run) {
    LogTime log_time;
    std::uint64_t last = 0;
    for (int n = 0; n < 500; ++n) {
      const std::uint64_t received = kBegin + static_cast<std::uint64_t>(n) * kMsec;
      const std::uint64_t published =
          random() % 8 == 0 ? random() : received - 200'000 * kMsec + random() % 400'000 * kMsec;
      const std::uint64_t time = log_time.next(received, published, true);
      ASSERT_GE(time, last) << "run " << run;
      ASSERT_LE(time, received) << "run " << run;
      last = time;
    }
  }
}

TEST(LogTime, BeginsAnewAfterTheClockWasSetBack) {
  constexpr std::uint64_t kHour = 3'600'000 * kMsec;
  LogTime log_time;
  EXPECT_EQ(log_time.next(kBegin + kHour + kMsec, kBegin + kHour, true), kBegin + kHour);
  EXPECT_EQ(log_time.next(kBegin + kMsec, kBegin, true), kBegin);
  EXPECT_EQ(log_time.next(kBegin + 3 * kMsec, kBegin + 2 * kMsec, true), kBegin + 2 * kMsec);
}

TEST(LogTime, OfAllElseIsWhenTheMessageCame) {
  LogTime log_time;
  EXPECT_EQ(log_time.next(kBegin, kBegin - kMsec, false), kBegin);
  EXPECT_EQ(log_time.next(kBegin + kMsec, kBegin + kMsec - 1, false), kBegin + kMsec);
}

}  // namespace
}  // namespace cordis::node
