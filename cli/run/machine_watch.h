// cli/run/machine_watch.h -- says when the machine, not Cordis, is the reason of late ticks.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "cli/run/status_board.h"
#include "node/machine/timer_watch.h"

namespace cordis::cli {

/// Holds the late ticks of a session against what a TimerWatch sees of the machine meanwhile.
class MachineWatch {
 public:
  static constexpr std::uint64_t kRepeated = 3;     ///< late ticks of all nodes
  static constexpr double kManyLateShare = 0.01;    ///< share of timers; as in `cordis doctor`
  static constexpr double kLongStallS = 0.01;       ///< likewise; half of the watchdog of a device
  static constexpr double kAllOwnShare = 0.9;       ///< share of the cores: all that can be had
  static constexpr double kMuchStolenShare = 0.01;  ///< share of processor time; likewise

  /// @param figures  what the watch has seen so far
  explicit MachineWatch(std::function<machine::TimerFigures()> figures);

  /// `the machine itself woke 4 % of timers late; worst 255 ms`, and what a hypervisor took. Empty
  /// unless most late ticks began late by no work of their own loop, and its timers were late or its
  /// time was stolen. Where the session itself took the cores, that is what it says.
  std::string sentence(const LateTickSum& late) const;

  /// The sentence of a running session: once, after TimerWatch::kFirstCheckS, if late ticks repeat.
  std::string sentence_when_repeated(const LateTickSum& late);

 private:
  std::function<machine::TimerFigures()> figures_;
  bool is_reported_ = false;
};

}  // namespace cordis::cli
