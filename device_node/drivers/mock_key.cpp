// device_node/drivers/mock_key.cpp
#include "device_node/drivers/mock_key.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace cordis::device {

double KeySettings::lowest_stop_viscosity() const noexcept {
  return 0.01 * 2.0 * std::sqrt(stop_n_per_m * mass_kg);
}

MockKey::MockKey(const KeySettings& settings) : settings_(settings) {
  const bool valid = settings.mass_kg > 0.0 && settings.viscosity_n_s_per_m >= 0.0 &&
                     settings.friction_n >= 0.0 && settings.return_n_per_m >= 0.0 &&
                     settings.stop_n_per_m > 0.0 && settings.motor_limit_n > 0.0 &&
                     settings.stop_viscosity_n_s_per_m >= settings.lowest_stop_viscosity() &&
                     settings.lowest_m < settings.highest_m;
  if (!valid) throw std::invalid_argument("a setting of the key is out of range");
  start();
}

void MockKey::start() noexcept {
  place(0.0);
}

void MockKey::place(double position_m) noexcept {
  position_ = std::clamp(position_m, settings_.lowest_m, settings_.highest_m);
  speed_ = 0.0;
}

double MockKey::stop_force() const noexcept {
  const double below = settings_.lowest_m - position_;
  const double above = position_ - settings_.highest_m;
  if (below > 0.0) {
    return std::max(0.0,
                    settings_.stop_n_per_m * below - settings_.stop_viscosity_n_s_per_m * speed_);
  }
  if (above > 0.0) {
    return -std::max(0.0,
                     settings_.stop_n_per_m * above + settings_.stop_viscosity_n_s_per_m * speed_);
  }
  return 0.0;
}

void MockKey::advance(double h_s, double motor_n, double outside_n) noexcept {
  const double motor = std::clamp(motor_n, -settings_.motor_limit_n, settings_.motor_limit_n);
  const double force = motor + outside_n - settings_.return_n_per_m * position_ + stop_force();

  const double impulse = settings_.mass_kg * speed_ + h_s * force;  // [N s]
  const double dry = h_s * settings_.friction_n;                    // the most friction can take
  const double left = std::abs(impulse) <= dry ? 0.0 : impulse - std::copysign(dry, impulse);
  speed_ = left / (settings_.mass_kg + h_s * settings_.viscosity_n_s_per_m);
  position_ += h_s * speed_;
}

void MockKey::carry_to(double position_m, double h_s) noexcept {
  speed_ = (position_m - position_) / h_s;
  position_ = position_m;
}

}  // namespace cordis::device
