// sim_node/session.cpp
#include "sim_node/session.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>

#include <spdlog/spdlog.h>

#include "node/config/count_text.h"
#include "node/machine/processor_quota.h"
#include "sim_node/asap_loop.h"
#include "sim_node/checks/device_check.h"
#include "sim_node/realtime_loop.h"
#include "sim_node/run/thread_count.h"

namespace cordis::sim {
namespace {

/// Slow motion: the loop aims at fewer ticks per second.
void report_time_scale(msg::NodeStatus& status, double time_scale) {
  if (time_scale == 1.0) return;
  status.target_rate_hz(status.target_rate_hz() * time_scale);
  const std::string text = pace_text(time_scale);
  status.text(status.text().empty() ? text : status.text() + "; " + text);
}

}  // namespace

Session::Session(const node::NodeStart& start, SimConfig config)
    : start_(start),
      signals_for_(config.signals_for),
      recorded_by_(config.recorded_by),
      threads_(config.threads),
      duration_s_(config.duration_s),
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
      status_(
          participant_, msg::KIND_SIM_NODE, start.epoch,
          [this](msg::NodeStatus& status) {
            snapshot_.fill(status, devices_.refusal(), devices_.loops());
            report_time_scale(status, loop_.time_scale());
            status.lost_events(loop_.lost_events());
          },
          [this] { snapshot_.watch(); }, &loop_participant_),
      control_(start, config.force, participant_, devices_, snapshot_, loop_, status_) {
  if (config.paused) loop_.begin_paused();
}

/// Before anything else needs the cores.
void Session::share_steps() {
  std::size_t most = machine::usable_processors();
  if (start_.launch.clock == config::Clock::kRealtime)
    most = max_threads_beside(start_.launch.nodes.size() - 1, most);
  const SharedSteps shared = sim::share_steps(loop_.simulation().world(), threads_, most);
  if (!shared.text.empty()) spdlog::info("{}", shared.text);
}

int Session::run() {
  share_steps();
  loop_.report_pauses_to(status_);
  control_.publish_first_scene();
  loop_.record_state();
  devices_.play(loop_.simulation().scene());
  devices_.start();
  control_.start();

  if (!signals_for_.empty()) loop_.wait_for_signal_reader(signals_for_);
  for (const std::string& recorder : recorded_by_) loop_.wait_for_recorder(recorder);
  snapshot_.begin();
  const std::string given_up = run_loop();
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
  if (!given_up.empty()) {
    snapshot_.record_failure(given_up);
    snapshot_.set_phase(msg::PHASE_FAILED);
    spdlog::error("{}", given_up);
    return 1;
  }
  snapshot_.set_phase(msg::PHASE_STOPPED);
  spdlog::info("state hash {:016x} after {}", simulation.world().state_hash(),
               config::count_text(simulation.world().step_count(), "step"));
  return 0;
}

/// A run that has a duration does not wait without end: wall time counts where simulated time stands.
Patience Session::patience() const {
  constexpr double kMin = 5.0;  // until a device counts as absent [s]
  if (duration_s_ <= 0.0) return {};
  const double wait_s = std::min(std::max(duration_s_, kMin), 1e9);
  return {start_.launch.file, played_devices(start_.launch),
          static_cast<std::int64_t>(std::ceil(wait_s)) * 1'000'000'000};
}

std::string Session::run_loop() {
  switch (start_.launch.clock) {
    case config::Clock::kRealtime:
      run_realtime(loop_, status_);
      break;
    case config::Clock::kLockstep:
      return LockstepLoop(loop_, participant_, patience()).run();
    case config::Clock::kAsap:
      run_asap(loop_);
      break;
  }
  return {};
}

}  // namespace cordis::sim
