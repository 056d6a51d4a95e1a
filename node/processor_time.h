// node/processor_time.h -- what a thread or a process has computed so far.
#pragma once

#include <cstdint>
#include <ctime>

namespace cordis::node {

inline std::int64_t nsec_of_clock(clockid_t clock) noexcept {
  timespec used{};
  clock_gettime(clock, &used);
  return static_cast<std::int64_t>(used.tv_sec) * 1'000'000'000 + used.tv_nsec;
}

/// Processor time of the calling thread [ns].
inline std::int64_t thread_processor_nsec() noexcept {
  return nsec_of_clock(CLOCK_THREAD_CPUTIME_ID);
}

/// Processor time of all threads of this process [ns].
inline std::int64_t process_processor_nsec() noexcept {
  return nsec_of_clock(CLOCK_PROCESS_CPUTIME_ID);
}

}  // namespace cordis::node
