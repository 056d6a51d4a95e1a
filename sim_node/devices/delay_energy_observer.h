// sim_node/devices/delay_energy_observer.h -- whether forces that are late make more energy than a
// scene takes.
#pragma once

#include "sim_node/devices/recent_peak.h"

namespace cordis::sim {

/// One account for all the devices of role liaison of a scene.
///
/// The forces f of a hand bring E = sum of f . (x(n+1) - x(n-1)) / 2 into the scene. The hand has
/// given W, which its samples report for the same positions, some periods later. The difference M =
/// E - W is energy from nowhere: a hand of stiffness k that is d periods T late makes k d T v^2 in
/// every moment. The scene takes D, as its own account says, wherever, in whatever state and by
/// whatever law its liaisons do. While a loop comes to rest, M is below D. When it swings up, M is
/// above. When it swings forever, M is D, but for what W says too much. That is where a force bends
/// between two samples, as that of a saturated motor does. So
///
///     A = sum of M + |f(n) - 2 f(n-1) + f(n-2)| |dx| / 8 over the devices - 0.98 D
///
/// does not rise while the loop is passive, but for what is on its way: the spring of a hand and
/// the scene exchange up to f . dx while an answer is late, and what the port sends off is taken
/// somewhere else a little later. An A that has risen by twice that and the budget from its lowest
/// is a loop that makes energy, until the scene has taken what was too much.
///
/// As long as other things in the scene lose more energy than a loop makes, it is not seen.
class DelayEnergyObserver {
 public:
  static constexpr double kShare = 0.98;    ///< counted part of D
  static constexpr double kBudget = 0.001;  ///< [J]
  static constexpr double kOnItsWay = 2.0;  ///< times f . dx of the delay
  static constexpr double kTank = 0.05;     ///< most that A remembers to be below 0 [J]

  /// @param memory  calls of enter() for which f . dx counts, at least
  explicit DelayEnergyObserver(int memory) noexcept : moved_(memory) {}

  /// Once a tick for every device.
  /// @param made_j   by how much its M has grown
  /// @param uncertainty_j  by how much it may have grown more, >= 0
  /// @param taken_j  D
  /// @param moved_j  |f . dx| over its delay
  void enter(double made_j, double uncertainty_j, double taken_j, double moved_j) noexcept;

  bool makes_energy() const noexcept { return makes_energy_; }
  double excess_j() const noexcept { return account_; }  ///< A [J]

 private:
  RecentPeak moved_;      // [J]
  double account_ = 0.0;  // A [J]
  double taken_ = 0.0;    // the largest D that was reported [J]
  bool makes_energy_ = false;
};

}  // namespace cordis::sim
