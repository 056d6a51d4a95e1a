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

}  // namespace cordis::node
