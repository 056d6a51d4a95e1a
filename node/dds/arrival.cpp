// node/dds/arrival.cpp
#include "node/dds/arrival.h"

#include <algorithm>
#include <ctime>

#include <linux/futex.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace cordis::dds {
namespace {

static_assert(sizeof(std::atomic<std::uint32_t>) == sizeof(std::uint32_t));

std::int64_t now_nsec() noexcept {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<std::int64_t>(now.tv_sec) * 1'000'000'000 + now.tv_nsec;
}

}  // namespace

void Arrival::announce() noexcept {
  count_.fetch_add(1);
  if (is_awaited_.load()) syscall(SYS_futex, &count_, FUTEX_WAKE_PRIVATE, 1, nullptr, nullptr, 0);
}

bool Arrival::wait_until(std::uint32_t seen, std::int64_t until_nsec) noexcept {
  // Announced before the kernel compares: it compares in vain. Later: is_awaited_ is seen.
  is_awaited_.store(true);
  const std::int64_t until = std::max<std::int64_t>(until_nsec, 0);
  const timespec limit{until / 1'000'000'000, until % 1'000'000'000};
  // The wake-up of a message that the thread took before it slept may come while it sleeps again.
  bool is_woken = true;
  while (is_woken && count() == seen) {
    is_woken = syscall(SYS_futex, &count_, FUTEX_WAIT_BITSET_PRIVATE, seen, &limit, nullptr,
                       FUTEX_BITSET_MATCH_ANY) == 0;
  }
  is_awaited_.store(false);
  return count() != seen;
}

bool Arrival::poll_until(std::uint32_t seen, std::int64_t until_nsec) const noexcept {
  constexpr int kPausesPerLook = 20;  // at the clock
  while (count() == seen) {
    if (now_nsec() >= until_nsec) return false;
    for (int i = 0; i < kPausesPerLook; ++i) __builtin_ia32_pause();
  }
  return true;
}

}  // namespace cordis::dds
