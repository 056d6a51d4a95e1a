// device_node/position_guard.cpp
#include "device_node/position_guard.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "node/assert.h"

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
  rest_.fill(0.0);
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

const AxisValues& PositionGuard::tick(double age_s, double since_s) noexcept {
  if (!any_accepted_ || !(age_s < settings_.watchdog_s)) {
    any_accepted_ = false;
    ticks_alive_ = 0;
    return output_;
  }
  ++ticks_alive_;
  moved_.fill(0.0);
  move(since_s);
  return output_;
}

const AxisValues& PositionGuard::tick_again(double age_s, double since_s) noexcept {
  if (ticks_alive_ > 0 && age_s < settings_.watchdog_s) move(since_s);
  return output_;
}

void PositionGuard::move(double since_s) noexcept {
  CORDIS_ASSERT(since_s >= 0.0);
  const double grown_s = static_cast<double>(ticks_alive_) * settings_.period_s;
  const double share = grown_s < settings_.ramp_s ? grown_s / settings_.ramp_s : 1.0;
  const double speed_m_per_s = share * settings_.speed_m_per_s;
  const double largest_move_m = speed_m_per_s * settings_.period_s;

  for (std::size_t a = 0; a < output_.size(); ++a) {
    const double wanted = std::clamp(wanted_[a], settings_.lowest_m, settings_.highest_m);
    rest_[a] = std::min(rest_[a] + speed_m_per_s * since_s, largest_move_m);
    const double most = std::max(std::min(rest_[a], largest_move_m - moved_[a]), 0.0);
    const double move = std::clamp(wanted - output_[a], -most, most);
    output_[a] += move;
    moved_[a] += std::abs(move);
    rest_[a] = std::max(rest_[a] - std::abs(move), 0.0);
    beyond_[a] = wanted_[a] - wanted;
  }
}

}  // namespace cordis::device
