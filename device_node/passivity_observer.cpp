// device_node/passivity_observer.cpp
#include "device_node/passivity_observer.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace cordis::device {

PassivityObserver::PassivityObserver(const PassivitySettings& settings) : settings_(settings) {
  const bool valid = settings.mass_kg > 0.0 && settings.viscosity_n_s_per_m >= 0.0 &&
                     settings.budget_j >= 0.0 && settings.tank_j > 0.0 && settings.travel_m > 0.0 &&
                     settings.period_s > 0.0;
  if (!valid) throw std::invalid_argument("a setting of the passivity observer is out of range");
}

void PassivityObserver::start() noexcept {
  speed_.fill(0.0);
  any_position_ = false;
  given_ = account_ = strict_ = allowance_ = damping_ = 0.0;
  caught_ = false;
}

void PassivityObserver::observe(const AxisValues& held_n, const AxisValues& position_m) noexcept {
  damping_ = 0.0;
  if (!std::exchange(any_position_, true)) {
    last_ = position_m;
    return;
  }
  double moved_squared = 0.0;  // [m^2]
  double work = 0.0;           // [J]
  for (std::size_t a = 0; a < position_m.size(); ++a) {
    const double moved = position_m[a] - last_[a];
    speed_[a] = moved / settings_.period_s;
    work += held_n[a] * moved;
    moved_squared += moved * moved;
  }
  last_ = position_m;
  given_ += work;
  account_ += work - settings_.viscosity_n_s_per_m * moved_squared / settings_.period_s;
  account_ = std::max(account_, -settings_.tank_j);
  if (caught_) {
    strict_ = std::max(strict_ + work, -settings_.tank_j);
  } else if (settings_.active && account_ > settings_.budget_j + allowance_) {
    caught_ = true;
    strict_ = account_;
  }
  if (strict_ <= 0.0 || moved_squared == 0.0) return;
  const double largest = 0.5 * settings_.mass_kg / settings_.period_s;
  damping_ = std::min(largest, strict_ * settings_.period_s / moved_squared);
}

void PassivityObserver::allow_for_ramp(const AxisValues& wanted_n, double share) noexcept {
  for (const double wanted : wanted_n) allowance_ += share * std::abs(wanted) * settings_.travel_m;
}

}  // namespace cordis::device
