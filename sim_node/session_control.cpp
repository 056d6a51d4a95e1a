// sim_node/session_control.cpp
#include "sim_node/session_control.h"

#include <stdexcept>
#include <utility>

#include <spdlog/spdlog.h>

#include "node/config/number.h"
#include "node/log.h"
#include "sim_node/checks/settling.h"
#include "sim_node/checks/stability_check.h"
#include "sim_node/run/describe.h"
#include "sim_node/scene/naming.h"
#include "sim_node/sim_config.h"

namespace cordis::sim {

std::string pace_text(double time_scale) {
  return time_scale == 1.0
             ? "plays in real time"
             : "plays " + config::number_text(time_scale) + " times as fast as in real time";
}

SessionControl::SessionControl(const node::NodeStart& start, bool is_forced,
                               dds::Participant& participant, DeviceLink& devices,
                               StatusSnapshot& snapshot, SceneLoop& loop,
                               node::StatusPublisher& status)
    : epoch_(start.epoch),
      clock_(start.launch.clock),
      devices_(devices),
      snapshot_(snapshot),
      loop_(loop),
      status_(status),
      description_writer_(participant, dds::Topic::kDescription),
      executor_(
          loop.mailbox(), loop.simulation().shared_scene(), start.epoch,
          [launch = start.launch, is_forced](const std::string& path, config::Problems& problems) {
            scene::Scene scene = load_next_scene(launch, path, is_forced, problems);
            if (problems.has_errors())
              node::log_lines(spdlog::level::warn, "'load' was refused\n" + problems.text());
            return scene;
          },
          [this, is_forced](const scene::Scene& scene, config::Problems& problems) {
            check_stability(scene, is_forced, problems);
            if (const std::string why = devices_.objection_to(scene); !why.empty())
              problems.error({}, why);
          },
          [this](const scene::Scene& scene, std::uint64_t version) {
            publish_scene(scene, version);
          }),
      commands_(
          participant, msg::KIND_SIM_NODE, start.command_guard(),
          [this](const msg::ControlCommand& command) { return execute(command); },
          [this](const msg::ControlCommand& command) -> node::Work {
            node::Work work = executor_.work_of(command);
            if (!work) return {};
            return [this, work = std::move(work)]() -> node::Finish {
              return [this, finish = work()] { return execute(msg::VERB_LOAD, finish); };
            };
          }) {}

/// In the thread of the commands.
node::Answer SessionControl::execute(const msg::ControlCommand& command) {
  if (command.verb() == msg::VERB_RATE) return change_time_scale(command.argument());
  return execute(command.verb(), [&] { return executor_.execute(command); });
}

/// Changes the pace of the loop alone: the simulation stays as it is, and no take needs to know.
node::Answer SessionControl::change_time_scale(const std::string& argument) {
  double scale = 1.0;
  try {
    scale = read_command(msg::VERB_RATE, argument).time_scale;
  } catch (const std::invalid_argument& refusal) {
    return {false, refusal.what()};
  }
  if (clock_ != config::Clock::kRealtime)
    return {false, "'rate' is for realtime sessions, and this one is not"};
  const std::string real = devices_.real_devices().text();
  if (!real.empty() && scale != 1.0)
    return {false, real + " is no simulated device: it plays in real time alone"};
  loop_.set_time_scale(scale);
  status_.publish_now();
  return {true, pace_text(scale)};
}

/// In the thread of the commands.
node::Answer SessionControl::execute(msg::ControlVerb verb,
                                     const std::function<node::Answer()>& command) {
  const auto before = executor_.scene();
  const bool was_paused = snapshot_.is_paused();
  node::Answer answer = command();
  // The launcher knows whether to pause the next life of this node before the sender knows that
  // the scene is paused.
  if (snapshot_.is_paused() != was_paused) status_.publish_and_wait();
  if (verb == msg::VERB_LOAD && answer.accepted) status_.publish_now();
  if (executor_.scene() != before) devices_.play(*executor_.scene());
  const LoadedScene& loaded = loop_.runner().loaded_scene();
  snapshot_.change_shadow(loaded.shadow, loaded.watches_energy());
  return answer;
}

void SessionControl::publish_scene(const scene::Scene& scene, std::uint64_t version) {
  snapshot_.change_scene(scene, version);
  msg::SceneDescription description = describe(scene, epoch_, version);
  if (!description_writer_.write(description))
    spdlog::error("DDS did not take the description of scene '{}'", scene.name);
  spdlog::info("scene '{}': {}, {} steps per second, {} per gesture", scene.name,
               scene::size_text(scene), scene.step_rate_hz,
               config::number_text(scene.step_rate_hz / scene.gesture_rate_hz));
  if (scene.settled) spdlog::info("settled {}", settled_text(scene));
}

}  // namespace cordis::sim
