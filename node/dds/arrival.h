// node/dds/arrival.h -- wakes one thread for the messages of several readers.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>

namespace cordis::dds {

class PresentSocket;

/// Counts the messages that arrive at the readers it was given to, and lets one thread wait for the
/// next one. Any thread announces; one thread waits. The thread that waits takes the messages of a
/// participant of the force loop out of its socket itself.
class Arrival {
 public:
  /// @throws std::system_error when the process has no file left.
  Arrival();
  ~Arrival();
  Arrival(const Arrival&) = delete;
  Arrival& operator=(const Arrival&) = delete;

  /// Messages announced so far. Wait-free.
  std::uint32_t count() const noexcept { return count_.load(std::memory_order_acquire); }

  /// A message has arrived. Costs a system call only while a thread waits.
  void announce() noexcept;

  /// Takes what has come to the socket, so it is counted and the readers have it; after kMaxOfAnUpdate
  /// datagrams another thread takes the rest. Of the thread that waits; costs a system call.
  void update() noexcept;
  static constexpr int kMaxOfAnUpdate = 1000;

  /// Waits until count() is no longer `seen`, or until that moment; true when count() has changed.
  /// Also ends when a signal reaches the thread. @param until_nsec  CLOCK_MONOTONIC
  bool wait_until(std::uint32_t seen, std::int64_t until_nsec) noexcept;

  /// Waits likewise without sleeping: the core is busy meanwhile, and no thread has to be woken.
  bool poll_until(std::uint32_t seen, std::int64_t until_nsec) noexcept;

  /// Processor time of poll_until() so far, without that of what came [ns].
  std::int64_t polled_nsec() const noexcept { return polled_nsec_; }

  /// The socket of a participant of the force loop; before the first wait.
  void attach(std::shared_ptr<PresentSocket> socket) noexcept;

 private:
  std::shared_ptr<PresentSocket> socket_;  // may be null
  int woken_ = -1;                         // an event
  std::int64_t polled_nsec_ = 0;
  std::atomic<std::uint32_t> count_{0};
  std::atomic<bool> is_awaited_{false};
};

}  // namespace cordis::dds
