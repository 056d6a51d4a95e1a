// device_node/gesture_channel.h -- how samples leave a device and how answers come to it.
#pragma once

#include <chrono>
#include <cstdint>

#include "device_node/axis.h"

namespace cordis::device {

/// One message of the force loop, in either direction: positions or forces (idl/gesture.idl).
struct GestureMessage {
  std::uint64_t epoch = 0;              ///< epoch of its writer
  std::uint64_t sample = 0;             ///< +1 per message of the epoch, from 1
  std::uint64_t answered_epoch = 0;     ///< epoch of the message it takes into account; 0: none yet
  std::uint64_t answered_sample = 0;    ///< number of that message
  std::int64_t answered_time_nsec = 0;  ///< time of that message
  std::int64_t time_nsec = 0;           ///< CLOCK_MONOTONIC
  std::uint32_t axis_count = 0;         ///< valid entries of value
  AxisValues value{};                   ///< positions [m] or forces [N]
  double work_j = 0.0;                  ///< in forces: work of the hand in the epoch
  double answer_delay_s = 0.0;          ///< delay of the newest applied answer; 0: none yet
};

/// Both directions of the force loop of one device.
class GestureChannel {
 public:
  GestureChannel() = default;
  GestureChannel(const GestureChannel&) = delete;
  GestureChannel& operator=(const GestureChannel&) = delete;
  virtual ~GestureChannel() = default;

  /// Sends a sample; false when it could not be handed over.
  [[nodiscard]] virtual bool send(const GestureMessage& sample) noexcept = 0;

  /// The next answer for this device, waiting at most so long for one (0: not at all); false when
  /// none came. Entries past axis_count are 0; nothing else about it has been checked.
  [[nodiscard]] virtual bool receive(GestureMessage& answer,
                                     std::chrono::nanoseconds at_most) noexcept = 0;

  /// Processor time in which receive() has polled instead of sleeping [s].
  virtual double polled_s() const noexcept { return 0.0; }
};

}  // namespace cordis::device
