// node/machine/wakeups.cpp
#include "node/machine/wakeups.h"

#include <thread>

#include <pthread.h>
#include <sched.h>
#include <sys/prctl.h>

#include "node/time.h"

namespace cordis::machine {
namespace {

constexpr std::int64_t kLoopPeriodNsec = 1'000'000;
constexpr int kPriority = 80;  // SCHED_FIFO, as the loops of the nodes

bool bind_to(int core) noexcept {
  cpu_set_t set;
  CPU_ZERO(&set);
  CPU_SET(static_cast<std::size_t>(core), &set);
  return pthread_setaffinity_np(pthread_self(), sizeof set, &set) == 0;
}

bool make_fifo() noexcept {
  sched_param parameters{};
  parameters.sched_priority = kPriority;
  return pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters) == 0;
}

/// Wakes at all multiples of the period, shifted by `phase_nsec`, from `begin_nsec` to `end_nsec`:
/// a thread that starts late is late.
void record_wakeups(std::int64_t begin_nsec, std::int64_t phase_nsec, std::int64_t end_nsec,
                    DeadlineRecord& record) {
  prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);
  std::int64_t due = begin_nsec + 2 * kLoopPeriodNsec - begin_nsec % kLoopPeriodNsec + phase_nsec;
  while (due < end_nsec) {
    const timespec wake{due / 1'000'000'000, due % 1'000'000'000};
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &wake, nullptr);
    const std::int64_t late = node::monotonic_nsec() - due;
    if (late < 0) continue;  // a signal came first
    due += kLoopPeriodNsec * (1 + record.record(late, kLoopPeriodNsec));
  }
}

}  // namespace

std::vector<int> usable_cores() {
  std::vector<int> cores;
  cpu_set_t set;
  CPU_ZERO(&set);
  if (sched_getaffinity(0, sizeof set, &set) != 0) return {0};
  for (int core = 0; core < CPU_SETSIZE; ++core) {
    if (CPU_ISSET(static_cast<std::size_t>(core), &set)) cores.push_back(core);
  }
  return cores;
}

std::vector<CoreWakeups> measure_wakeups(std::chrono::nanoseconds duration) {
  std::vector<CoreWakeups> measured;
  for (const int core : usable_cores()) measured.push_back({core, {}, {}});
  const std::int64_t begin = node::monotonic_nsec();
  const std::int64_t end = begin + duration.count();
  std::vector<std::thread> threads;
  for (CoreWakeups& wakeups : measured) {
    threads.emplace_back([&wakeups, begin, end] {
      if (bind_to(wakeups.core)) record_wakeups(begin, 0, end, wakeups.normal);
    });
    threads.emplace_back([&wakeups, begin, end] {
      if (!bind_to(wakeups.core) || !make_fifo()) return;
      record_wakeups(begin, kLoopPeriodNsec / 2, end, wakeups.realtime.emplace());
    });
  }
  for (std::thread& thread : threads) thread.join();
  return measured;
}

}  // namespace cordis::machine
