// device_node/gesture_wire.h -- messages of the force loop, to and from those of idl/gesture.idl.
#pragma once

#include <cstddef>
#include <cstdint>
#include <tuple>

#include "device_node/gesture_channel.h"
#include "idl/gesture.h"

namespace cordis::device::wire {

static_assert(kMaxAxes == msg::MAX_AXES);
static_assert(std::tuple_size_v<msg::PerAxis> == msg::MAX_AXES);

inline AxisValues& values_of(msg::GesturePositions& message) {
  return message.position_m();
}
inline AxisValues& values_of(msg::GestureForces& message) {
  return message.force_n();
}
inline const AxisValues& values_of(const msg::GesturePositions& message) {
  return message.position_m();
}
inline const AxisValues& values_of(const msg::GestureForces& message) {
  return message.force_n();
}

inline void put_work(double, msg::GesturePositions&) noexcept {}
inline void put_work(double work_j, msg::GestureForces& message) noexcept {
  message.work_j(work_j);
}

/// @param to  msg::GesturePositions or msg::GestureForces
template <class Message>
void put(const GestureMessage& from, std::uint32_t device_id, Message& to) noexcept {
  to.device_id(device_id);
  to.epoch(from.epoch);
  to.sample(from.sample);
  to.answered_epoch(from.answered_epoch);
  to.answered_sample(from.answered_sample);
  to.answered_time_nsec(from.answered_time_nsec);
  to.time_nsec(from.time_nsec);
  to.axis_count(from.axis_count);
  values_of(to) = from.value;
  put_work(from.work_j, to);
  to.answer_delay_s(from.answer_delay_s);
}

/// Entries past the axis count become 0. @param from  msg::GesturePositions or msg::GestureForces
template <class Message>
void take(const Message& from, GestureMessage& to) noexcept {
  to.epoch = from.epoch();
  to.sample = from.sample();
  to.answered_epoch = from.answered_epoch();
  to.answered_sample = from.answered_sample();
  to.answered_time_nsec = from.answered_time_nsec();
  to.time_nsec = from.time_nsec();
  to.axis_count = from.axis_count();
  to.value = values_of(from);
  for (std::size_t a = to.axis_count; a < to.value.size(); ++a) to.value[a] = 0.0;
}

}  // namespace cordis::device::wire
