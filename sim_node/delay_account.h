// sim_node/delay_account.h -- whether forces that are late make more energy than a scene takes.
#pragma once

namespace cordis::sim {

/// One account for all the devices of role liaison of a scene.
///
/// The forces f of a hand bring E = sum of f . (x(n+1) - x(n-1)) / 2 into the scene. The hand has
/// given W, which its samples tell for the same positions, some periods later. The difference
/// M = E - W is energy from nowhere: a hand of stiffness k that is d periods T late makes k d T v^2
/// in every moment. The scene takes D, as its own account says, wherever, in whatever state and by
/// whatever law its liaisons do. While a loop comes to rest, M is below D; when it swings for
/// ever, M is D; when it swings up, M is above. So
///     A = sum of M over the devices - 0.9 D
/// does not rise while the loop is passive with a tenth to spare, but for what is on its way:
/// the spring of a hand and the scene exchange up to f . dx while an answer is late, and what the
/// port sends off is taken somewhere else a little later. An A that has risen by twice that and
/// the budget from its lowest is a loop that makes energy, until the scene has taken that much.
///
/// As long as other things in the scene lose more energy than a loop makes, it is not seen.
class DelayAccount {
 public:
  static constexpr double kShare = 0.9;     ///< of D
  static constexpr double kBudget = 0.001;  ///< [J]
  static constexpr double kOnItsWay = 2.0;  ///< times f . dx of the delay
  static constexpr double kTank = 0.05;     ///< most that A remembers to be below 0 [J]

  /// @param memory  calls of enter() after which the largest f . dx is nearly forgotten, > 0
  explicit DelayAccount(double memory) noexcept : memory_(memory) {}

  /// Once a tick for every device.
  /// @param made_j   by how much its M has grown
  /// @param taken_j  D
  /// @param moved_j  |f . dx| over its delay
  void enter(double made_j, double taken_j, double moved_j) noexcept;

  bool makes_energy() const noexcept { return makes_energy_; }
  double excess_j() const noexcept { return account_; }  ///< A [J]

 private:
  double memory_;
  bool makes_energy_ = false;
  double account_ = 0.0;  // A [J]
  double taken_ = 0.0;    // the largest D that was told [J]
  double moved_ = 0.0;    // the largest |f . dx|, fading [J]
};

}  // namespace cordis::sim
