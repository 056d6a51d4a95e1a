// sim_node/delay_account.cpp
#include "sim_node/delay_account.h"

#include <algorithm>

namespace cordis::sim {

void DelayAccount::join(double taken_j) noexcept {
  if (devices_++ == 0) taken_ = taken_j;
}

void DelayAccount::leave() noexcept {
  if (--devices_ > 0) return;
  makes_energy_ = false;
  account_ = moved_ = 0.0;
}

void DelayAccount::enter(double made_j, double taken_j, double moved_j) noexcept {
  // A law that is no potential may give back what it took, and take it again: that counts once. One
  // that drives the scene is followed downwards.
  taken_ = std::min(taken_, taken_j + kTank);
  const double newly_taken = std::max(taken_j - taken_, 0.0);
  taken_ += newly_taken;
  moved_ = std::max(moved_ * (1.0 - 1.0 / (memory_ticks_ * devices_)), moved_j);
  account_ = std::max(account_ + made_j - kShare * newly_taken, -kTank);
  const double allowed = kBudget + kOnItsWay * moved_;
  makes_energy_ = account_ > (makes_energy_ ? 0.0 : allowed);
}

}  // namespace cordis::sim
