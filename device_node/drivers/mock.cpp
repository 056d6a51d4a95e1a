// device_node/drivers/mock.cpp
#include "device_node/drivers/mock.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

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
  is_in_period_ = false;
  lived_ = 0.0;
  command_.fill(0.0);
  for (Axis& axis : axes_) {
    axis.key.start();
    axis.position_sensor.start();
    axis.force_sensor.start();
    if (axis.hand) axis.hand->start();
  }
  if (role == Role::kMass) return;
  for (std::size_t a = 0; a < axes_.size(); ++a) command_[a] = axes_[a].key.position_m();
}

void Mock::place(int axis, double position_m) noexcept {
  Axis& placed = axes_[static_cast<std::size_t>(axis)];
  placed.key.place(position_m);
  placed.hand->place(placed.key.position_m());
  placed.from_m = placed.key.position_m();
  if (role_ == Role::kLiaison) command_[static_cast<std::size_t>(axis)] = placed.from_m;
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
  take_command(commanded);
  step_until(sub_steps_);
  lived_ = 0.0;
  ++period_index_;
  return true;
}

bool Mock::begin_period() noexcept {
  if (std::exchange(is_in_period_, true)) {
    step_until(sub_steps_);
    ++period_index_;
  }
  lived_ = 0.0;
  take_command(command_);
  return true;
}

bool Mock::change_command(const AxisValues& commanded, double share) noexcept {
  step_until(std::clamp(share, 0.0, 1.0) * sub_steps_);
  take_command(commanded);
  return true;
}

void Mock::take_command(const AxisValues& commanded) noexcept {
  command_ = commanded;
  commanded_at_ = lived_;
  for (Axis& axis : axes_) axis.from_m = axis.key.position_m();
}

/// Lives on in the present period, in whole sub-steps where it can.
void Mock::step_until(double sub_step) noexcept {
  constexpr double kNothing = 1e-9;  // of a sub-step
  while (sub_step - lived_ > kNothing) {
    const double next = std::min(std::floor(lived_ + kNothing) + 1.0, sub_step);
    for (std::size_t a = 0; a < axes_.size(); ++a) step(axes_[a], command_[a], lived_, next);
    lived_ = next;
  }
}

/// @param from, to  the part of the period, at most a sub-step [sub-steps]
void Mock::step(Axis& axis, double commanded, double from, double to) noexcept {
  const double begin_s = static_cast<double>(period_index_) / layout_.rate_hz - axis.delay_s;
  const double h_s = (to - from) * sub_step_s_;
  const double push = force_of_hand(axis);
  if (role_ == Role::kMass) {
    axis.key.advance(h_s, commanded, push);
  } else {
    const double share = (to - commanded_at_) / (sub_steps_ - commanded_at_);
    axis.key.carry_to(axis.from_m + (commanded - axis.from_m) * share, h_s);
  }
  if (axis.hand) axis.hand->advance(begin_s + from * sub_step_s_, h_s, -push);
}

std::unique_ptr<Driver> make_mock(const config::Value& section, const AxisLayout& layout,
                                  config::Problems& problems) {
  const MockSettings settings = read_mock_settings(section, layout, problems);
  if (problems.has_errors()) return nullptr;
  try {
    return std::make_unique<Mock>(settings, layout);
  } catch (const std::invalid_argument& error) {
    problems.error(section.place(), "mock: " + std::string(error.what()));
    return nullptr;
  }
}

}  // namespace cordis::device
