// device_node/drivers/hand.cpp
#include "device_node/drivers/hand.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "node/assert.h"

namespace cordis::device {

Hand::Hand(const HandSettings& settings, Trajectory target)
    : settings_(settings), target_(std::move(target)) {
  const bool valid = settings.mass_kg > 0.0 && settings.stiffness_n_per_m > 0.0 &&
                     settings.viscosity_n_s_per_m >= 0.0 && settings.finger_n_per_m > 0.0 &&
                     settings.finger_viscosity_n_s_per_m >= 0.0 && settings.force_limit_n > 0.0;
  if (!valid) throw std::invalid_argument("a setting of the hand is out of range");
  start();
}

void Hand::start() noexcept {
  place(target_.value_at(0.0));
}

void Hand::place(double position_m) noexcept {
  position_ = position_m;
  speed_ = 0.0;
}

void Hand::follow(double target_m, double target_m_per_s, double grip) noexcept {
  CORDIS_ASSERT(grip >= 0.0 && grip <= 1.0);
  followed_ = {target_m, target_m_per_s};
  grip_ = grip;
}

double Hand::force_on_key_n(double key_m, double key_m_per_s) const noexcept {
  const double overlap = key_m - position_;  // of the finger pressed from above [m]
  if (!settings_.holds && overlap <= 0.0) return 0.0;
  const double press = grip_ * (settings_.finger_n_per_m * overlap +
                                settings_.finger_viscosity_n_s_per_m * (key_m_per_s - speed_));
  return settings_.holds ? -press : -std::max(0.0, press);
}

void Hand::advance(double time_s, double h_s, double force_n) noexcept {
  const double target = followed_ ? followed_->target_m : target_.value_at(time_s);
  const double rate = followed_ ? followed_->target_m_per_s : target_.rate_at(time_s);
  const double viscosity = grip_ * settings_.viscosity_n_s_per_m;
  const double spring = grip_ * settings_.stiffness_n_per_m * (target - position_);
  const double drive = spring + viscosity * rate + force_n;
  const double before = speed_;
  speed_ = (settings_.mass_kg * speed_ + h_s * drive) / (settings_.mass_kg + h_s * viscosity);
  const double coupling_n = spring + viscosity * (rate - speed_);
  if (std::abs(coupling_n) > settings_.force_limit_n) {
    const double limited = std::copysign(settings_.force_limit_n, coupling_n) + force_n;
    speed_ = before + h_s * limited / settings_.mass_kg;
  }
  position_ += h_s * speed_;
}

}  // namespace cordis::device
