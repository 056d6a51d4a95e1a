// device_node/force_guard.cpp
#include "device_node/force_guard.h"

#include <algorithm>
#include <stdexcept>

namespace cordis::device {

ForceGuard::ForceGuard(const ForceGuardSettings& settings)
    : settings_(settings), largest_change_n_(settings.slew_n_per_s * settings.period_s) {
  const bool valid = settings.limit_n > 0.0 && settings.slew_n_per_s > 0.0 &&
                     settings.ramp_s >= 0.0 && settings.watchdog_s > 0.0 && settings.period_s > 0.0;
  if (!valid) throw std::invalid_argument("a setting of the force guard is out of range");
}

void ForceGuard::start() noexcept {
  wanted_.fill(0.0);
  output_.fill(0.0);
  any_accepted_ = false;
  ticks_alive_ = 0;
}

bool ForceGuard::accept(const AxisValues& wanted_n) noexcept {
  any_accepted_ = true;
  if (all_finite(wanted_n, kMaxAxes)) {
    wanted_ = wanted_n;
    return true;
  }
  wanted_.fill(0.0);
  return false;
}

const AxisValues& ForceGuard::tick(double age_s) noexcept {
  if (!any_accepted_ || !(age_s < settings_.watchdog_s)) {
    start();
    return output_;
  }
  ++ticks_alive_;
  const double grown_s = static_cast<double>(ticks_alive_) * settings_.period_s;
  const double share = grown_s < settings_.ramp_s ? grown_s / settings_.ramp_s : 1.0;
  // What can still be brought to 0 at the slew rate before the watchdog bites.
  const double fading_n = settings_.slew_n_per_s * (settings_.watchdog_s - age_s);
  const double limit_n = std::min(settings_.limit_n, fading_n);

  for (std::size_t a = 0; a < output_.size(); ++a) {
    const double wanted = share * std::clamp(wanted_[a], -settings_.limit_n, settings_.limit_n);
    const double change = std::clamp(wanted - output_[a], -largest_change_n_, largest_change_n_);
    output_[a] = std::clamp(output_[a] + change, -limit_n, limit_n);
  }
  return output_;
}

}  // namespace cordis::device
