// node/machine/timer_watch.h -- whether the machine keeps time while other things run.
#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>
#include <thread>

#include "node/machine/processor_time.h"

namespace cordis::machine {

/// What a TimerWatch has seen since it began.
struct TimerFigures {
  double watched_s = 0.0;
  double late_share = 0.0;             ///< timers woken later than DeadlineRecord::kLateNsec
  double worst_s = 0.0;                ///< lateness
  std::optional<double> stolen_share;  ///< share of processor time; nothing where it cannot be read
  /// What this process and its children took, as a share of the time of the cores they may use.
  double own_share = 0.0;
  std::size_t core_count = 1;  ///< these cores
};

/// Samples in a thread of its own how late the machine wakes timers: at 500 Hz for two seconds, then
/// at 50 Hz. Where the thread may have it, its priority is above that of the force loops: they do not
/// delay it, nor does anything that they delay. Each sample stands for the time since the one before, so that
/// the shares are those of the whole time. Costs less than 2 % of a core in the first two seconds
/// and 0.1 % later.
class TimerWatch {
 public:
  TimerWatch();
  ~TimerWatch();
  TimerWatch(const TimerWatch&) = delete;
  TimerWatch& operator=(const TimerWatch&) = delete;

  static constexpr double kFirstCheckS = 2.0;

  /// May be called from any thread.
  TimerFigures figures() const;

 private:
  void watch();
  void record(std::int64_t late_nsec, std::int64_t period_nsec);

  SystemFiles files_;
  std::optional<ProcessorTime> at_begin_;
  std::int64_t begun_nsec_;
  std::int64_t own_nsec_at_begin_;
  std::size_t core_count_;
  mutable std::mutex mutex_;
  std::int64_t watched_nsec_ = 0;
  std::int64_t late_nsec_ = 0;
  std::int64_t worst_nsec_ = 0;
  bool ending_ = false;
  std::thread thread_;
};

}  // namespace cordis::machine
