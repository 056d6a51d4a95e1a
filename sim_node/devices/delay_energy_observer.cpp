// sim_node/devices/delay_energy_observer.cpp
#include "sim_node/devices/delay_energy_observer.h"

#include <algorithm>

#include "node/assert.h"

namespace cordis::sim {

void DelayEnergyObserver::enter(double made_j, double uncertainty_j, double taken_j,
                                double moved_j) noexcept {
  CORDIS_ASSERT(!(uncertainty_j < 0.0));
  // A law that is no potential may give back what it took, and take it again: that counts once.
  const double newly_taken = std::max(taken_j - taken_, 0.0);
  taken_ += newly_taken;
  moved_.enter(moved_j);
  const double allowed = kBudget + kOnItsWay * moved_.value();
  // When less is allowed than before, what was allowed is no fault: only what is made from now on.
  account_ = std::min(account_, allowed) + made_j + uncertainty_j - kShare * newly_taken;
  account_ = std::max(account_, -kTank);
  makes_energy_ = account_ > (makes_energy_ ? 0.0 : allowed);
}

}  // namespace cordis::sim
