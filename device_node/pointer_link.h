// device_node/pointer_link.h -- the hand on a page, over DDS, beside the loop of the device.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <thread>

#include "device_node/device_config.h"
#include "device_node/drivers/pointer_port.h"
#include "idl/gesture.h"
#include "node/dds/participant.h"
#include "node/dds/reader.h"
#include "node/dds/writer.h"

namespace cordis::device {

/// Which messages of pointer/target a device follows: those of one hand at a time. Another viz_node is
/// followed once the one before has let go, or has been silent for `silence_s`.
class PointerChoice {
 public:
  explicit PointerChoice(double silence_s)
      : silence_nsec_(static_cast<std::int64_t>(silence_s * 1e9)) {}

  /// True if the message is of the hand that is followed from now on, newer than the last of it, and
  /// holds finite numbers for all its coordinates. @param now_nsec  steady clock
  bool accept(const msg::PointerTarget& target, std::uint32_t device_id, int coordinate_count,
              std::int64_t now_nsec) noexcept;

 private:
  std::int64_t silence_nsec_;
  std::uint64_t epoch_ = 0;
  std::uint64_t number_ = 0;
  std::int64_t accepted_nsec_ = 0;
  bool holds_ = false;
};

/// Takes pointer/target in a thread of its own, hands it to the driver, and publishes pointer/state: 50
/// times a second while a page holds the device, and twice a second otherwise.
class PointerLink {
 public:
  /// What is referred to must outlive the link.
  PointerLink(dds::Participant& participant, const DeviceConfig& device, PointerPort& port,
              std::uint64_t epoch);
  ~PointerLink();
  PointerLink(const PointerLink&) = delete;
  PointerLink& operator=(const PointerLink&) = delete;

 private:
  void loop();
  void take(const msg::PointerTarget& target);
  void publish();

  const DeviceConfig& device_;
  PointerPort& port_;
  PointerChoice choice_;
  dds::Reader<msg::PointerTarget> reader_;
  dds::Writer<msg::PointerState> writer_;
  msg::PointerState state_;
  PointerFeel feel_;  // newest
  std::chrono::steady_clock::time_point felt_at_;
  std::atomic<bool> ending_{false};
  std::thread thread_;
};

}  // namespace cordis::device
