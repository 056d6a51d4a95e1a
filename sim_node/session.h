// sim_node/session.h -- a simulation that takes part in a session: its clock, its devices, its
// viewers.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "idl/scene.h"
#include "node/command_listener.h"
#include "node/dds/participant.h"
#include "node/dds/reader.h"
#include "node/dds/writer.h"
#include "node/late_ticks.h"
#include "node/node_main.h"
#include "node/paced_loop.h"
#include "node/repeated_event.h"
#include "node/roster.h"
#include "node/status.h"
#include "sim_node/devices/device_reach.h"
#include "sim_node/devices/refused_devices.h"
#include "sim_node/frame_publisher.h"
#include "sim_node/run/command_executor.h"
#include "sim_node/run/request.h"
#include "sim_node/run/runner.h"
#include "sim_node/run/shadow_world.h"
#include "sim_node/sim_config.h"

namespace cordis::sim {

/// Runs a scene under the clock of its session until a stop is asked for, its duration is over or
/// it diverges; executes commands meanwhile.
class Session {
 public:
  Session(const node::NodeStart& start, SimConfig config);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// @return the exit code of the node: 0, or 1 when the scene diverged
  int run();

 private:
  void run_realtime();
  void run_lockstep();
  void run_asap();

  /// Executes the request that waits, if any. @return false when it brings another scene, and this
  /// one stays paused until its frames and events are published
  bool execute();
  /// Executes requests without real time, and waits a while when the scene is paused.
  /// @return whether it moves
  bool execute_or_wait();
  /// Takes what the devices have sent, and answers again what was asked again.
  void receive();
  bool receive_lockstep();  ///< false when a sample is still missing
  void report_wait(const DeviceExchange& device);
  /// One turn of the player, and what follows from it: play() and show(). @return whether a tick
  /// is complete
  bool advance();
  bool play();
  void show(bool complete);
  void change_shadow();
  void look_at_shadow();
  void answer(DeviceExchange& device);
  void answer_all();
  void offer_frame();
  void report_partners();
  void record_state();
  bool finished() const noexcept;
  void fill(msg::NodeStatus& status);
  void report_integration_error(const engine::Energy& energy);
  void publish_scene(const scene::Scene& scene, std::uint64_t version);
  void set_phase(msg::NodePhase phase) noexcept;
  void listen_to_devices();

  const node::NodeStart& start_;
  double duration_s_;
  dds::Participant participant_;       // for all but the force loop
  dds::Participant loop_participant_;  // for the force loop, which waits for no other thread
  Runner runner_;
  std::mutex shadow_mutex_;              // of the threads of commands and of the status
  std::shared_ptr<ShadowWorld> shadow_;  // of the stage that is played
  RequestMailbox mailbox_;
  dds::Reader<msg::GesturePositions> position_reader_;
  dds::Reader<msg::GestureForces> force_reader_;
  dds::Writer<msg::GesturePositions> position_writer_;
  dds::Writer<msg::GestureForces> force_writer_;
  dds::Writer<msg::SceneDescription> description_writer_;
  msg::GesturePositions position_sample_;
  msg::GestureForces force_sample_;
  FramePublisher frames_;
  std::uint64_t turns_ = 0;       // of the loop, for the pace of frames while the scene is paused
  std::uint64_t tick_count_ = 0;  // over all stages
  std::int64_t waits_since_nsec_ = 0;  // in lockstep, for a sample; 0: it does not
  node::RepeatedEvent crowding_{"a mass of a set touched still more others"};
  std::uint32_t partners_reported_ = 0;  // of this scene
  bool loops_ = false;                   // the loop has begun, and has not ended
  std::uint64_t unwritten_ = 0;          // answers that DDS did not take
  node::RepeatedEvent absences_{"has been waiting long, with no device_node alive"};
  node::RepeatedEvent silences_{
      "has been waiting long for a sample of a device_node that is alive"};

  // What the loop reports to the status thread.
  struct StatusSnapshot {
    WorldLook of_world;
    bool loops = false;  // when all this was recorded
    StepTroubles troubles;
    double limit_number = 0.0;
    PartnersSeen partners{0, 0, msg::NO_INDEX};
    std::uint64_t version = 0;  // of the scene
    ChangeCounter::Counts changes{};
    std::string failure;   // why the scene diverged
    std::string crowding;  // more partners than certified
  };
  std::mutex shown_mutex_;
  StatusSnapshot shown_;
  std::vector<std::string> liaisons_;  // names of those whose changes are shown
  std::uint64_t liaisons_version_ = 0;
  bool passivity_reported_ = false;  // of the status thread, as the next two
  node::RepeatedEvent integration_errors_{"the steps made or took energy again"};
  bool error_is_passed_ = false;
  std::atomic<msg::NodePhase> phase_{msg::PHASE_STARTING};
  std::atomic<std::uint64_t> ticks_{0};
  node::LateTicks late_ticks_;
  std::atomic<std::uint64_t> dropped_{0};
  std::atomic<std::uint64_t> passivity_ticks_{0};
  std::atomic<double> target_rate_hz_{0.0};
  RefusedDevices refused_;
  ReachTable reaches_;
  dds::Reader<msg::DeviceDescription> device_reader_;
  node::Roster roster_;  // looked at while the loop waits for a sample
  node::StatusPublisher status_;
  CommandExecutor executor_;
  node::CommandListener commands_;  // its thread uses what stands above
  std::atomic<bool> ending_{false};
  std::thread device_listener_;  // likewise
};

}  // namespace cordis::sim
