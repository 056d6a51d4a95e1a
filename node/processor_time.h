// node/processor_time.h -- what a thread has computed so far.
#pragma once

#include <cstdint>
#include <ctime>

namespace cordis::node {

/// Processor time of the calling thread [ns].
inline std::int64_t thread_processor_nsec() noexcept {
  timespec used{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &used);
  return static_cast<std::int64_t>(used.tv_sec) * 1'000'000'000 + used.tv_nsec;
}

}  // namespace cordis::node
