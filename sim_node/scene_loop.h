// sim_node/scene_loop.h -- what a turn of the loop consists of, whatever the clock.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>

#include "node/node_main.h"
#include "node/repeated_event.h"
#include "node/status.h"
#include "sim_node/device_link.h"
#include "sim_node/frame_publisher.h"
#include "sim_node/input_publisher.h"
#include "sim_node/run/input_log.h"
#include "sim_node/run/request.h"
#include "sim_node/run/runner.h"
#include "sim_node/sound_publisher.h"
#include "sim_node/status_snapshot.h"

namespace cordis::sim {

/// Plays a scene, executes requests, publishes frames and leaves figures for the status. The loops
/// of the three clocks (realtime_loop.h, lockstep_loop.h, asap_loop.h) call it; they belong to one
/// thread.
class SceneLoop {
 public:
  /// All that is referred to must outlive the loop. @param duration_s  0: without end
  /// @param is_forced  the scene keeps its devices beyond a bound that is not certified
  /// @param source     of the scene
  SceneLoop(const node::NodeStart& start, std::unique_ptr<LoadedScene> scene, SceneSource source,
            double duration_s, bool is_forced, dds::Participant& participant, DeviceLink& devices,
            StatusSnapshot& status);

  /// Before the first turn: the scene is paused at its start, as by a command.
  void begin_paused();
  /// Before the first turn: whom a pause is reported to at once.
  void report_pauses_to(node::StatusPublisher& publisher) noexcept { publisher_ = &publisher; }
  /// Before the first turn: FramePublisher::wait_for_signal_reader(), at most 5 s.
  void wait_for_signal_reader(const std::string& node);
  /// Before the first turn: waits until a node reads the answers to devices and the signals that
  /// this scene has, at most 5 s. Without real time it gets every frame.
  void wait_for_recorder(const std::string& node);

  /// True when a stop is asked for, the scene diverged, or the duration is over.
  bool finished() const noexcept;

  /// Executes the request that waits, if any. A scene that is loaded begins in real time. @return
  /// false when it brings another scene, and this one stays paused until its frames and events are
  /// published
  bool execute();
  /// Executes requests without real time, and waits a while when the scene is paused.
  /// @return whether it moves
  bool execute_or_wait();

  /// One turn of the runner. @return whether a tick is complete
  bool play();
  /// Reads the signals of a complete tick, and submits a frame when one is due.
  void show(bool complete);
  /// The run is over: submits what no frame has shown yet.
  void show_rest();
  /// play() and show(). @return whether a tick is complete
  bool advance();

  /// Leaves the figures of now for the status, and says when a mass touches more others than the
  /// step is certified for.
  void record_state();

  Runner& runner() noexcept { return runner_; }
  Simulation& simulation() noexcept { return runner_.simulation(); }
  const Simulation& simulation() const noexcept { return runner_.simulation(); }
  RequestMailbox& mailbox() noexcept { return mailbox_; }
  InputLog& inputs() noexcept { return inputs_; }
  DeviceLink& devices() noexcept { return devices_; }
  /// Seconds of simulated time per second of real time. Any thread.
  void set_time_scale(double scale) noexcept { time_scale_ = scale; }
  double time_scale() const noexcept { return time_scale_; }
  StatusSnapshot& status() noexcept { return status_; }
  /// Any thread.
  std::uint64_t lost_events() const noexcept { return frames_.lost_events(); }

 private:
  bool is_recorded_by(const std::string& node) const;
  void submit_frame();
  void report_partners(const PartnersSeen& seen);
  void watch_bounds(bool is_frame);
  void take_steps(LoadedScene& loaded) noexcept;
  std::uint64_t ticks_per_frame(const LoadedScene& loaded) const noexcept;

  config::Clock clock_;
  double duration_s_;
  bool is_forced_;
  Runner runner_;
  RequestMailbox mailbox_;
  InputLog inputs_;
  InputPublisher input_publisher_;
  FramePublisher frames_;
  SoundPublisher sounds_;
  DeviceLink& devices_;
  StatusSnapshot& status_;
  node::StatusPublisher* publisher_ = nullptr;  // null before a run
  const dds::Participant& participant_;
  std::atomic<double> time_scale_{1.0};
  std::uint64_t turns_ = 0;  // for the pace of frames while the scene is paused
  node::RepeatedEvent crowding_{"a mass of a set touched still more others"};
  std::uint32_t partners_reported_ = 0;  // of this scene
};

}  // namespace cordis::sim
