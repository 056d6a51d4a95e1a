// sim_node/session.h -- a simulation that takes part in a session: what runs beside its loop.
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
#include "sim_node/sim_config.h"
#include "sim_node/status_snapshot.h"

namespace cordis::sim {

/// Runs a scene under the clock of its session until a stop is asked for, its duration is over or
/// it diverges; executes commands meanwhile.
class Session {
 public:
  Session(const node::NodeStart& start, SimConfig config);

  /// @return the exit code of the node: 0, or 1 when the scene diverged
  int run();

 private:
  void run_loop();
  /// Executes a command, and fits what depends on the scene to what it did.
  node::Answer execute(const std::function<node::Answer()>& command);
  void publish_scene(const scene::Scene& scene, std::uint64_t version);

  const node::NodeStart& start_;
  const std::string signals_for_;      // the node that gets every row of signals; empty: none
  dds::Participant participant_;       // for all but the force loop
  dds::Participant loop_participant_;  // for the force loop, which waits for no other thread
  DeviceLink devices_;
  StatusSnapshot snapshot_;
  SceneLoop loop_;
  dds::Writer<msg::SceneDescription> description_writer_;
  node::StatusPublisher status_;  // its thread uses what stands above
  CommandExecutor executor_;
  node::CommandListener commands_;  // likewise
};

}  // namespace cordis::sim
