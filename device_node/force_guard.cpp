// device_node/force_guard.cpp
#include "device_node/force_guard.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace cordis::device {

ForceGuard::ForceGuard(const ForceGuardSettings& settings)
    : settings_(settings),
      largest_change_n_(settings.slew_n_per_s * settings.period_s),
      energy_(settings.passivity) {
  const bool valid = settings.limit_n > 0.0 && settings.slew_n_per_s > 0.0 &&
                     settings.ramp_s >= 0.0 && settings.watchdog_s > 0.0 &&
                     settings.period_s > 0.0 && settings.power_w > 0.0;
  if (!valid) throw std::invalid_argument("a setting of the force guard is out of range");
}

void ForceGuard::start() noexcept {
  wanted_.fill(0.0);
  output_.fill(0.0);
  any_accepted_ = false;
  let_go_ = false;
  ticks_alive_ = 0;
  energy_.start();
}

void ForceGuard::let_go() noexcept {
  start();
  let_go_ = true;
}

bool ForceGuard::accept(const AxisValues& wanted_n) noexcept {
  any_accepted_ = true;
  if (!all_finite(wanted_n, kMaxAxes)) {
    wanted_.fill(0.0);
    return false;
  }
  for (std::size_t a = 0; a < wanted_.size(); ++a) {
    wanted_[a] = std::clamp(wanted_n[a], -settings_.limit_n, settings_.limit_n);
  }
  return true;
}

/// A force along the motion gives power; against it, it takes power, and may be as large as it is.
double ForceGuard::within_power(double force_n, double speed_m_per_s) const noexcept {
  const double power = force_n * speed_m_per_s;
  return power > settings_.power_w ? settings_.power_w / speed_m_per_s : force_n;
}

const AxisValues& ForceGuard::tick(double age_s, const AxisValues& position_m) noexcept {
  if (std::exchange(let_go_, false)) return output_;
  if (!any_accepted_ || !(age_s < settings_.watchdog_s)) {
    start();
    return output_;
  }
  energy_.observe(output_, position_m);
  const auto share_after = [this](std::uint64_t ticks) {
    const double grown_s = static_cast<double>(ticks) * settings_.period_s;
    return grown_s < settings_.ramp_s ? grown_s / settings_.ramp_s : 1.0;
  };
  const double share = share_after(ticks_alive_ + 1);
  const double share_before = ticks_alive_ == 0 ? 0.0 : share_after(ticks_alive_);
  if (share > share_before) energy_.allow_for_ramp(wanted_, share - share_before);
  ++ticks_alive_;
  // What can still be brought to 0 at the slew rate before the watchdog bites.
  const double fading_n = settings_.slew_n_per_s * (settings_.watchdog_s - age_s);
  const double limit_n = std::min(settings_.limit_n, fading_n);

  for (std::size_t a = 0; a < output_.size(); ++a) {
    const double speed = energy_.speed_m_per_s(a);
    const double damped = share * wanted_[a] - energy_.damping_n(a);
    const double wanted =
        within_power(std::clamp(damped, -settings_.limit_n, settings_.limit_n), speed);
    const double change = std::clamp(wanted - output_[a], -largest_change_n_, largest_change_n_);
    output_[a] = std::clamp(output_[a] + change, -limit_n, limit_n);
  }
  return output_;
}

}  // namespace cordis::device
