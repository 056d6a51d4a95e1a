// node/machine/wakeups.h -- how punctually each core wakes a 1 kHz loop.
#pragma once

#include <chrono>
#include <optional>
#include <vector>

#include "node/machine/deadline_record.h"

namespace cordis::machine {

/// The wake-ups of one core.
struct CoreWakeups {
  int core = 0;
  DeadlineRecord normal;                   ///< a thread of normal priority
  std::optional<DeadlineRecord> realtime;  ///< a thread with SCHED_FIFO; nothing: not permitted

  /// As the loops of the nodes are woken: with realtime priority where it is permitted.
  const DeadlineRecord& of_loops() const noexcept { return realtime ? *realtime : normal; }
};

/// Cores on which the calling thread may run, in order.
std::vector<int> usable_cores();

/// Measures all usable cores at once for so long: on each one thread of normal priority and, where
/// it is permitted, one with SCHED_FIFO, half a period apart. They wake at 1 kHz by absolute
/// deadlines with a timer slack of 1 ns, as the loops of the nodes do.
std::vector<CoreWakeups> measure_wakeups(std::chrono::nanoseconds duration);

}  // namespace cordis::machine
