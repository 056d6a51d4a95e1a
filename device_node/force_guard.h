// device_node/force_guard.h -- what stands between the loop and a motor that takes forces.
#pragma once

#include <cstdint>
#include <limits>

#include "device_node/axis.h"
#include "device_node/passivity_observer.h"

namespace cordis::device {

/// What a guard allows. SI units.
struct ForceGuardSettings {
  double limit_n = 20.0;         ///< largest force, either direction, > 0
  double slew_n_per_s = 5000.0;  ///< largest change of force per second, > 0
  double ramp_s = 0.2;           ///< over which forces grow from nothing at the start, >= 0
  double watchdog_s = 0.02;      ///< age at which a force is worth nothing, > 0
  double period_s = 0.001;       ///< period of the ticks, > 0
  double power_w = 40.0;         ///< most that a motor may give to one moving axis, > 0
  PassivitySettings passivity;
};

/// The last hand on every force that goes to a motor. Whatever it is given, its output
/// - never exceeds the limit, and never changes by more than slew * period in one tick;
/// - changes by no more than slew * (span + period) in any span of time, however close to each other
///   two commands of two ticks come;
/// - is 0 once the newest force is watchdog_s old: it fades out so as to get there in time, which
///   takes limit / slew;
/// - fades to 0 when the newest forces hold a NaN or an infinity, and stays there until good ones
///   come;
/// - grows over ramp_s at the start and after each time the watchdog has bitten;
/// - drives an axis with no more than power_w / speed, as soon as the slew limit allows;
/// - is damped by the passivity controller when the loop makes energy.
/// Should the ticks themselves stop for longer than the watchdog, the next one is 0 at once.
/// Time is counted in ticks, ages and spans that it is given; it knows no clock.
class ForceGuard {
 public:
  /// Since the command before: a period or longer [s].
  static constexpr double kWholePeriod = std::numeric_limits<double>::infinity();

  /// @throws std::invalid_argument when a setting is out of range.
  explicit ForceGuard(const ForceGuardSettings& settings);

  void start() noexcept;  ///< forgets everything: force 0, ramp at its beginning

  /// start(), and the next tick is 0 whatever is accepted until then: for a device that has been
  /// away.
  void let_go() noexcept;

  /// Takes over what is wanted from now on [N]; false when it is not finite and counts as 0.
  bool accept(const AxisValues& wanted_n) noexcept;

  /// The forces for a period [N], once in each. Real time: O(axes), no allocation.
  /// @param age_s       of the newest forces accepted, >= 0; anything when there have been none
  /// @param position_m  of the axes at the beginning of the period
  /// @param share       of the period that is over, 0..1: until then the forces before were held
  /// @param since_s     since the command before, >= 0; nothing else for commands that each stand for
  ///                    a whole period
  const AxisValues& tick(double age_s, const AxisValues& position_m, double share = 0.0,
                         double since_s = kWholePeriod) noexcept;

  /// The forces for the rest of the period, when newer ones have been accepted after its tick(). The
  /// two change a force by no more than slew * period together.
  const AxisValues& tick_again(double age_s, double share, double since_s) noexcept;

  const PassivityObserver& energy() const noexcept { return energy_; }

 private:
  double within_power(double force_n, double speed_m_per_s) const noexcept;
  double share_after(std::uint64_t ticks) const noexcept;
  void change(double age_s, double share, double since_s) noexcept;

  ForceGuardSettings settings_;
  double largest_change_n_;  // per tick
  AxisValues wanted_{};      // [N]
  AxisValues output_{};      // [N]
  AxisValues held_{};        // mean over the period [N]
  AxisValues changed_{};     // by how much the output has changed in the period [N]
  AxisValues rest_{};        // of the change that the time since allows, at most that of a tick [N]
  bool any_accepted_ = false;
  bool let_go_ = false;
  std::uint64_t ticks_alive_ = 0;  // of the ramp
  PassivityObserver energy_;
};

}  // namespace cordis::device
