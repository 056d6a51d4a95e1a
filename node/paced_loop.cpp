// node/paced_loop.cpp
#include "node/paced_loop.h"

#include <cmath>

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>

#include "node/time.h"

namespace cordis::node {

RealtimeGrant make_realtime(int priority) noexcept {
  RealtimeGrant grant;
  prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);
  sched_param parameters{};
  parameters.sched_priority = priority;
  grant.fifo = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters) == 0;
  if (!grant.fifo) setpriority(PRIO_PROCESS, 0, -15);
  // On fault: later allocations of the other threads are locked when first touched, not when
  // reserved.
  grant.memory_locked = mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT) == 0;
  return grant;
}

PacedLoop::PacedLoop(double rate_hz) noexcept : rate_hz_(rate_hz) {}

std::int64_t PacedLoop::deadline(std::uint64_t index) const noexcept {
  return first_deadline_ + std::llround(static_cast<double>(index) * 1e9 / rate_hz_);
}

std::uint64_t PacedLoop::wait() noexcept {
  const auto period = static_cast<std::int64_t>(1e9 / rate_hz_);
  ++ticks_;
  if (ticks_ == 1) {
    first_deadline_ = monotonic_nsec();
    return 0;
  }
  ++deadline_index_;
  const std::int64_t due = deadline(deadline_index_);
  const timespec wake{due / 1'000'000'000, due % 1'000'000'000};
  clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &wake, nullptr);

  const std::int64_t late = monotonic_nsec() - due;
  lateness_.record(late);
  if (late < period) return 0;
  ++overruns_;
  const auto skipped = static_cast<std::uint64_t>(late / period);
  deadline_index_ += skipped;
  return skipped;
}

}  // namespace cordis::node
