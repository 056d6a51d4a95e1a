// sim_node/plan/reference/thread_time.h -- the processor time of the calling thread.
#pragma once

#include <ctime>

namespace cordis::plan {

/// Processor time of the calling thread so far [ns].
inline double thread_nsec() noexcept {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e9 * static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_nsec);
}

}  // namespace cordis::plan
