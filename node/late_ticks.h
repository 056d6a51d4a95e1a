// node/late_ticks.h -- the late ticks of a loop, counted by their cause.
#pragma once

#include <atomic>
#include <cstdint>

#include "idl/control.h"

namespace cordis::node {

/// Why a tick began a period or more after its deadline.
enum class LateCause : std::uint8_t {
  kNone,     ///< it did not
  kMachine,  ///< the machine woke the loop late, or took the processor away from it
  kWork      ///< the tick before computed for a period or more
};

/// Counters of one loop. The loop thread writes; fill() may be called from another thread. Real
/// time: every function is wait-free.
class LateTicks {
 public:
  void count(LateCause cause) noexcept {
    if (cause == LateCause::kMachine) by_machine_.fetch_add(1, std::memory_order_relaxed);
    if (cause == LateCause::kWork) by_work_.fetch_add(1, std::memory_order_relaxed);
  }
  /// A tick for which the other side of the gesture was silent, late or not.
  void count_silent() noexcept { silent_.fetch_add(1, std::memory_order_relaxed); }

  /// Overruns and their causes.
  void fill(msg::NodeStatus& status) const {
    const std::uint64_t by_machine = by_machine_.load(std::memory_order_relaxed);
    const std::uint64_t by_work = by_work_.load(std::memory_order_relaxed);
    status.overruns(by_machine + by_work);
    status.late_by_machine(by_machine);
    status.late_by_work(by_work);
    status.silent_ticks(silent_.load(std::memory_order_relaxed));
  }

 private:
  std::atomic<std::uint64_t> by_machine_{0};
  std::atomic<std::uint64_t> by_work_{0};
  std::atomic<std::uint64_t> silent_{0};
};

}  // namespace cordis::node
