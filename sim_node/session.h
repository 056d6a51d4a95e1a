// sim_node/session.h -- a simulation that takes part in a session: its clock, its devices, its
// viewers.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>

#include "node/dds/participant.h"
#include "node/dds/reader.h"
#include "node/dds/writer.h"
#include "node/node_main.h"
#include "node/paced_loop.h"
#include "node/status.h"
#include "sim_node/frame_publisher.h"
#include "sim_node/sim_config.h"
#include "sim_node/simulation.h"

namespace cordis::sim {

/// Runs a scene under the clock of its session until a stop is asked for, its duration is over or
/// it diverges.
class Session {
 public:
  Session(const node::NodeStart& start, SimConfig config);

  /// @return the exit code of the node: 0, or 1 when the scene diverged
  int run();

 private:
  void run_realtime();
  void run_lockstep();
  void run_asap();

  /// Takes what the devices have sent. @return whether a repeated sample wants its answer again
  void receive();
  bool receive_lockstep();  ///< false when it is time to stop
  void tick();
  void answer(DeviceExchange& device);
  void note_state();
  bool finished() const noexcept;
  void fill(msg::NodeStatus& status);
  void set_phase(const char* phase) noexcept;

  const node::NodeStart& start_;
  double duration_s_;
  dds::Participant participant_;
  Simulation simulation_;
  std::uint64_t ticks_per_frame_;
  dds::Reader<msg::GesturePositions> position_reader_;
  dds::Reader<msg::GestureForces> force_reader_;
  dds::Writer<msg::GesturePositions> position_writer_;
  dds::Writer<msg::GestureForces> force_writer_;
  dds::Writer<msg::SceneDescription> description_writer_;
  msg::GesturePositions position_sample_;
  msg::GestureForces force_sample_;
  FramePublisher frames_;

  // What the loop tells the status thread.
  struct Shown {
    engine::Energy energy;
    std::uint64_t step = 0;
    std::uint64_t state_hash = 0;
  };
  std::mutex shown_mutex_;
  Shown shown_;
  std::atomic<const char*> phase_{"starting"};
  std::atomic<std::uint64_t> ticks_{0};
  std::atomic<std::uint64_t> overruns_{0};
  std::atomic<std::uint64_t> dropped_{0};
  node::StatusPublisher status_;
};

}  // namespace cordis::sim
