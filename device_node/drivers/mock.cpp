// device_node/drivers/mock.cpp
#include "device_node/drivers/mock.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace cordis::device {
namespace {

constexpr double kHighestSubStepRate = 100e3;  // [1/s], keeps 16 axes within 5 % of a core

/// Sub-steps per period at which the scheme is far inside its stability limit (K h^2/m + 2 Z h/m
/// < 4), and an end stop or finger adds less than 0.25 % of energy per contact: K h^2/m <= 0.01,
/// Z h/m <= 0.05 for key and hand, each with all springs and dampers that may act on it at once.
double wanted_sub_steps(const KeySettings& key, const HandSettings* hand, double period_s) {
  double step = period_s;
  const auto bound = [&step](double stiffness, double viscosity, double mass) {
    step = std::min(step, 0.1 * std::sqrt(mass / stiffness));
    if (viscosity > 0.0) step = std::min(step, 0.05 * mass / viscosity);
  };
  const double finger = hand != nullptr ? hand->finger_n_per_m : 0.0;
  const double finger_viscosity = hand != nullptr ? hand->finger_viscosity_n_s_per_m : 0.0;
  bound(key.stop_n_per_m + key.return_n_per_m + finger,
        key.stop_viscosity_n_s_per_m + finger_viscosity, key.mass_kg);
  if (hand != nullptr) bound(hand->stiffness_n_per_m + finger, finger_viscosity, hand->mass_kg);
  return std::ceil(period_s / step);
}

}  // namespace

Mock::Mock(const MockSettings& settings, const AxisLayout& layout) : layout_(layout) {
  const double period_s = 1.0 / layout.rate_hz;
  const HandSettings* hand = settings.played.empty() ? nullptr : &settings.hand;
  const double sub_steps = wanted_sub_steps(settings.key, hand, period_s);
  if (!(sub_steps * layout.rate_hz <= kHighestSubStepRate)) {
    throw std::invalid_argument(
        "its mechanics are too fast to be simulated: larger masses, or softer and less viscous "
        "stops and fingers are needed");
  }
  sub_steps_ = static_cast<int>(sub_steps);
  sub_step_s_ = period_s / sub_steps_;

  KeySettings key = settings.key;
  key.lowest_m = layout.lowest_m;
  key.highest_m = layout.highest_m;
  axes_.resize(static_cast<std::size_t>(layout.count));
  std::uint64_t seed = settings.seed;
  for (Axis& axis : axes_) {
    axis.key = MockKey(key);
    axis.position_sensor = Sensor(settings.position_sensor, ++seed << 32);
    axis.force_sensor = Sensor(settings.force_sensor, ++seed << 32);
  }
  double delay_s = 0.0;
  if (settings.gesture.size() != 1 && settings.gesture.size() != settings.played.size()) {
    throw std::invalid_argument("its hands need one path for all, or one each");
  }
  for (std::size_t h = 0; h < settings.played.size(); ++h) {
    Axis& axis = axes_.at(static_cast<std::size_t>(settings.played[h]));
    axis.hand.emplace(settings.hand, settings.gesture[settings.gesture.size() == 1 ? 0 : h]);
    axis.delay_s = delay_s;
    delay_s += settings.stagger_s;
  }
}

bool Mock::can_play(Role) const noexcept {
  return true;
}

void Mock::start(Role role) noexcept {
  role_ = role;
  period_index_ = 0;
  for (Axis& axis : axes_) {
    axis.key.start();
    axis.position_sensor.start();
    axis.force_sensor.start();
    if (axis.hand) axis.hand->start();
  }
}

double Mock::force_of_hand(const Axis& axis) const noexcept {
  return axis.hand ? axis.hand->force_on_key_n(axis.key.position_m(), axis.key.speed_m_per_s())
                   : 0.0;
}

double Mock::sense(Axis& axis) const noexcept {
  if (role_ == Role::kMass) return axis.position_sensor.read(axis.key.position_m());
  return std::clamp(axis.force_sensor.read(force_of_hand(axis)), -layout_.force_limit_n,
                    layout_.force_limit_n);
}

bool Mock::read(AxisValues& sensed) noexcept {
  sensed.fill(0.0);
  for (std::size_t a = 0; a < axes_.size(); ++a) sensed[a] = sense(axes_[a]);
  return true;
}

bool Mock::write(const AxisValues& commanded) noexcept {
  for (std::size_t a = 0; a < axes_.size(); ++a) live(axes_[a], commanded[a]);
  ++period_index_;
  return true;
}

void Mock::live(Axis& axis, double commanded) noexcept {
  const double begin_s = static_cast<double>(period_index_) / layout_.rate_hz - axis.delay_s;
  const double from_m = axis.key.position_m();
  for (int s = 0; s < sub_steps_; ++s) {
    const double push = force_of_hand(axis);
    if (role_ == Role::kMass) {
      axis.key.advance(sub_step_s_, commanded, push);
    } else {
      const double share = static_cast<double>(s + 1) / sub_steps_;
      axis.key.carry_to(from_m + (commanded - from_m) * share, sub_step_s_);
    }
    if (axis.hand) axis.hand->advance(begin_s + s * sub_step_s_, sub_step_s_, -push);
  }
}

}  // namespace cordis::device
