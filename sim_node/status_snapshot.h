// sim_node/status_snapshot.h -- what the loop leaves for the thread that publishes the status.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "idl/control.h"
#include "idl/scene.h"
#include "node/config/launch.h"
#include "node/late_ticks.h"
#include "node/repeated_event.h"
#include "sim_node/run/runner.h"

namespace cordis::sim {

/// The figures of a status, of one moment of the loop. The loop writes them and never waits; the
/// status thread reads them, and warns of what a whole run shows.
class StatusSnapshot {
 public:
  explicit StatusSnapshot(config::Clock clock) : clock_(clock) {}

  /// Loop: it has begun or ended. Until begin() and after end() nothing else moves the world.
  void begin() noexcept { is_looping_ = true; }
  void end() noexcept { is_looping_ = false; }
  /// Loop: a tick is complete.
  void count_tick() noexcept { ticks_.fetch_add(1, std::memory_order_relaxed); }
  /// Loop: late and silent ticks. Wait-free.
  node::LateTicks& late_ticks() noexcept { return late_ticks_; }
  void set_phase(msg::NodePhase phase) noexcept { phase_.store(phase); }
  /// Any thread.
  bool is_paused() const noexcept { return phase_.load() == msg::PHASE_PAUSED; }
  /// Loop: the figures of now; those under the lock only when the status thread does not hold it.
  /// @param partners  of the simulation @param dropped  messages and frames that got lost on DDS
  void record(Runner& runner, const PartnersSeen& partners, std::uint64_t dropped);
  /// Loop in real time: what the status thread has ever seen of this world.
  BoundSigns signs_of(const ShadowWorld& world) const noexcept {
    return {makes_energy_.load() == world.id(), is_beyond_reach_.load() == world.id(),
            has_no_energy_.load() != world.id()};
  }
  /// Loop, at its end: why the scene diverged.
  void record_failure(std::string failure);

  /// Thread of commands: the liaisons of the scene that is played now.
  void change_scene(const scene::Scene& scene, std::uint64_t version);
  /// Thread of commands: the world whose energy the status thread looks at. The loop exchanges
  /// scenes only while a command waits for it.
  /// @param watches_energy  the status thread looks at it in each frame
  void change_shadow(std::shared_ptr<ShadowWorld> shadow, bool watches_energy);

  /// Status thread. @param refusal  why devices are refused; empty when none is
  /// @param loops  how late the devices are answered, shown when nothing is wrong
  void fill(msg::NodeStatus& status, const std::string& refusal, const std::string& loops);
  /// Status thread, 25 times a second: in real time the energy of a scene that needs it.
  void watch();

 private:
  struct Figures {
    WorldFigures of_world;
    bool is_looping = false;  // when all this was recorded
    StepTroubles troubles;
    double stability_number = 0.0;
    PartnersSeen partners{0, 0, msg::NO_INDEX};
    std::uint64_t version = 0;  // of the scene
    ChangeCounter::Counts changes{};
    std::string failure;           // why the scene diverged
    std::string crowding;          // more partners than certified
    std::string let_go;            // why the devices were let go of
    bool is_beyond_reach = false;  // LoadedScene::is_beyond_reach
  };

  void record_reach(const LoadedScene& loaded);
  void record_let_go(const Simulation& simulation, bool let_go);
  void read_shadow();
  void fill_figures(msg::NodeStatus& status) const;
  void report_passivity(std::uint64_t ticks);
  void report_integration_error(const engine::Energy& energy);

  config::Clock clock_;
  bool is_looping_ = false;  // the loop's
  std::mutex shadow_mutex_;  // of the threads of commands and of the status
  std::shared_ptr<ShadowWorld> shadow_;
  bool watches_energy_ = false;  // likewise
  std::mutex mutex_;             // of the next three
  Figures figures_;
  std::vector<std::string> liaisons_;  // names of those whose changes are published
  std::uint64_t liaisons_version_ = 0;
  bool passivity_reported_ = false;  // the status thread's, as the next two
  node::RepeatedEvent integration_errors_{"the steps made or took energy again"};
  bool error_is_passed_ = false;
  std::atomic<msg::NodePhase> phase_{msg::PHASE_STARTING};
  std::atomic<std::uint64_t> ticks_{0};  // over all scenes
  node::LateTicks late_ticks_;
  std::atomic<std::uint64_t> dropped_{0};
  std::atomic<std::uint64_t> passivity_ticks_{0};
  std::atomic<double> target_rate_hz_{0.0};
  std::atomic<std::uint64_t> makes_energy_{0};     // id of that world
  std::atomic<std::uint64_t> is_beyond_reach_{0};  // likewise, as the next
  std::atomic<std::uint64_t> has_no_energy_{0};
};

}  // namespace cordis::sim
