// device_node/force_guard.cpp
#include "device_node/force_guard.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "node/assert.h"

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
  held_.fill(0.0);
  rest_.fill(0.0);
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

/// Share of the wanted forces in a tick of the ramp.
double ForceGuard::share_after(std::uint64_t ticks) const noexcept {
  const double grown_s = static_cast<double>(ticks) * settings_.period_s;
  return grown_s < settings_.ramp_s ? grown_s / settings_.ramp_s : 1.0;
}

const AxisValues& ForceGuard::tick(double age_s, const AxisValues& position_m, double share,
                                   double since_s) noexcept {
  if (std::exchange(let_go_, false)) return output_;
  if (!any_accepted_ || !(age_s < settings_.watchdog_s)) {
    start();
    return output_;
  }
  energy_.observe(held_, position_m);
  const double ramp = share_after(ticks_alive_ + 1);
  const double ramp_before = ticks_alive_ == 0 ? 0.0 : share_after(ticks_alive_);
  if (ramp > ramp_before) energy_.allow_for_ramp(wanted_, ramp - ramp_before);
  ++ticks_alive_;
  held_ = output_;
  changed_.fill(0.0);
  change(age_s, share, since_s);
  return output_;
}

const AxisValues& ForceGuard::tick_again(double age_s, double share, double since_s) noexcept {
  if (ticks_alive_ > 0 && age_s < settings_.watchdog_s) change(age_s, share, since_s);
  return output_;
}

void ForceGuard::change(double age_s, double share, double since_s) noexcept {
  CORDIS_ASSERT(age_s >= 0.0 && share >= 0.0 && share <= 1.0 && since_s >= 0.0);
  // What can still be brought to 0 at the slew rate before the watchdog bites.
  const double fading_n = settings_.slew_n_per_s * (settings_.watchdog_s - age_s);
  const double limit_n = std::min(settings_.limit_n, fading_n);
  const double ramp = share_after(ticks_alive_);

  for (std::size_t a = 0; a < output_.size(); ++a) {
    const double speed = energy_.speed_m_per_s(a);
    const double damped = ramp * wanted_[a] - energy_.damping_n(a);
    const double wanted =
        within_power(std::clamp(damped, -settings_.limit_n, settings_.limit_n), speed);
    const double before = output_[a];
    rest_[a] = std::min(rest_[a] + settings_.slew_n_per_s * since_s, largest_change_n_);
    const double most = std::max(std::min(rest_[a], largest_change_n_ - changed_[a]), 0.0);
    const double step = std::clamp(wanted - before, -most, most);
    output_[a] = std::clamp(before + step, -limit_n, limit_n);
    const double changed = std::abs(output_[a] - before);
    changed_[a] += changed;
    rest_[a] = std::max(rest_[a] - changed, 0.0);
    held_[a] = share > 0.0 ? held_[a] + (1.0 - share) * (output_[a] - before) : output_[a];
  }
}

}  // namespace cordis::device
