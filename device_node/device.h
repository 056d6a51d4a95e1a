// device_node/device.h -- one device in a session, from the first scene to the request to stop.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>

#include "device_node/device_config.h"
#include "device_node/exchange.h"
#include "device_node/loop_meter.h"
#include "device_node/phase_log.h"
#include "device_node/pointer_link.h"
#include "device_node/scene_watch.h"
#include "idl/gesture.h"
#include "node/config/launch.h"
#include "node/dds/participant.h"
#include "node/dds/writer.h"
#include "node/roster.h"
#include "node/status.h"

namespace cordis::device {

/// Waits for a scene that names the device, and plays the role that the scene gives it, until a
/// stop is requested. It goes on with the next scene when the scene changes or sim_node restarts.
class Device {
 public:
  /// @param participant  for all but the force loop
  /// @param for_loop     for the force loop alone
  /// @param series       what identifies the samples of this process
  /// @throws std::runtime_error when DDS refuses.
  Device(LoadedDevice device, dds::Participant& participant, dds::Participant& for_loop,
         config::Clock clock, const Exchange::Series& series);

  /// Returns after a stop. The calling thread becomes the loop thread. @throws as the constructor.
  void run();

 private:
  void describe();
  void record_unused();
  void play(Role role);
  double time_scale() const noexcept;
  void play_paced(Exchange& exchange);
  void play_in_lockstep(Exchange& exchange);
  bool has_part() const noexcept { return scenes_.part() == part_; }
  bool await_answer(Exchange& exchange);
  void ask_again(Exchange& exchange, std::chrono::nanoseconds silent);
  void leave(Exchange& exchange);
  void keep_guardian() const noexcept;
  void ask_for_realtime();
  void record_phase(const Exchange& exchange);

  DeviceConfig config_;
  std::unique_ptr<Driver> driver_;
  dds::Participant& for_loop_;
  config::Clock clock_;
  dds::Writer<msg::DeviceDescription> description_;
  node::Roster roster_;    // looked at while no answer comes
  SceneWatch::Part part_;  // that is played
  Exchange::Series series_;
  LoopMeter meter_;
  PhaseLog phases_;
  bool realtime_asked_ = false;
  bool silence_reported_ = false;
  SceneWatch scenes_;                   // its thread reads what stands above
  node::StatusPublisher status_;        // likewise
  std::optional<PointerLink> pointer_;  // likewise; where the driver follows the hand on a page
};

}  // namespace cordis::device
