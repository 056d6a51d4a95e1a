// device_node/drivers/hand.h -- a simulated hand: what plays a simulated key.
#pragma once

#include <limits>
#include <optional>

#include "device_node/drivers/trajectory.h"

namespace cordis::device {

/// What a hand is made of. SI units.
struct HandSettings {
  double mass_kg = 0.15;                    ///< finger and hand together, > 0
  double stiffness_n_per_m = 400.0;         ///< spring to the target, > 0
  double viscosity_n_s_per_m = 8.0;         ///< damper to the target, >= 0
  double finger_n_per_m = 2000.0;           ///< stiffness of the finger tip, > 0
  double finger_viscosity_n_s_per_m = 2.0;  ///< viscosity of the finger tip, >= 0
  bool holds = false;                       ///< finger in a ring; else it only pushes down
  /// Most force with which spring and damper draw the hand to its target, > 0.
  double force_limit_n = std::numeric_limits<double>::infinity();
};

/// A finger on a key. It wants to follow a target, and is a mass on a spring and a damper that pull
/// it there. So a force on it really moves it (F/K when at rest), as it does a person's.
///
///   m dv/dt = K (target - x) + Z (d target/dt - v) + F
/// Scheme: Z implicit, then x+ = x + h v+. K (target - x) + Z (d target/dt - v+) is at most the force
/// limit; v+ follows from the limit where it is more.
class Hand {
 public:
  Hand() = default;

  /// @param target  where the hand wants to be, in the coordinate of the key [m]
  /// @throws std::invalid_argument when a value is out of its range.
  Hand(const HandSettings& settings, Trajectory target);

  void start() noexcept;                   ///< at rest at the beginning of its target
  void place(double position_m) noexcept;  ///< at rest there

  /// From now on the hand follows this in place of its trajectory, and grips the key with a share of
  /// its springs and dampers, those of the finger included. @param grip  0..1; 0: nothing holds it
  void follow(double target_m, double target_m_per_s, double grip) noexcept;

  /// Force of the finger on a key there [N]: a spring-damper between them that never pulls, unless
  /// the hand holds the key.
  double force_on_key_n(double key_m, double key_m_per_s) const noexcept;

  /// Moves by one sub-step under the force on the hand. O(log moves), no allocation.
  /// @param time_s  of the beginning of the sub-step, from the start of the gesture
  void advance(double time_s, double h_s, double force_n) noexcept;

  double position_m() const noexcept { return position_; }
  double speed_m_per_s() const noexcept { return speed_; }

 private:
  HandSettings settings_;
  Trajectory target_;
  struct Followed {
    double target_m = 0.0;
    double target_m_per_s = 0.0;
  };
  std::optional<Followed> followed_;
  double grip_ = 1.0;
  double position_ = 0.0;  // [m]
  double speed_ = 0.0;     // [m/s]
};

}  // namespace cordis::device
