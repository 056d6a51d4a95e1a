// device_node/drivers/pointer.cpp
#include "device_node/drivers/pointer.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "node/config/mapping_reader.h"

namespace cordis::device {
namespace {

/// The hands that the mechanics have: one on each axis, and no gesture of their own.
MockSettings without_gestures(MockSettings mechanics, const AxisLayout& layout) {
  mechanics.gesture = {Trajectory()};
  mechanics.played.clear();
  for (int a = 0; a < layout.count; ++a) mechanics.played.push_back(a);
  mechanics.stagger_s = 0.0;
  return mechanics;
}

/// @param held  the finger is in a ring or on a handle: it pulls as well as pushes
MockSettings held(MockSettings mechanics) {
  mechanics.hand.holds = true;
  return mechanics;
}

double approach(double value, double goal, double step) noexcept {
  return value < goal ? std::min(value + step, goal) : std::max(value - step, goal);
}

}  // namespace

Pointer::Pointer(const MockSettings& mechanics, const PointerSettings& settings,
                 const AxisLayout& layout, ClockFunction clock)
    : settings_(settings),
      layout_(layout),
      period_s_(1.0 / layout.rate_hz),
      is_ring_(mechanics.hand.holds),
      clock_(clock),
      mock_(held(without_gestures(mechanics, layout)), layout) {
  start(Role::kMass);
}

void Pointer::start(Role role) noexcept {
  role_ = role;
  mock_.start(role);
  for (Axis& axis : axes_) axis = {};
  for (int a = 0; a < layout_.count; ++a) mock_.hand(a).follow(0.0, 0.0, 0.0);
  command_.fill(0.0);
  holds_ = false;
  newest_ = {};
  pending_number_ = 0;
  is_away_ = settings_.only_while_held;
}

bool Pointer::read(AxisValues& sensed) noexcept {
  return mock_.read(sensed) && !is_away_;
}

bool Pointer::begin_period() noexcept {
  const bool alive = mock_.begin_period();
  take_target();
  move_hands();
  report();
  return alive;
}

bool Pointer::change_command(const AxisValues& commanded, double share) noexcept {
  record_command(commanded);
  return mock_.change_command(commanded, share);
}

bool Pointer::write(const AxisValues& commanded) noexcept {
  record_command(commanded);
  take_target();
  move_hands();
  const bool alive = mock_.write(commanded);
  report();
  return alive;
}

/// Takes the newest target, and detects silence of the page. A target that is not finite counts as
/// silence.
void Pointer::take_target() noexcept {
  ++period_;
  PointerTarget target;
  if (port_.target.take(target) && all_finite(target.target_m, kMaxAxes)) {
    newest_ = target;
    received_nsec_ = clock_();
    if (pending_number_ == 0) {
      pending_number_ = newest_.number;
      pending_period_ = period_;
    }
  }
  const bool held_before = holds_;
  const double silent_s = static_cast<double>(clock_() - received_nsec_) * 1e-9;
  holds_ = newest_.holds && silent_s < settings_.silence_s;
  if (!holds_) return;
  if (is_away_ || !held_before) appear();
  for (int a = 0; a < layout_.count; ++a) {
    if ((newest_.held >> a & 1U) == 0) continue;
    const auto i = static_cast<std::size_t>(a);
    axes_[i].wanted_m = std::clamp(newest_.target_m[i], layout_.lowest_m, layout_.highest_m);
  }
}

/// A hold begins. A device that was away appears where its port is, at rest.
void Pointer::appear() noexcept {
  if (!is_away_) {
    for (int a = 0; a < layout_.count; ++a) {
      const auto i = static_cast<std::size_t>(a);
      axes_[i].wanted_m = axes_[i].grip > 0.0 ? axes_[i].target_m : place_within_travel(a);
    }
    return;
  }
  is_away_ = false;
  mock_.start(role_);
  for (int a = 0; a < layout_.count; ++a) {
    const auto i = static_cast<std::size_t>(a);
    const double at_m = std::clamp(newest_.target_m[i], layout_.lowest_m, layout_.highest_m);
    mock_.place(a, at_m);
    axes_[i] = {at_m, at_m, 0.0};
  }
}

/// The place of a key; at its stop, which gives way a little, the end of its travel.
double Pointer::place_within_travel(int axis) const noexcept {
  return std::clamp(mock_.position_m(axis), layout_.lowest_m, layout_.highest_m);
}

void Pointer::move_hands() noexcept {
  bool any_grip = false;
  for (int a = 0; a < layout_.count; ++a) {
    Axis& axis = axes_[static_cast<std::size_t>(a)];
    const bool is_held = (newest_.held >> a & 1U) != 0;
    const double wanted_grip = holds_ && (is_held || is_ring_) ? 1.0 : 0.0;
    if (axis.grip == 0.0 && wanted_grip > 0.0) mock_.hand(a).place(mock_.position_m(a));
    axis.grip = approach(axis.grip, wanted_grip, period_s_ / settings_.fade_s);
    if (axis.grip == 0.0) axis.wanted_m = place_within_travel(a);  // the target follows a free key
    const double limit = settings_.speed_limit_m_per_s;
    const double rate = std::clamp((axis.wanted_m - axis.target_m) / kLag, -limit, limit);
    axis.target_m += rate * period_s_;
    mock_.hand(a).follow(axis.target_m, rate, axis.grip);
    any_grip = any_grip || axis.grip > 0.0;
  }
  if (settings_.only_while_held && !holds_ && !any_grip) is_away_ = true;
}

/// The command answers a sample of an earlier period at best: a target that was taken in the present
/// one is not in it.
void Pointer::record_command(const AxisValues& commanded) noexcept {
  command_ = commanded;
  if (pending_number_ == 0 || period_ < pending_period_ + 1) return;
  feel_.felt_number = pending_number_;
  feel_.felt_nsec = clock_();
  pending_number_ = 0;
}

void Pointer::report() noexcept {
  feel_.epoch = newest_.epoch;
  feel_.holds = holds_;
  for (int a = 0; a < layout_.count; ++a) {
    const auto i = static_cast<std::size_t>(a);
    feel_.position_m[i] = mock_.position_m(a);
    feel_.target_m[i] = axes_[i].target_m;
    feel_.force_n[i] = role_ == Role::kMass ? command_[i] : -mock_.force_of_hand_n(a);
  }
  port_.feel.put(feel_);
}

std::unique_ptr<Driver> make_pointer(const config::Value& section, const AxisLayout& layout,
                                     config::Problems& problems) {
  config::MappingReader reader(section, "pointer", problems);
  PointerSettings settings;
  const config::Range seconds = config::Range::between(0.01, 10.0);
  settings.speed_limit_m_per_s =
      reader.optional_number("target_speed_limit_m_per_s", settings.speed_limit_m_per_s,
                             config::Range::between(0.01, 10.0));
  settings.silence_s = reader.optional_number("silence_s", settings.silence_s, seconds);
  settings.fade_s = reader.optional_number("fade_s", settings.fade_s, seconds);
  settings.only_while_held = reader.optional_truth("only_while_held", layout.has_other_player);
  const MockSettings mechanics = read_mechanics(reader, layout, problems);
  reader.finish();
  if (problems.has_errors()) return nullptr;
  try {
    return std::make_unique<Pointer>(mechanics, settings, layout);
  } catch (const std::invalid_argument& error) {
    problems.error(section.place(), "pointer: " + std::string(error.what()));
    return nullptr;
  }
}

}  // namespace cordis::device
