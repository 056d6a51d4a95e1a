// device_node/force_guard.h -- what stands between the loop and a motor that takes forces.
#pragma once

#include <cstdint>

#include "device_node/axis.h"
#include "device_node/passivity_observer.h"

namespace cordis::device {

/// What a guard allows. SI units.
struct ForceGuardSettings {
  double limit_n = 20.0;         ///< largest force, either direction, > 0
  double slew_n_per_s = 5000.0;  ///< largest change of force per second, > 0
  double ramp_s = 0.2;           ///< over which forces grow from nothing at the start, >= 0
  double watchdog_s = 0.02;      ///< age at which a force is worth nothing, > 0
  double period_s = 0.001;       ///< of the ticks, > 0
  double power_w = 40.0;         ///< most that a motor may give to one moving axis, > 0
  PassivitySettings passivity;
};

/// The last hand on every force that goes to a motor. Whatever it is given, its output
/// - never exceeds the limit, and never changes by more than slew * period in one tick;
/// - is 0 once the newest force is watchdog_s old: it fades out so as to get there in time, which
///   takes limit / slew;
/// - fades to 0 when the newest forces hold a NaN or an infinity, and stays there until good ones
///   come;
/// - grows over ramp_s at the start and after each time the watchdog has bitten;
/// - drives an axis with no more than power_w / speed, as soon as the slew limit allows;
/// - is damped by the passivity controller when the loop makes energy.
/// Should the ticks themselves stop for longer than the watchdog, the next one is 0 at once.
/// Time is counted in ticks and in the ages it is told; it knows no clock.
class ForceGuard {
 public:
  /// @throws std::invalid_argument when a setting is out of range.
  explicit ForceGuard(const ForceGuardSettings& settings);

  void start() noexcept;  ///< forgets everything: force 0, ramp at its beginning

  /// start(), and the next tick is 0 whatever is accepted until then: for a device that has been
  /// away.
  void let_go() noexcept;

  /// Takes over what is wanted from now on [N]; false when it is not finite and counts as 0.
  bool accept(const AxisValues& wanted_n) noexcept;

  /// The forces for the next period [N]. Real time: O(axes), no allocation.
  /// @param age_s       of the newest forces accepted, >= 0; anything when there have been none
  /// @param position_m  of the axes now
  const AxisValues& tick(double age_s, const AxisValues& position_m) noexcept;

  const PassivityObserver& energy() const noexcept { return energy_; }

 private:
  double within_power(double force_n, double speed_m_per_s) const noexcept;

  ForceGuardSettings settings_;
  double largest_change_n_;  // per tick
  AxisValues wanted_{};      // [N]
  AxisValues output_{};      // [N]
  bool any_accepted_ = false;
  bool let_go_ = false;
  std::uint64_t ticks_alive_ = 0;  // of the ramp
  PassivityObserver energy_;
};

}  // namespace cordis::device
