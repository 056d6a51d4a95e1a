// sim_node/status_snapshot.cpp
#include "sim_node/status_snapshot.h"

#include <chrono>
#include <utility>

#include <spdlog/spdlog.h>

#include "node/time.h"
#include "sim_node/run/bound_text.h"

namespace cordis::sim {
namespace {

using namespace std::chrono_literals;

constexpr auto kCopyPatience = 10ms;  // of the status thread for a copy of the world

}  // namespace

void StatusSnapshot::record(Runner& runner, const PartnersSeen& partners, std::uint64_t dropped) {
  Simulation& simulation = runner.simulation();
  std::uint64_t passivity_ticks = 0;
  const bool has_devices = clock_ != config::Clock::kAsap && !simulation.devices().empty();
  bool has_sample = !has_devices;
  for (const DeviceExchange& device : simulation.devices()) {
    dropped += device.refused_count() + device.lost_sample_count();
    has_sample = has_sample || !device.is_disconnected();
    passivity_ticks += device.passivity_ticks();
  }
  dropped_.store(dropped, std::memory_order_relaxed);
  passivity_ticks_.store(passivity_ticks, std::memory_order_relaxed);
  const bool let_go = has_devices && simulation.passed_bound() != PassedBound::kNone;
  set_phase(runner.is_paused() ? msg::PHASE_PAUSED
            : let_go           ? msg::PHASE_DISCONNECTED
            : has_sample       ? msg::PHASE_RUNNING
                               : msg::PHASE_WAITING);
  const bool realtime = clock_ == config::Clock::kRealtime;
  target_rate_hz_.store(realtime ? simulation.scene().gesture_rate_hz : 0.0,
                        std::memory_order_relaxed);

  // The status thread holds the lock for a copy at most; the loop never waits for it.
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock.owns_lock()) return;
  LoadedScene& loaded = runner.loaded_scene();
  const std::uint64_t version = loaded.frames.shape().version;
  loaded.limits.update(simulation.world());
  figures_.stability_number = loaded.limits.largest();
  if (!partners.is_passed()) {
    figures_.crowding.clear();
  } else if (partners != figures_.partners || figures_.version != version) {
    figures_.crowding = crowding_text(simulation.scene(), partners);
  }
  figures_.partners = partners;
  record_reach(loaded);
  // A scene without devices says so too; of its partners, figures_.crowding does.
  const PassedBound bound = simulation.passed_bound();
  record_let_go(simulation, let_go || (!simulation.has_devices() && bound != PassedBound::kNone &&
                                       bound != PassedBound::kPartners));
  if (!realtime || !is_looping_) {
    loaded.energy.add(simulation.largest_kinetic_energy());
    figures_.of_world = figures_of(simulation.world(), loaded.energy);
  }
  figures_.is_looping = is_looping_;
  const bool had_trouble = figures_.troubles.drive_jumps + figures_.troubles.refused_drives > 0;
  const bool had_refused = figures_.troubles.refused_parameters > 0;
  figures_.troubles = simulation.troubles();
  const bool has_trouble = figures_.troubles.drive_jumps + figures_.troubles.refused_drives > 0;
  if (has_trouble && !had_trouble) spdlog::warn("{}", drive_trouble_text(figures_.troubles));
  if (figures_.troubles.refused_parameters > 0 && !had_refused)
    spdlog::warn("{}", parameter_trouble_text(figures_.troubles));
  figures_.version = version;
  figures_.changes = loaded.changes.count(simulation.world());
}

/// Precondition: the lock is held.
void StatusSnapshot::record_reach(const LoadedScene& loaded) {
  const bool is_new = loaded.is_beyond_reach && !figures_.is_beyond_reach;
  figures_.is_beyond_reach = loaded.is_beyond_reach;
  if (is_new) spdlog::warn("{}", kBeyondReach);
}

/// Precondition: the lock is held.
void StatusSnapshot::record_let_go(const Simulation& simulation, bool let_go) {
  if (!let_go) {
    figures_.let_go.clear();
  } else if (figures_.let_go.empty()) {
    figures_.let_go = let_go_text(simulation);
    spdlog::warn("{}", figures_.let_go);
  }
}

void StatusSnapshot::record_failure(std::string failure) {
  const std::lock_guard lock(mutex_);
  figures_.failure = std::move(failure);
}

void StatusSnapshot::change_scene(const scene::Scene& scene, std::uint64_t version) {
  const std::lock_guard lock(mutex_);
  liaisons_ = ChangeCounter(scene.network.state_machines).names();
  liaisons_version_ = version;
}

void StatusSnapshot::change_shadow(std::shared_ptr<ShadowWorld> shadow, bool watches_energy) {
  const std::lock_guard lock(shadow_mutex_);
  shadow_ = std::move(shadow);
  watches_energy_ = watches_energy;
}

void StatusSnapshot::watch() {
  if (clock_ != config::Clock::kRealtime) return;
  {
    const std::lock_guard lock(shadow_mutex_);
    if (!watches_energy_) return;
  }
  read_shadow();
}

/// Real time: the status thread finds energy and state hash, of a copy of the world.
void StatusSnapshot::read_shadow() {
  std::shared_ptr<ShadowWorld> shadow;
  {
    const std::lock_guard lock(shadow_mutex_);
    shadow = shadow_;
  }
  const std::optional<WorldFigures> figures = shadow->read(kCopyPatience);
  if (figures && figures->signs.makes_energy) makes_energy_ = shadow->id();
  if (figures && figures->signs.is_beyond_reach) is_beyond_reach_ = shadow->id();
  if (figures && !figures->signs.has_energy) has_no_energy_ = shadow->id();
  const std::lock_guard lock(mutex_);
  if (figures && figures_.is_looping) figures_.of_world = *figures;
}

void StatusSnapshot::fill(msg::NodeStatus& status, const std::string& refusal,
                          const std::string& loops) {
  status.phase(phase_.load());
  status.target_rate_hz(target_rate_hz_.load());
  status.ticks(ticks_.load());
  late_ticks_.fill(status);
  status.dropped(dropped_.load());
  status.passivity_ticks(passivity_ticks_.load());
  report_passivity(status.passivity_ticks());

  if (clock_ == config::Clock::kRealtime) read_shadow();
  const std::lock_guard lock(mutex_);
  status.text(!figures_.failure.empty()    ? figures_.failure
              : !figures_.let_go.empty()   ? figures_.let_go
              : !refusal.empty()           ? refusal
              : !figures_.crowding.empty() ? figures_.crowding
              : figures_.is_beyond_reach   ? kBeyondReach
                                           : loops);
  fill_figures(status);
  if (figures_.failure.empty()) report_integration_error(figures_.of_world.energy);
}

/// Precondition: the lock is held.
void StatusSnapshot::fill_figures(msg::NodeStatus& status) const {
  const engine::Energy& energy = figures_.of_world.energy;
  status.energy_j(energy.total());
  status.energy_drift(energy.drift());
  status.integration_error_j(energy.integration_error());
  status.overflowed_steps(figures_.troubles.overflowed_steps);
  status.forgotten_pairs(figures_.troubles.forgotten_pairs);
  status.refused_inputs(figures_.troubles.refused_inputs);
  status.switching_energy_j(energy.switching);
  status.port_work_j(energy.port_work);
  status.dissipated_j(energy.dissipated);
  status.largest_stability_number(figures_.stability_number);
  status.largest_partners(figures_.partners.largest);
  status.certified_partners(figures_.partners.certified);
  status.step(figures_.of_world.step);
  status.state_hash(figures_.of_world.state_hash);
  status.changes().clear();
  if (figures_.version != liaisons_version_) return;  // the scene was changed this very moment
  for (std::size_t i = 0; i < liaisons_.size(); ++i) {
    status.changes().emplace_back();
    status.changes().back().liaison(liaisons_[i]);
    status.changes().back().changes(figures_.changes[i]);
  }
}

/// Warns once when the force of a hand in role liaison had to be damped.
void StatusSnapshot::report_passivity(std::uint64_t ticks) {
  if (ticks == 0 || std::exchange(passivity_reported_, true)) return;
  spdlog::warn(
      "the forces of a hand in role liaison bring in more energy than it gives, for it is too "
      "stiff for the viscosity of its port or its samples are late: the port is damped");
}

/// Warns when the steps have made or taken more than a hundredth of the largest energy.
void StatusSnapshot::report_integration_error(const engine::Energy& energy) {
  const std::int64_t now = node::monotonic_nsec();
  integration_errors_.report(now);
  const bool passed = is_error_large(energy);
  const bool was_passed = std::exchange(error_is_passed_, passed);
  if (!passed || was_passed || !integration_errors_.record(now)) return;
  spdlog::warn("{}", integration_error_text(energy));
}

}  // namespace cordis::sim
