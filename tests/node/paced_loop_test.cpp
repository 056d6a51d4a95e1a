// tests/node/paced_loop_test.cpp
#include "node/paced_loop.h"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <string>
#include <thread>

#include <gtest/gtest.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>

#include "node/time.h"
#include "tests/support/eventually.h"
#include "tests/support/realtime_permission.h"
#include "tests/support/timer_control.h"

namespace cordis::node {
namespace {

void sleep_nsec(std::int64_t nsec) {
  const timespec time{nsec / 1'000'000'000, nsec % 1'000'000'000};
  nanosleep(&time, nullptr);
}

/// Processor time of the calling thread [ns].
std::int64_t processor_nsec() {
  timespec used{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &used);
  return used.tv_sec * 1'000'000'000 + used.tv_nsec;
}

/// What the kernel lets a thread have, and says that it has.
TEST(RealtimeGrant, SaysWhatTheSystemHasGranted) {
  constexpr int kPriority = 3;
  RealtimeGrant grant;
  sched_param parameters{};
  int policy = -1;
  std::thread([&] {
    grant = make_realtime(kPriority);
    pthread_getschedparam(pthread_self(), &policy, &parameters);
  }).join();
  munlockall();
  EXPECT_EQ(grant.fifo, test::may_have_realtime_priority());
  EXPECT_EQ(grant.fifo, policy == SCHED_FIFO);
  EXPECT_EQ(parameters.sched_priority, grant.fifo ? kPriority : 0);
}

TEST(PacedLoop, NeverTicksBeforeItsDeadline) {
  PacedLoop loop(2000.0);
  const std::int64_t start = monotonic_nsec();
  loop.wait();
  std::uint64_t deadlines = 0;

  for (int tick = 0; tick < 50; ++tick) deadlines += 1 + loop.wait();

  // A busy machine may make it later, never earlier; 1 us for the time between the first tick and
  // our clock reading.
  EXPECT_GE(monotonic_nsec() - start, static_cast<std::int64_t>(deadlines) * 500'000 - 1'000);
  EXPECT_EQ(loop.ticks(), 51u);
}

TEST(PacedLoop, KnowsTheNextDeadlineBeforeItsFirstTick) {
  const std::int64_t before = monotonic_nsec();
  const PacedLoop loop(10.0);
  EXPECT_GE(loop.next_nsec(), before);
  EXPECT_LE(loop.next_nsec(), monotonic_nsec() + 100'000'000);
}

TEST(PacedLoop, SkipsAndCountsDeadlinesMissedInsteadOfCatchingUp) {
  PacedLoop loop(1000.0);
  loop.wait();
  const std::int64_t start = monotonic_nsec();
  std::uint64_t deadlines = 1 + loop.wait();
  const std::uint64_t overruns_before = loop.overruns();
  sleep_nsec(20'500'000);

  const std::uint64_t skipped = loop.wait();

  EXPECT_GE(skipped, 19u);
  EXPECT_EQ(loop.overruns(), overruns_before + 1);
  deadlines += 1 + skipped;
  for (int tick = 0; tick < 5; ++tick) deadlines += 1 + loop.wait();
  // The next deadlines lay ahead again: no burst. The first of them may be just over at `start`.
  EXPECT_GE(monotonic_nsec() - start, static_cast<std::int64_t>(deadlines - 1) * 1'000'000);
}

TEST(PacedLoop, CountsATickThatBeginsOneAndAHalfPeriodsLate) {
  PacedLoop loop(100.0);
  loop.wait();
  const std::uint64_t before = loop.overruns();
  sleep_nsec(25'000'000);  // the next deadline is 10 ms after the last one

  EXPECT_GE(loop.wait(), 1u);
  EXPECT_EQ(loop.overruns(), before + 1);
}

TEST(PacedLoop, TakesATickThatComputesTooLongForTheCauseOfALateOne) {
  constexpr std::int64_t kPeriod = 1'000'000;
  PacedLoop loop(1000.0);
  loop.wait();

  const std::int64_t begun = processor_nsec();
  while (processor_nsec() - begun < 3 * kPeriod) {
  }
  EXPECT_GE(loop.wait(), 1u);

  EXPECT_EQ(loop.late_cause(), LateCause::kWork);
}

TEST(PacedLoop, TakesTheMachineForTheCauseOfALateTickThatComputedNothing) {
  PacedLoop loop(1000.0);
  loop.wait();

  sleep_nsec(20'500'000);
  EXPECT_GE(loop.wait(), 19u);

  EXPECT_EQ(loop.late_cause(), LateCause::kMachine);
}

TEST(PacedLoop, HasACauseForEachOverrunAndForNoOtherTick) {
  PacedLoop loop(2000.0);
  for (int tick = 0; tick < 200; ++tick) {
    const std::uint64_t before = loop.overruns();
    loop.wait();
    EXPECT_EQ(loop.overruns() > before, loop.late_cause() != LateCause::kNone);
  }
}

TEST(PacedLoop, OfTheSameRateTakeTurnsByTheirPhase) {
  const test::TimerControl control;
  PacedLoop first(1000.0, 0.0);
  PacedLoop second(1000.0, 0.5);
  // How far past its deadline each begins at best: a busy machine may make single ticks late,
  // hardly all of 200.
  std::int64_t first_best = 1'000'000;
  std::int64_t second_best = 1'000'000;
  const bool took_turns = test::eventually([&] {
    for (int tick = 0; tick < 200; ++tick) {
      first.wait();
      first_best = std::min(first_best, monotonic_nsec() % 1'000'000);
      second.wait();
      second_best = std::min(second_best, (monotonic_nsec() + 500'000) % 1'000'000);
    }
    return first_best < 250'000 && second_best < 250'000;
  });
  const std::string reason = control.reason_to_skip(std::chrono::milliseconds(100));
  if (!took_turns && !reason.empty()) GTEST_SKIP() << reason;
  EXPECT_TRUE(took_turns) << first_best << " ns and " << second_best << " ns after the deadline";
}

}  // namespace
}  // namespace cordis::node
