// node/dds/arrival.h -- wakes one thread for the messages of several readers.
#pragma once

#include <atomic>
#include <cstdint>

namespace cordis::dds {

/// Counts the messages that arrive at the readers it was given to, and lets one thread wait for the
/// next one. Any thread announces; one thread waits.
class Arrival {
 public:
  Arrival() = default;
  Arrival(const Arrival&) = delete;
  Arrival& operator=(const Arrival&) = delete;

  /// Messages announced so far. Wait-free.
  std::uint32_t count() const noexcept { return count_.load(std::memory_order_acquire); }

  /// A message has arrived. Costs a system call only while a thread waits.
  void announce() noexcept;

  /// Waits until count() is no longer `seen`, or until that moment; true when count() has changed.
  /// Also ends when a signal reaches the thread. @param until_nsec  CLOCK_MONOTONIC
  bool wait_until(std::uint32_t seen, std::int64_t until_nsec) noexcept;

  /// Waits likewise without sleeping: the core is busy meanwhile, and no thread has to be woken.
  bool poll_until(std::uint32_t seen, std::int64_t until_nsec) const noexcept;

 private:
  std::atomic<std::uint32_t> count_{0};
  std::atomic<bool> is_awaited_{false};
};

}  // namespace cordis::dds
