// device_node/scene_watch.h -- follows what scenes want of a device, beside its loop.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>

#include "device_node/device_config.h"
#include "idl/control.h"
#include "idl/scene.h"
#include "node/dds/arrival.h"
#include "node/dds/participant.h"
#include "node/dds/reader.h"
#include "node/repeated_event.h"

namespace cordis::device {

/// Takes scene/description in a thread of its own, decodes it there, and hands the part of the
/// device to the loop without a lock. A description that wants what no device or this one does not
/// have is refused and reported: the part before it stays.
class SceneWatch {
 public:
  /// What the newest scene wants of the device.
  struct Part {
    bool is_present = false;    ///< a scene is present
    bool wanted = false;        ///< and it has a port for the device
    Role role = Role::kMass;    ///< in all its ports
    std::uint32_t version = 0;  ///< +1 with every change of the above

    bool operator==(const Part&) const = default;
  };

  /// What is referred to must outlive the watch.
  SceneWatch(dds::Participant& participant, const DeviceConfig& device, const Driver& driver);
  ~SceneWatch();
  SceneWatch(const SceneWatch&) = delete;
  SceneWatch& operator=(const SceneWatch&) = delete;

  /// Real time: one atomic read.
  Part part() const noexcept;

  /// Simulated time per real time, as the sim_node of the scene says; 1 when it says nothing. Real
  /// time: one atomic read.
  double time_scale() const noexcept { return time_scale_.load(std::memory_order_relaxed); }

  /// Waits until the part is no longer this one, at most so long. Not in real time.
  void wait_for_another(const Part& known, std::chrono::milliseconds at_most) const;

  /// Why the newest description was refused; empty when it was not. Not in real time.
  std::string refusal() const;

 private:
  void loop();
  void take(const msg::SceneDescription& scene);
  void take_statuses();
  void update_time_scale() noexcept;
  void refuse(const std::string& why);
  void record_part(const Part& part, const msg::SceneDescription& scene);

  const DeviceConfig& device_;
  const Driver& driver_;
  dds::Arrival arrival_;
  dds::Reader<msg::SceneDescription> reader_;
  dds::Reader<msg::NodeStatus> status_reader_;
  msg::NodeStatus status_;          // of the thread, as the next four
  std::uint64_t epoch_ = 0;         // of the newest scene
  double gesture_rate_hz_ = 0.0;    // of it
  std::uint64_t status_epoch_ = 0;  // of the last sim_node that reported
  double target_rate_hz_ = 0.0;     // of it
  node::RepeatedEvent questions_{"other scenes are questionable"};  // of the thread
  node::RepeatedEvent changes_{"the part of the device in the scene changed", spdlog::level::info};
  node::RepeatedEvent refusals_{"other descriptions of scenes were refused", spdlog::level::err};
  std::string questionable_;         // of the thread
  std::atomic<std::uint64_t> part_;  // packed
  std::atomic<double> time_scale_{1.0};
  mutable std::mutex refusal_mutex_;  // of the thread and who reports the status
  std::string refusal_;
  std::atomic<bool> ending_{false};
  std::thread thread_;
};

}  // namespace cordis::device
