// sim_node/session_control.h -- the commands of a session, and the scene that they change.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "idl/scene.h"
#include "node/command_listener.h"
#include "node/dds/participant.h"
#include "node/dds/writer.h"
#include "node/node_main.h"
#include "node/status.h"
#include "sim_node/device_link.h"
#include "sim_node/run/command_executor.h"
#include "sim_node/scene_loop.h"
#include "sim_node/status_snapshot.h"

namespace cordis::sim {

/// Simulated time per real time as words: `plays 0.1 times as fast as in real time`.
std::string pace_text(double time_scale);

/// Executes commands in a thread of its own, and fits to the scene what depends on it: its published
/// description, the demands on devices, the figures of the status.
class SessionControl {
 public:
  /// All that is referred to must outlive this.
  /// @param is_forced  a scene is loaded though it is not certified to be stable
  SessionControl(const node::NodeStart& start, bool is_forced, dds::Participant& participant,
                 DeviceLink& devices, StatusSnapshot& snapshot, SceneLoop& loop,
                 node::StatusPublisher& status);

  /// Publishes the first scene. Before start().
  void publish_first_scene() { publish_scene(*executor_.scene(), 1); }
  /// From now on commands are executed.
  void start() { commands_.start(); }

 private:
  node::Answer execute(const msg::ControlCommand& command);
  node::Answer execute(msg::ControlVerb verb, const std::function<node::Answer()>& command);
  node::Answer change_time_scale(const std::string& argument);
  void publish_scene(const scene::Scene& scene, std::uint64_t version);

  std::uint64_t epoch_;
  config::Clock clock_;
  DeviceLink& devices_;
  StatusSnapshot& snapshot_;
  SceneLoop& loop_;
  node::StatusPublisher& status_;
  dds::Writer<msg::SceneDescription> description_writer_;
  CommandExecutor executor_;
  node::CommandListener commands_;  // its thread uses what stands above
};

}  // namespace cordis::sim
