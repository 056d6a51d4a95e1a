// device_node/passivity_observer.h -- the energy that passes from the motors to the hand, and a
// damper for a loop that makes energy.
#pragma once

#include <cstdint>

#include "device_node/axis.h"

namespace cordis::device {

/// What the observer knows of the device, and what it allows. SI units.
struct PassivitySettings {
  bool active = false;               ///< false: energy is watched, and nothing done about it
  double mass_kg = 0.05;             ///< moving part of one axis, > 0
  double viscosity_n_s_per_m = 0.0;  ///< certain viscosity of the device itself, >= 0
  double budget_j = 0.001;           ///< energy that a loop may give beyond what it took, >= 0
  double tank_j = 0.8;               ///< most that it may have taken and give back, > 0
  double travel_m = 0.04;            ///< travel of an axis, > 0
  double period_s = 0.001;           ///< > 0
};

/// Passivity observer and, for a device of role mass, capped passivity controller.
///
/// A force held over a period gives the hand exactly f[n] (x[n+1] - x[n]); of that the viscosity b
/// of the device takes at least b (x[n+1] - x[n])^2 / T. A force that changes from f0 to f1 at the
/// part s of the period counts as its mean, s f0 + (1 - s) f1: the motion between two samples is
/// taken as straight. What that leaves out is at most |f1 - f0| s (1 - s) / 2 times the bend T^2
/// |x''|. It has no mean for motions slower than half the rate of the samples. No observer of
/// samples knows what a hand does at that rate itself. The sum of the differences,
///     W = sum of f dx - b dx^2 / T  over all axes,
/// never rises above 0 when scene and delay together are passive for every hand. In the linear case
/// that holds up to K = b / (T/2 + d T). A loop whose W has exceeded the budget makes energy, and
/// from then on, until the forces restart, it is held to a stricter account: C = sum of f dx alone,
/// so that the viscosity of the device is left to calm the motion. While C is above 0 the motors
/// act as a damper a = C T / sum of dx^2, but not beyond a = m / (2 T): an uncapped one shakes the
/// hand itself. Source: Hannaford and Ryu 2002; cap and second account by experiment.
///
/// Two things would be taken for energy made from nothing, and are not. While forces are ramped up,
/// the growing share s of a force f may store up to ds |f| travel, which is added to the budget.
/// And both accounts fall without bound in a damped scene, which would let a later fault pass for
/// long: they are held above -tank.
class PassivityObserver {
 public:
  /// @throws std::invalid_argument when a setting is out of range.
  explicit PassivityObserver(const PassivitySettings& settings);

  void start() noexcept;  ///< an empty account; the next position is the first

  /// A period has passed in which `held_n` was held in the mean, and the axes are now at
  /// `position_m`.
  void observe(const AxisValues& held_n, const AxisValues& position_m) noexcept;

  /// The share of the forces `wanted_n` grows by `share`, 0..1.
  void allow_for_ramp(const AxisValues& wanted_n, double share) noexcept;

  /// What to take from the force of an axis for the next period: a force against its last motion,
  /// 0 while the account is in order [N].
  double damping_n(std::size_t axis) const noexcept { return damping_ * speed_[axis]; }

  /// Sum of f dx since start(): given to the hand, less what it gave [J].
  double given_j() const noexcept { return given_; }
  bool is_damping() const noexcept { return damping_ > 0.0; }

  /// Speed over the last period [m/s].
  double speed_m_per_s(std::size_t axis) const noexcept { return speed_[axis]; }

 private:
  PassivitySettings settings_;
  AxisValues last_{};   // [m]
  AxisValues speed_{};  // [m/s]
  bool any_position_ = false;
  double given_ = 0.0;      // [J]
  double account_ = 0.0;    // W [J]
  bool caught_ = false;     // W has exceeded the budget
  double strict_ = 0.0;     // C [J]
  double allowance_ = 0.0;  // for the ramp [J]
  double damping_ = 0.0;    // a [N s/m]
};

}  // namespace cordis::device
