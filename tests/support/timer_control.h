// tests/support/timer_control.h -- how late this machine wakes a timer, measured beside a test.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <string>
#include <thread>

namespace cordis::test {

/// A thread that does nothing but sleep until every millisecond of the clock, from construction to
/// destruction. What a test needs of real time is measured against it: the thread shares the cores,
/// the load and the seconds with the test, and runs no code of Cordis.
class TimerControl {
 public:
  TimerControl();
  ~TimerControl();
  TimerControl(const TimerControl&) = delete;
  TimerControl& operator=(const TimerControl&) = delete;

  /// Wake-ups so far.
  std::uint64_t turn_count() const noexcept { return wakes_.load(); }
  /// The largest delay of a wake-up so far; a wake-up that is still due counts.
  std::chrono::nanoseconds worst() const noexcept;
  /// The reason to skip a test that no machine with such timers can pass, or nothing.
  /// @param bearable  the largest delay of a wake-up with which the test can pass
  std::string reason_to_skip(std::chrono::nanoseconds bearable) const;

 private:
  void run() noexcept;

  std::atomic<std::int64_t> due_nsec_{0};
  std::atomic<std::int64_t> worst_nsec_{0};
  std::atomic<std::uint64_t> wakes_{0};
  std::atomic<bool> ends_{false};
  std::thread thread_;
};

}  // namespace cordis::test
