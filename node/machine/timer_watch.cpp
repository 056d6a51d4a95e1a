// node/machine/timer_watch.cpp
#include "node/machine/timer_watch.h"

#include <algorithm>
#include <csignal>

#include <pthread.h>
#include <sched.h>
#include <sys/prctl.h>

#include "node/machine/deadline_record.h"
#include "node/machine/processor_quota.h"
#include "node/paced_loop.h"
#include "node/time.h"

namespace cordis::machine {
namespace {

constexpr std::int64_t kFirstPeriodNsec = 2'000'000;
constexpr std::int64_t kWatchPeriodNsec = 20'000'000;
constexpr auto kFirstCheckNsec = static_cast<std::int64_t>(TimerWatch::kFirstCheckS * 1e9);

}  // namespace

TimerWatch::TimerWatch()
    : at_begin_(read_processor_time(files_)),
      begun_nsec_(node::monotonic_nsec()),
      own_nsec_at_begin_(family_processor_nsec()),
      core_count_(usable_processors(files_)),
      thread_([this] { watch(); }) {}

TimerWatch::~TimerWatch() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  thread_.join();
}

void TimerWatch::watch() {
  sigset_t all;
  sigfillset(&all);
  pthread_sigmask(SIG_BLOCK, &all, nullptr);  // signals are the other threads' business
  prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);
  sched_param above_loops{};
  above_loops.sched_priority = node::kLoopPriority + 1;
  pthread_setschedparam(pthread_self(), SCHED_FIFO, &above_loops);  // where it is allowed
  std::int64_t due = begun_nsec_;
  for (;;) {
    const bool is_first_check = due - begun_nsec_ < kFirstCheckNsec;
    const std::int64_t period = is_first_check ? kFirstPeriodNsec : kWatchPeriodNsec;
    due += period;
    const timespec wake{due / 1'000'000'000, due % 1'000'000'000};
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &wake, nullptr);
    const std::int64_t late = std::max<std::int64_t>(node::monotonic_nsec() - due, 0);
    const std::lock_guard lock(mutex_);
    if (ending_) return;
    record(late, period);
    due += late;
  }
}

/// All timers due within the lateness of this one would have been late as well, but for the last
/// fifth of a millisecond.
void TimerWatch::record(std::int64_t late_nsec, std::int64_t period_nsec) {
  watched_nsec_ += period_nsec + late_nsec;
  if (late_nsec > DeadlineRecord::kLateNsec)
    late_nsec_ += period_nsec + late_nsec - DeadlineRecord::kLateNsec;
  worst_nsec_ = std::max(worst_nsec_, late_nsec);
}

TimerFigures TimerWatch::figures() const {
  const std::optional<double> stolen = stolen_share(at_begin_, read_processor_time(files_));
  const auto own = static_cast<double>(family_processor_nsec() - own_nsec_at_begin_);
  const auto passed = static_cast<double>(node::monotonic_nsec() - begun_nsec_);
  const std::lock_guard lock(mutex_);
  const auto watched = static_cast<double>(watched_nsec_);
  return {watched * 1e-9,
          watched > 0.0 ? static_cast<double>(late_nsec_) / watched : 0.0,
          static_cast<double>(worst_nsec_) * 1e-9,
          stolen,
          passed > 0.0 ? own / (passed * static_cast<double>(core_count_)) : 0.0,
          core_count_};
}

}  // namespace cordis::machine
