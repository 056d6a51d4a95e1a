// device_node/force_guard.h -- what stands between the loop and a motor that takes forces.
#pragma once

#include <cstdint>

#include "device_node/axis.h"

namespace cordis::device {

/// What a guard allows. SI units.
struct ForceGuardSettings {
  double limit_n = 20.0;         ///< largest force, either direction, > 0
  double slew_n_per_s = 5000.0;  ///< largest change of force per second, > 0
  double ramp_s = 0.2;           ///< over which forces grow from nothing at the start, >= 0
  double watchdog_s = 0.02;      ///< age at which a force is worth nothing, > 0
  double period_s = 0.001;       ///< of the ticks, > 0
};

/// The last hand on every force that goes to a motor. Whatever it is given, its output
/// - never exceeds the limit, and never changes by more than slew * period in one tick;
/// - is 0 once the newest force is watchdog_s old: it fades out so as to get there in time, which
///   takes limit / slew;
/// - fades to 0 when the newest forces hold a NaN or an infinity, and stays there until good ones
///   come;
/// - grows over ramp_s at the start and after each time the watchdog has bitten.
/// Should the ticks themselves stop for longer than the watchdog, the next one is 0 at once.
/// Time is counted in ticks and in the ages it is told; it knows no clock.
class ForceGuard {
 public:
  /// @throws std::invalid_argument when a setting is out of range.
  explicit ForceGuard(const ForceGuardSettings& settings);

  void start() noexcept;  ///< forgets everything: force 0, ramp at its beginning

  /// Takes over what is wanted from now on [N]; false when it is not finite and counts as 0.
  bool accept(const AxisValues& wanted_n) noexcept;

  /// The forces for the next period [N]. Real time: O(axes), no allocation.
  /// @param age_s  of the newest forces accepted, >= 0; anything when there have been none
  const AxisValues& tick(double age_s) noexcept;

 private:
  ForceGuardSettings settings_;
  double largest_change_n_;  // per tick
  AxisValues wanted_{};      // [N]
  AxisValues output_{};      // [N]
  bool any_accepted_ = false;
  std::uint64_t ticks_alive_ = 0;  // of the ramp
};

}  // namespace cordis::device
