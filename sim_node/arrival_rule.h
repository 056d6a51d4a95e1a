// sim_node/arrival_rule.h -- when the tick of a gesture period begins.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "node/period_grid.h"

namespace cordis::sim {

/// Decides when a scene in real time plays its ticks: one in each period, as soon as every device
/// whose sample is due has sent it, or at the end of the period. Knows no clock and no DDS.
///
/// The rate of a device is observed: one that sends in every fourth period is waited for in every
/// fourth. A device that sent nothing in its period owes two samples in the next one: that which is
/// late, and the next. One that is lost counts as sent as soon as the number of the next one says so.
/// What comes before its period begins belongs to none.
class ArrivalRule {
 public:
  static constexpr std::size_t kMaxDevices = 64;  ///< most devices of a scene

  /// What is known of a device.
  struct Device {
    std::uint32_t id = 0;
    std::uint64_t sent = 0;  ///< samples, by their numbers: with those that were lost
    bool plays = false;      ///< it has sent, and is not silent
  };

  /// @param rate_hz   periods per second, > 0
  /// @param now_nsec  of the clock of all other times, >= 0
  ArrivalRule(double rate_hz, std::int64_t now_nsec);

  /// Restarts at another rate. Real time: allocates nothing.
  void restart(double rate_hz, std::int64_t now_nsec) noexcept;

  /// The wait for the tick begins: what has come so far belongs to no period still to be played.
  /// @param devices  of the scene, at most kMaxDevices, always in the same order
  void begin_wait(std::span<const Device> devices) noexcept;

  /// True when the tick of the period begins now.
  bool is_due(std::span<const Device> devices, std::int64_t now_nsec) noexcept;

  /// The tick begins now. @return the number of periods skipped
  std::uint64_t begin_tick(std::span<const Device> devices, std::int64_t now_nsec) noexcept;

  const node::PeriodGrid& grid() const noexcept { return grid_; }

 private:
  struct Known {
    std::uint32_t id = 0;
    std::uint64_t marked = 0;   // samples sent before the period
    std::uint64_t counted = 0;  // samples sent before the tick played last
    double interval = 1.0;      // between two samples [periods]
    std::uint64_t silent = 0;   // periods since the one with its newest sample
    std::uint64_t owed = 1;     // samples in the period in which one is due
  };
  void mark(std::span<const Device> devices) noexcept;
  bool have_come(std::span<const Device> devices) const noexcept;
  static bool is_sample_due(const Known& known) noexcept;

  node::PeriodGrid grid_;
  std::vector<Known> known_;
};

}  // namespace cordis::sim
