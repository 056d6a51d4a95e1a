// sim_node/session.h -- a simulation that takes part in a session: what runs beside its loop.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "node/dds/participant.h"
#include "node/node_main.h"
#include "node/status.h"
#include "sim_node/device_link.h"
#include "sim_node/lockstep_loop.h"
#include "sim_node/scene_loop.h"
#include "sim_node/session_control.h"
#include "sim_node/sim_config.h"
#include "sim_node/status_snapshot.h"

namespace cordis::sim {

/// Runs a scene under the clock of its session until a stop is asked for, its duration is over or
/// it diverges.
class Session {
 public:
  Session(const node::NodeStart& start, SimConfig config);

  /// @return the exit code of the node: 0, or 1 when the scene diverged, or no device came in lockstep
  int run();

 private:
  void share_steps();
  std::string run_loop();  // why it was given up; empty: it was not
  Patience patience() const;

  const node::NodeStart& start_;
  const std::string signals_for_;  // the node that gets every row of signals; empty: none
  const std::vector<std::string> recorded_by_;  // nodes that get all answers and signals
  const std::size_t threads_;                   // as of SimConfig
  const double duration_s_;                     // likewise
  dds::Participant participant_;                // for all but the force loop
  dds::Participant loop_participant_;  // for the force loop, which waits for no other thread
  DeviceLink devices_;
  StatusSnapshot snapshot_;
  SceneLoop loop_;
  node::StatusPublisher status_;  // its thread uses what stands above
  SessionControl control_;        // likewise
};

}  // namespace cordis::sim
