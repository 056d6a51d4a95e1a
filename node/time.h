// node/time.h -- the clock of every time on the wire.
#pragma once

#include <cstdint>
#include <ctime>

namespace cordis::node {

/// CLOCK_MONOTONIC [ns].
inline std::int64_t monotonic_nsec() noexcept {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<std::int64_t>(now.tv_sec) * 1'000'000'000 + now.tv_nsec;
}

/// Sleeps until that moment of CLOCK_MONOTONIC [ns]. Ends early when a signal arrives.
inline void sleep_until(std::int64_t nsec) noexcept {
  const timespec until{nsec / 1'000'000'000, nsec % 1'000'000'000};
  clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
}

}  // namespace cordis::node
