// device_node/device.h -- one device in a session, from the first scene to the wish to stop.
#pragma once

#include <cstdint>
#include <memory>

#include "device_node/device_config.h"
#include "device_node/exchange.h"
#include "device_node/loop_meter.h"
#include "device_node/scene_part.h"
#include "idl/gesture.h"
#include "idl/scene.h"
#include "node/config/launch.h"
#include "node/dds/participant.h"
#include "node/dds/reader.h"
#include "node/dds/writer.h"
#include "node/status.h"

namespace cordis::device {

/// Waits for a scene that names the device, plays the role that the scene gives it, and goes on
/// with the next scene when the scene changes or sim_node starts anew; until a stop is requested.
class Device {
 public:
  /// @param run  identifies this process on the wire
  /// @throws std::runtime_error when DDS refuses.
  Device(LoadedDevice device, dds::Participant& participant, config::Clock clock,
         std::uint64_t run);

  /// Returns the exit code of the node: 0 after a stop, 2 when the scene wants what the device
  /// does not have. The calling thread becomes the loop thread. @throws as the constructor.
  int live();

 private:
  void describe();
  void note_unused();
  bool hear_scene();
  bool look_around();
  void play();
  void play_paced(Exchange& exchange);
  void play_in_lockstep(Exchange& exchange);
  bool keep_asking(Exchange& exchange);
  void leave(Exchange& exchange);
  void ask_for_realtime();
  void note_phase(const Exchange& exchange);
  void end(Phase phase);

  DeviceConfig config_;
  std::unique_ptr<Driver> driver_;
  dds::Participant& participant_;
  config::Clock clock_;
  dds::Reader<msg::SceneDescription> scenes_;
  dds::Writer<msg::DeviceDescription> description_;
  msg::SceneDescription scene_;
  ScenePart part_;
  Exchange::Series series_;
  LoopMeter meter_;
  Phase noted_phase_ = Phase::kWaiting;
  std::int64_t lost_since_nsec_ = 0;
  bool realtime_asked_ = false;
  bool silence_told_ = false;
  node::StatusPublisher status_;  // last: its thread reads what stands above
};

}  // namespace cordis::device
