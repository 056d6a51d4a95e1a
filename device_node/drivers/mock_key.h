// device_node/drivers/mock_key.h -- the mechanics of one key, simulated.
#pragma once

namespace cordis::device {

/// What a key is made of. SI units; positions count from rest, up is positive.
struct KeySettings {
  double mass_kg = 0.05;                   ///< moving part, > 0
  double viscosity_n_s_per_m = 1.0;        ///< viscosity of the guide, >= 0
  double friction_n = 0.05;                ///< dry (Coulomb) friction, >= 0
  double return_n_per_m = 0.0;             ///< stiffness of a spring that brings it to rest, >= 0
  double stop_n_per_m = 20000.0;           ///< stiffness of the two end stops, > 0
  double stop_viscosity_n_s_per_m = 20.0;  ///< end stops, at least lowest_stop_viscosity()
  double motor_limit_n = 30.0;             ///< force at which the motor saturates, > 0
  double lowest_m = -0.04;                 ///< where the lower stop begins
  double highest_m = 0.0;                  ///< where the upper stop begins

  /// 1 % of the critical damping of mass and stop [N s/m]. A bounce then loses 6 % of its energy,
  /// far more than the at most 0.25 % that sampling the contact can add (see MockKey::advance).
  double lowest_stop_viscosity() const noexcept;
};

/// One key: a mass on a guide with viscous and dry friction, between two end stops, pushed by a
/// motor and by whatever touches it.
///
/// Scheme, per sub-step h, with all friction implicit so that it can only take energy:
///   v+ = shrink(m v + h F, h F_dry) / (m + h Z),   x+ = x + h v+
/// where F is motor + outside + return spring + stop, shrink(p, q) brings p nearer to 0 by q and
/// not past it, and a stop of overlap u pushes with max(0, K u + Z du/dt): it never pulls.
/// Source: [Luc90 V.1 Force feedback gestual transducers].
class MockKey {
 public:
  MockKey() = default;

  /// @throws std::invalid_argument when a value is out of its range.
  explicit MockKey(const KeySettings& settings);

  /// Back to rest: position 0, or the end of travel nearest to it, without speed.
  void start() noexcept;

  /// At rest at a place within the travel.
  void place(double position_m) noexcept;

  /// Moves by one sub-step. O(1), no allocation.
  /// @param h_s        length [s]; K h^2/m of a stop should stay below 0.01
  /// @param motor_n    force asked of the motor; saturates
  /// @param outside_n  force of the hand
  void advance(double h_s, double motor_n, double outside_n) noexcept;

  /// Is carried to a position, as by a motor that nothing can resist, within one sub-step.
  void carry_to(double position_m, double h_s) noexcept;

  double position_m() const noexcept { return position_; }
  double speed_m_per_s() const noexcept { return speed_; }  ///< over the last sub-step

 private:
  double stop_force() const noexcept;

  KeySettings settings_;
  double position_ = 0.0;  // [m]
  double speed_ = 0.0;     // [m/s]
};

}  // namespace cordis::device
