// device_node/position_guard.h -- what stands between the loop and a motor that takes positions.
#pragma once

#include <cstdint>
#include <limits>

#include "device_node/axis.h"

namespace cordis::device {

/// What a guard allows. SI units.
struct PositionGuardSettings {
  double lowest_m = -0.04;     ///< lower end of travel
  double highest_m = 0.0;      ///< upper end of travel
  double speed_m_per_s = 2.0;  ///< largest speed at which a key is carried, > 0
  double ramp_s = 0.2;         ///< over which that speed grows from nothing at the start, >= 0
  double watchdog_s = 0.02;    ///< age at which a position is worth nothing, > 0
  double period_s = 0.001;     ///< period of the ticks, > 0
};

/// The last hand on every position that goes to a motor, for a device of role liaison. Whatever it
/// is given, its output
/// - never leaves the travel, and never moves by more than speed * period in one tick, nor by more
///   than speed * (span + period) in any span of time;
/// - stays where it is once the newest position is watchdog_s old, and while the newest positions
///   hold a NaN or an infinity;
/// - moves slowly at first, at the start and after each time the watchdog has bitten.
/// Time is counted in ticks, ages and spans that it is given; it knows no clock.
class PositionGuard {
 public:
  /// Since the command before: a period or longer [s].
  static constexpr double kWholePeriod = std::numeric_limits<double>::infinity();
  static constexpr double kFarthest = 100.0;  ///< largest coordinate that a scene may want [m]

  /// @throws std::invalid_argument when a setting is out of range.
  explicit PositionGuard(const PositionGuardSettings& settings);

  void start() noexcept;  ///< forgets everything: at rest at position 0, or the end nearest to it

  /// Takes over what is wanted from now on [m]; false when it is not finite or beyond kFarthest:
  /// then it stays.
  bool accept(const AxisValues& wanted_m) noexcept;

  /// The positions for the end of the next period [m]. Real time: O(axes), no allocation.
  /// @param age_s  of the newest positions accepted, >= 0; anything when there have been none
  /// @param since_s  since the command before, >= 0; nothing else for commands that each stand for a
  ///                 whole period
  const AxisValues& tick(double age_s, double since_s = kWholePeriod) noexcept;

  /// Likewise for newer positions that were accepted after the tick() of the period. The two move
  /// an axis by no more than speed * period together.
  const AxisValues& tick_again(double age_s, double since_s) noexcept;

  /// How much farther than the travel goes the axes are wanted, where age_s allows for it [m].
  const AxisValues& beyond_m() const noexcept { return beyond_; }

 private:
  void move(double since_s) noexcept;

  PositionGuardSettings settings_;
  AxisValues wanted_{};  // [m]
  AxisValues output_{};  // [m]
  AxisValues moved_{};   // by how much the output has moved in the period [m]
  AxisValues rest_{};    // of the way that the time since allows, at most that of a tick [m]
  AxisValues beyond_{};  // [m]
  bool any_accepted_ = false;
  std::uint64_t ticks_alive_ = 0;  // of the ramp
};

}  // namespace cordis::device
