// node/paced_loop.h -- a loop with absolute deadlines.
#pragma once

#include <cstdint>

#include "node/late_ticks.h"

namespace cordis::node {

inline constexpr int kLoopPriority = 80;  ///< SCHED_FIFO, for the force loops

/// What the operating system granted to a loop thread.
struct RealtimeGrant {
  bool fifo = false;           ///< SCHED_FIFO
  bool memory_locked = false;  ///< mlockall
};

/// Asks for SCHED_FIFO at `priority` for the calling thread and for locked memory; takes quietly
/// what it gets, and always sets the timer slack to 1 ns. Call it from the loop thread after all
/// other threads exist.
RealtimeGrant make_realtime(int priority) noexcept;

/// Ticks at a fixed rate against absolute deadlines of CLOCK_MONOTONIC.
///
/// The deadlines are the whole multiples of the period, shifted by a phase. Two processes of one
/// host that pace the same rate with different phases take turns, always in the same order and
/// distance.
///
/// A tick that begins one period or more after its deadline is an overrun. The deadlines missed
/// meanwhile are skipped and counted, never caught up in a burst, so that a stall does not end in a
/// spiral.
class PacedLoop {
 public:
  /// @param rate_hz  ticks per second, > 0
  /// @param phase    share of a period by which the deadlines follow its multiples, 0..1
  explicit PacedLoop(double rate_hz, double phase = 0.0) noexcept;

  /// Sleeps until the next deadline. Ends early when a signal arrives. Returns the number of
  /// deadlines skipped.
  std::uint64_t wait() noexcept;

  std::uint64_t ticks() const noexcept { return ticks_; }
  std::uint64_t overruns() const noexcept {
    return overruns_;
  }  ///< ticks that began a period or more too late
  /// Why the present tick began too late. A tick that computes for a period or more delays the
  /// next one by itself; every other delay is the machine's. Time in which the tick waits counts as
  /// the machine's too.
  LateCause late_cause() const noexcept { return late_cause_; }
  /// The next deadline [ns].
  std::int64_t next_nsec() const noexcept { return deadline(deadline_index_ + 1); }
  double rate_hz() const noexcept { return rate_hz_; }

 private:
  double rate_hz_;
  double phase_;
  std::int64_t deadline_index_ = 0;  // periods since the clock was 0
  std::uint64_t ticks_ = 0;
  std::uint64_t overruns_ = 0;
  LateCause late_cause_ = LateCause::kNone;
  std::int64_t woken_processor_nsec_ = 0;  // of the thread, when the present tick began

  std::int64_t deadline(std::int64_t index) const noexcept;
  void find_deadline() noexcept;
};

}  // namespace cordis::node
