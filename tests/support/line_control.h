// tests/support/line_control.h -- how late this machine carries a byte through a pseudo-terminal,
// measured beside a test.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <thread>

namespace cordis::test {

/// A thread that sends a byte every millisecond through a line of its own and waits for it. The
/// kernel carries it on a worker thread of ordinary priority, as it does between a node and an
/// emulated board, whatever the priorities of these.
class LineControl {
 public:
  LineControl();
  ~LineControl();
  LineControl(const LineControl&) = delete;
  LineControl& operator=(const LineControl&) = delete;

  /// Bytes that have arrived.
  std::uint64_t turn_count() const noexcept { return bytes_.load(); }
  /// The longest that a byte has been under way; one that has not arrived counts.
  std::chrono::nanoseconds worst() const noexcept;

 private:
  void run() noexcept;

  int board_;
  int node_;
  std::atomic<std::int64_t> sent_nsec_{0};  // of a byte that has not arrived; 0: none
  std::atomic<std::int64_t> worst_nsec_{0};
  std::atomic<std::uint64_t> bytes_{0};
  std::atomic<bool> ends_{false};
  std::thread thread_;
};

}  // namespace cordis::test
