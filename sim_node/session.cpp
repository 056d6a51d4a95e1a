// sim_node/session.cpp
#include "sim_node/session.h"

#include <cmath>
#include <memory>
#include <utility>

#include <spdlog/spdlog.h>

#include "node/config/count_text.h"
#include "sim_node/asap_loop.h"
#include "sim_node/checks/stability_check.h"
#include "sim_node/lockstep_loop.h"
#include "sim_node/realtime_loop.h"
#include "sim_node/run/describe.h"
#include "sim_node/scene/naming.h"

namespace cordis::sim {

Session::Session(const node::NodeStart& start, SimConfig config)
    : start_(start),
      signals_for_(config.signals_for),
      participant_(start.config()),
      loop_participant_(start.join_for_force_loop()),
      devices_(participant_, loop_participant_, start.epoch, start.launch.clock,
               config.delay_quantile),
      snapshot_(start.launch.clock),
      loop_(start,
            std::make_unique<LoadedScene>(
                std::make_shared<const scene::Scene>(std::move(config.scene)), start.epoch, 1),
            std::move(config.source), config.duration_s, config.force, participant_, devices_,
            snapshot_),
      description_writer_(participant_, dds::Topic::kDescription),
      status_(participant_, msg::KIND_SIM_NODE, start.epoch,
              [this](msg::NodeStatus& status) {
                snapshot_.fill(status, devices_.refusal(), devices_.loops());
                status.lost_events(loop_.lost_events());
              }),
      executor_(
          loop_.mailbox(), loop_.simulation().shared_scene(), start.epoch,
          [this, force = config.force](const std::string& path, config::Problems& problems) {
            return load_next_scene(start_.launch, path, force, problems);
          },
          [force = config.force](const scene::Scene& scene, config::Problems& problems) {
            check_stability(scene, force, problems);
          },
          [this](const scene::Scene& scene, std::uint64_t version) {
            publish_scene(scene, version);
          }),
      commands_(
          participant_, msg::KIND_SIM_NODE,
          [this](const msg::ControlCommand& command) {
            return execute([&] { return executor_.execute(command); });
          },
          [this](const msg::ControlCommand& command) -> node::Work {
            node::Work work = executor_.work_of(command);
            if (!work) return {};
            return [this, work = std::move(work)]() -> node::Finish {
              return [this, finish = work()] { return execute(finish); };
            };
          }) {}

int Session::run() {
  publish_scene(loop_.simulation().scene(), 1);
  loop_.record_state();
  devices_.play(loop_.simulation().scene());
  devices_.start();
  commands_.start();

  if (!signals_for_.empty()) loop_.wait_for_signal_reader(signals_for_);
  snapshot_.begin();
  run_loop();
  loop_.show_rest();
  loop_.mailbox().close();
  snapshot_.end();
  loop_.record_state();
  const Simulation& simulation = loop_.simulation();
  if (simulation.failed()) {
    devices_.answer_all(loop_.simulation());  // no force
    const std::string failure = simulation.failure();
    snapshot_.record_failure(failure);
    snapshot_.set_phase(msg::PHASE_FAILED);
    spdlog::error("{}", failure);
    return 1;
  }
  snapshot_.set_phase(msg::PHASE_STOPPED);
  spdlog::info("state hash {:016x} after {}", simulation.world().state_hash(),
               config::count_text(simulation.world().step_count(), "step"));
  return 0;
}

void Session::run_loop() {
  switch (start_.launch.clock) {
    case config::Clock::kRealtime:
      return run_realtime(loop_);
    case config::Clock::kLockstep:
      return LockstepLoop(loop_, participant_).run();
    case config::Clock::kAsap:
      return run_asap(loop_);
  }
}

/// In the thread of the commands.
node::Answer Session::execute(const std::function<node::Answer()>& command) {
  const auto before = executor_.scene();
  node::Answer answer = command();
  if (executor_.scene() != before) devices_.play(*executor_.scene());
  snapshot_.change_shadow(loop_.runner().loaded_scene().shadow);
  return answer;
}

void Session::publish_scene(const scene::Scene& scene, std::uint64_t version) {
  snapshot_.change_scene(scene, version);
  msg::SceneDescription description = describe(scene, start_.epoch, version);
  if (!description_writer_.write(description))
    spdlog::error("DDS did not take the description of scene '{}'", scene.name);
  spdlog::info("scene '{}': {}, {} steps per second, {} per gesture", scene.name,
               scene::size_text(scene), scene.step_rate_hz,
               config::number_text(scene.step_rate_hz / scene.gesture_rate_hz));
}

}  // namespace cordis::sim
