// sim_node/delay_account.cpp
#include "sim_node/delay_account.h"

#include <algorithm>

namespace cordis::sim {

void DelayAccount::enter(double made_j, double taken_j, double moved_j) noexcept {
  // A law that is no potential may give back what it took, and take it again: that counts once.
  const double newly_taken = std::max(taken_j - taken_, 0.0);
  taken_ += newly_taken;
  moved_ = std::max(moved_ * (1.0 - 1.0 / memory_), moved_j);
  account_ = std::max(account_ + made_j - kShare * newly_taken, -kTank);
  const double allowed = kBudget + kOnItsWay * moved_;
  makes_energy_ = account_ > (makes_energy_ ? 0.0 : allowed);
  account_ = std::min(account_, allowed);  // what is made from now on is braked
}

}  // namespace cordis::sim
