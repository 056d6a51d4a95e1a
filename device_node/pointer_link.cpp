// device_node/pointer_link.cpp
#include "device_node/pointer_link.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "node/time.h"

namespace cordis::device {
namespace {

constexpr auto kHeldPeriod = std::chrono::milliseconds(20);
constexpr auto kFreePeriod = std::chrono::milliseconds(500);
constexpr auto kStale = std::chrono::milliseconds(250);

}  // namespace

bool PointerChoice::accept(const msg::PointerTarget& target, std::uint32_t device_id,
                           int coordinate_count, std::int64_t now_nsec) noexcept {
  if (target.device_id() != device_id || target.epoch() == 0) return false;
  const auto count = static_cast<std::uint32_t>(coordinate_count);
  if (target.coordinate_count() != count) return false;
  const auto& target_m = target.target_m();
  if (!std::all_of(target_m.begin(), target_m.begin() + count,
                   [](double value) { return std::isfinite(value); }))
    return false;
  const bool is_same = target.epoch() == epoch_;
  const bool is_busy = holds_ && now_nsec - accepted_nsec_ < silence_nsec_;
  if (is_same ? target.sequence_number() <= number_ : is_busy || !target.holds()) return false;
  epoch_ = target.epoch();
  number_ = target.sequence_number();
  holds_ = target.holds();
  accepted_nsec_ = now_nsec;
  return true;
}

PointerLink::PointerLink(dds::Participant& participant, const DeviceConfig& device,
                         PointerPort& port, std::uint64_t epoch)
    : device_(device),
      port_(port),
      choice_(kPageSilence),
      reader_(participant, dds::Topic::kPointerTarget),
      writer_(participant, dds::Topic::kPointerState) {
  state_.device_id(device.device_id);
  state_.epoch(epoch);
  state_.coordinate_count(static_cast<std::uint32_t>(device.end_effector_map.coordinate_count()));
  thread_ = std::thread([this] { loop(); });
}

PointerLink::~PointerLink() {
  ending_ = true;
  reader_.interrupt();
  thread_.join();
}

void PointerLink::loop() {
  msg::PointerTarget target;
  auto due = std::chrono::steady_clock::now();
  while (!ending_) {
    while (!ending_ && reader_.take(target)) take(target);
    const auto now = std::chrono::steady_clock::now();
    if (port_.feel.take(feel_)) felt_at_ = now;
    if (now - felt_at_ > kStale) feel_.holds = false;  // the scene plays the device no more
    if (now >= due || feel_.holds != state_.holds()) {
      publish();
      due = now + (feel_.holds ? kHeldPeriod : kFreePeriod);
    }
    if (!ending_) reader_.wait(std::max(due - now, std::chrono::steady_clock::duration(0)));
  }
}

/// Hands a target to the driver. Where a linear map joins the axes, all of them are held together.
void PointerLink::take(const msg::PointerTarget& target) {
  const EndEffectorMap& map = device_.end_effector_map;
  if (!choice_.accept(target, device_.device_id, map.coordinate_count(), node::monotonic_nsec()))
    return;
  PointerTarget wanted;
  wanted.epoch = target.epoch();
  wanted.number = target.sequence_number();
  wanted.holds = target.holds();
  wanted.held = target.held_coordinates();
  if (!map.is_identity() && wanted.held != 0) wanted.held = (1U << map.axis_count()) - 1;
  wanted.target_m = map.axes_of(target.target_m());
  if (!all_finite(wanted.target_m, kMaxAxes)) return;  // large coordinates overflow in the map
  port_.target.put(wanted);
}

/// A state that could not be written is followed by the next one.
void PointerLink::publish() {
  const EndEffectorMap& map = device_.end_effector_map;
  state_.holds(feel_.holds);
  state_.followed_epoch(feel_.epoch);
  state_.felt_number(feel_.felt_number);
  state_.felt_nsec(feel_.felt_nsec);
  state_.position_m(map.coordinates_of(feel_.position_m));
  state_.target_m(map.coordinates_of(feel_.target_m));
  state_.force_n(map.coordinate_forces_of(feel_.force_n));
  state_.sequence_number(state_.sequence_number() + 1);
  static_cast<void>(writer_.write(state_));
}

}  // namespace cordis::device
