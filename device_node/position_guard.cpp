// device_node/position_guard.cpp
#include "device_node/position_guard.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace cordis::device {

PositionGuard::PositionGuard(const PositionGuardSettings& settings) : settings_(settings) {
  const bool valid = settings.lowest_m < settings.highest_m && settings.speed_m_per_s > 0.0 &&
                     settings.ramp_s >= 0.0 && settings.watchdog_s > 0.0 && settings.period_s > 0.0;
  if (!valid) throw std::invalid_argument("a setting of the position guard is out of range");
  start();
}

void PositionGuard::start() noexcept {
  output_.fill(std::clamp(0.0, settings_.lowest_m, settings_.highest_m));
  beyond_.fill(0.0);
  any_accepted_ = false;
  ticks_alive_ = 0;
}

bool PositionGuard::accept(const AxisValues& wanted_m) noexcept {
  any_accepted_ = true;
  // Also false of what is no number.
  const auto is_near = [](double wanted) { return std::abs(wanted) <= kFarthest; };
  if (std::all_of(wanted_m.begin(), wanted_m.end(), is_near)) {
    wanted_ = wanted_m;
    return true;
  }
  wanted_ = output_;
  return false;
}

const AxisValues& PositionGuard::tick(double age_s) noexcept {
  if (!any_accepted_ || !(age_s < settings_.watchdog_s)) {
    any_accepted_ = false;
    ticks_alive_ = 0;
    return output_;
  }
  ++ticks_alive_;
  const double grown_s = static_cast<double>(ticks_alive_) * settings_.period_s;
  const double share = grown_s < settings_.ramp_s ? grown_s / settings_.ramp_s : 1.0;
  const double largest_move_m = share * settings_.speed_m_per_s * settings_.period_s;

  for (std::size_t a = 0; a < output_.size(); ++a) {
    const double wanted = std::clamp(wanted_[a], settings_.lowest_m, settings_.highest_m);
    output_[a] += std::clamp(wanted - output_[a], -largest_move_m, largest_move_m);
    beyond_[a] = wanted_[a] - wanted;
  }
  return output_;
}

}  // namespace cordis::device
