// node/paced_loop.cpp
#include "node/paced_loop.h"

#include <cmath>

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>

#include "node/assert.h"
#include "node/processor_time.h"
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

PacedLoop::PacedLoop(double rate_hz, double phase) noexcept : rate_hz_(rate_hz), phase_(phase) {
  CORDIS_ASSERT(rate_hz > 0.0 && phase >= 0.0 && phase <= 1.0);
  find_deadline();
}

/// The present deadline, or the last one.
void PacedLoop::find_deadline() noexcept {
  const double periods = static_cast<double>(monotonic_nsec()) * rate_hz_ / 1e9 - phase_;
  deadline_index_ = static_cast<std::int64_t>(periods);
}

std::int64_t PacedLoop::deadline(std::int64_t index) const noexcept {
  return std::llround((static_cast<double>(index) + phase_) * 1e9 / rate_hz_);
}

std::uint64_t PacedLoop::wait() noexcept {
  const auto period = static_cast<std::int64_t>(1e9 / rate_hz_);
  ++ticks_;
  const bool is_first = ticks_ == 1;
  if (is_first) find_deadline();
  ++deadline_index_;
  const std::int64_t due = deadline(deadline_index_);
  sleep_until(due);

  const std::int64_t late = monotonic_nsec() - due;
  const std::int64_t used = thread_processor_nsec();  // nothing of it while it slept
  const std::int64_t computed = is_first ? 0 : used - woken_processor_nsec_;
  woken_processor_nsec_ = used;
  late_cause_ = LateCause::kNone;
  if (late < period) return 0;
  late_cause_ = computed < period ? LateCause::kMachine : LateCause::kWork;
  ++overruns_;
  const std::int64_t skipped = late / period;
  deadline_index_ += skipped;
  return static_cast<std::uint64_t>(skipped);
}

}  // namespace cordis::node
