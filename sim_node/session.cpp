// sim_node/session.cpp
#include "sim_node/session.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include <spdlog/spdlog.h>

#include "node/config/count_text.h"
#include "node/stop.h"
#include "node/time.h"
#include "sim_node/checks/device_check.h"
#include "sim_node/checks/stability_check.h"
#include "sim_node/run/describe.h"
#include "sim_node/scene/naming.h"

namespace cordis::sim {
namespace {

using namespace std::chrono_literals;

constexpr int kLoopPriority = 80;
// Devices of this host sample at the beginning of a period: in its middle their samples have
// arrived, and the answer has until the next beginning to travel. Without it the phases are left to
// chance, and the delay is up to two periods.
constexpr double kPhase = 0.5;
constexpr auto kLockstepPatience =
    50ms;                    // how long a wait for a sample may keep the loop from seeing a stop
constexpr auto kRest = 5ms;  // a turn of a loop without real time while the scene is paused
constexpr std::uint64_t kRestsPerFrame = 8;
constexpr auto kLookPatience = 10ms;               // of the status thread for a copy of the world
constexpr auto kLongestWait = 1s;                  // for a device that joins
constexpr std::int64_t kLongWait = 2'000'000'000;  // of a scene in lockstep for a sample [ns]
constexpr std::int64_t kWaitIsReported = std::numeric_limits<std::int64_t>::max();

}  // namespace

Session::Session(const node::NodeStart& start, SimConfig config)
    : start_(start),
      duration_s_(config.duration_s),
      participant_(start.config()),
      loop_participant_(start.join_for_force_loop()),
      runner_(std::make_unique<LoadedScene>(
                  std::make_shared<const scene::Scene>(std::move(config.scene)), start.epoch, 1),
              start.launch.clock == config::Clock::kLockstep),
      shadow_(runner_.stage().shadow),
      position_reader_(loop_participant_, dds::Topic::kPositions),
      force_reader_(loop_participant_, dds::Topic::kForces),
      position_writer_(loop_participant_, dds::Topic::kPositions),
      force_writer_(loop_participant_, dds::Topic::kForces),
      description_writer_(participant_, dds::Topic::kDescription),
      frames_(participant_, start.epoch),
      refused_(delay_periods_of(start.launch.clock)),
      device_reader_(participant_, dds::Topic::kDevice),
      roster_(participant_),
      status_(participant_, msg::KIND_SIM_NODE, start.epoch,
              [this](msg::NodeStatus& status) { fill(status); }),
      executor_(
          mailbox_, runner_.simulation().shared_scene(), start.epoch,
          [this, force = config.force](const std::string& path, config::Problems& problems) {
            return load_next_scene(start_.launch, path, force, problems);
          },
          [force = config.force](const scene::Scene& scene, config::Problems& problems) {
            check_stability(scene, force, problems);
          },
          [this](const scene::Scene& scene, std::uint64_t version) {
            publish_scene(scene, version);
          }),
      commands_(participant_, msg::KIND_SIM_NODE, [this](const msg::ControlCommand& command) {
        const auto before = executor_.scene();
        node::Answer answer = executor_.execute(command);
        if (executor_.scene() != before) refused_.play(*executor_.scene());
        change_shadow();
        return answer;
      }) {}

Session::~Session() {
  ending_ = true;
  device_reader_.interrupt();
  if (device_listener_.joinable()) device_listener_.join();
}

/// The thread in which devices are received that join the session, whenever they do.
void Session::listen_to_devices() {
  msg::DeviceDescription description;
  while (!ending_) {
    while (device_reader_.take(description)) {
      if (refused_.receive(description))
        reaches_.put(description.device_id(), description.epoch(), reach_of(description));
    }
    refused_.report_repeats();
    if (!ending_) device_reader_.wait(kLongestWait);
  }
}

int Session::run() {
  publish_scene(runner_.simulation().scene(), 1);
  record_state();
  refused_.play(runner_.simulation().scene());
  device_listener_ = std::thread([this] { listen_to_devices(); });
  commands_.start();

  loops_ = true;
  switch (start_.launch.clock) {
    case config::Clock::kRealtime:
      run_realtime();
      break;
    case config::Clock::kLockstep:
      run_lockstep();
      break;
    case config::Clock::kAsap:
      run_asap();
      break;
  }
  mailbox_.close();
  loops_ = false;
  record_state();
  const Simulation& simulation = runner_.simulation();
  if (simulation.failed()) {
    for (DeviceExchange& device : runner_.simulation().devices()) answer(device);  // no force
    const std::string failure = simulation.failure();
    {
      const std::lock_guard lock(shown_mutex_);
      shown_.failure = failure;
    }
    set_phase(msg::PHASE_FAILED);
    spdlog::error("{}", failure);
    return 1;
  }
  set_phase(msg::PHASE_STOPPED);
  spdlog::info("state hash {:016x} after {}", simulation.world().state_hash(),
               config::count_text(simulation.world().step_count(), "step"));
  return 0;
}

void Session::run_realtime() {
  const node::RealtimeGrant grant = node::make_realtime(kLoopPriority);
  spdlog::info("real-time priority {}, memory {}",
               grant.fifo ? "granted" : "not permitted, going on without",
               grant.memory_locked ? "locked" : "not locked");
  node::PacedLoop loop(runner_.simulation().scene().gesture_rate_hz, kPhase);
  while (!finished()) {
    loop.wait();
    late_ticks_.count(loop.late_cause());
    const bool plays = execute();
    if (loop.rate_hz() != runner_.simulation().scene().gesture_rate_hz)
      loop = node::PacedLoop(runner_.simulation().scene().gesture_rate_hz, kPhase);
    receive();
    const bool complete = plays && play();
    if (runner_.simulation().misses_a_device()) late_ticks_.count_silent();
    answer_all();  // first: the hand waits for it, and the display does not
    if (plays) show(complete);
    runner_.stage().shadow->hand_over(runner_.simulation().world());
  }
}

void Session::run_lockstep() {
  while (!finished()) {
    if (!execute_or_wait()) {
      waits_since_nsec_ = 0;
      continue;
    }
    if (runner_.simulation().is_between_ticks() && !receive_lockstep()) continue;
    if (!advance()) continue;
    for (DeviceExchange& device : runner_.simulation().devices()) answer(device);
  }
}

/// Runs without devices: a scene whose time is not that of a hand has no force for it.
void Session::run_asap() {
  while (!finished()) {
    if (execute_or_wait()) advance();
  }
}

bool Session::execute() {
  Request* request = mailbox_.waiting();
  if (request == nullptr) return true;
  const bool new_stage = request->changes_stage();
  if (new_stage && frames_.is_busy()) return false;
  if (new_stage && runner_.stage().frames.has_news()) {
    offer_frame();
    return false;
  }
  runner_.execute(*request);
  mailbox_.report_steps_left(runner_.steps_left());
  mailbox_.executed();
  if (new_stage) offer_frame();
  record_state();
  return true;
}

bool Session::execute_or_wait() {
  if (!execute()) return false;
  if (runner_.moves()) return true;
  mailbox_.wait(kRest);
  if (++turns_ % kRestsPerFrame == 0) offer_frame();
  return false;
}

void Session::receive() {
  const auto take = [this](auto& reader, auto& sample, Role role) {
    while (reader.take(sample)) {
      DeviceExchange* device = runner_.simulation().find(sample.device_id());
      // The other direction of the same topic is our own, or that of a device the scene has no port
      // for.
      if (device == nullptr || device->role() != role || sample.epoch() == start_.epoch) continue;
      const bool is_supported = !refused_.refuses(sample.epoch());
      const DeviceReach reach = reaches_.find(sample.device_id(), sample.epoch());
      const bool repeated =
          device->receive(sample, is_supported, reach) == DeviceExchange::Reception::kRepeated;
      // What is still to be played has no answer yet.
      const bool played = !device->has_new_sample() && runner_.simulation().is_between_ticks();
      if (repeated && played) answer(*device);
    }
  };
  take(position_reader_, position_sample_, Role::kMass);
  take(force_reader_, force_sample_, Role::kLiaison);
}

bool Session::receive_lockstep() {
  receive();
  for (const DeviceExchange& device : runner_.simulation().devices()) {
    if (device.has_new_sample()) continue;
    report_wait(device);
    if (device.role() == Role::kMass) {
      position_reader_.wait(kLockstepPatience);
    } else {
      force_reader_.wait(kLockstepPatience);
    }
    return false;
  }
  waits_since_nsec_ = 0;
  return true;
}

/// Says for whom a scene in lockstep has long been waiting, and whether that node is alive. Every
/// wait is one event.
void Session::report_wait(const DeviceExchange& device) {
  const std::int64_t now = node::monotonic_nsec();
  roster_.look();
  if (waits_since_nsec_ == 0) waits_since_nsec_ = now;
  if (now - waits_since_nsec_ < kLongWait) return;
  waits_since_nsec_ = kWaitIsReported;
  const std::string alive = roster_.name_of(msg::KIND_DEVICE_NODE);
  if (!(alive.empty() ? absences_ : silences_).record(now)) return;
  const std::string who = alive.empty() ? "no device_node of the session is alive"
                                        : "device_node " + alive + " is alive, and sends no sample";
  spdlog::warn("has been waiting for the device '{}' for {} s: {}", device.device(),
               kLongWait / 1'000'000'000, who);
}

bool Session::advance() {
  const bool complete = play();
  show(complete);
  return complete;
}

bool Session::play() {
  const bool complete = runner_.advance();
  mailbox_.report_steps_left(runner_.steps_left());
  return complete;
}

void Session::show(bool complete) {
  const Simulation& simulation = runner_.simulation();
  LoadedScene& stage = runner_.stage();
  report_partners();
  if (complete) {
    simulation.read_signals(stage.frames.next_row(simulation.world().step_count()));
    ticks_.store(++tick_count_, std::memory_order_relaxed);
  }
  const std::uint64_t turns = complete ? simulation.tick_count() : ++turns_;
  const bool due = (complete || runner_.is_paused()) && turns % stage.ticks_per_frame == 0;
  const bool waits = start_.launch.clock != config::Clock::kRealtime;
  const bool many_events = stage.frames.events().is_half_full() && (waits || !frames_.is_busy());
  if (due || many_events) offer_frame();
}

/// Says at once that a mass touches more others than the step is certified for.
void Session::report_partners() {
  const std::optional<PartnersSeen> seen = runner_.simulation().partners().nearest();
  const std::int64_t now = node::monotonic_nsec();
  crowding_.report(now);
  const bool passed = seen && seen->is_passed();
  if (passed && seen->largest > partners_reported_ && crowding_.record(now)) {
    spdlog::warn("{}", crowding_text(runner_.simulation().scene(), *seen));
  }
  partners_reported_ = passed ? seen->largest : 0;
}

void Session::offer_frame() {
  if (start_.launch.clock != config::Clock::kRealtime) frames_.wait_until_free();
  const Simulation& simulation = runner_.simulation();
  const std::int64_t now = node::monotonic_nsec();
  const std::int64_t action = simulation.action_time_nsec();  // as a device wrote it
  frames_.offer(runner_.stage().frames, simulation.world(), simulation.simulated_s(), now,
                action <= now ? action : 0);
  record_state();
}

void Session::answer_all() {
  for (DeviceExchange& device : runner_.simulation().devices()) {
    if (device.has_received()) answer(device);
  }
}

void Session::answer(DeviceExchange& device) {
  const bool safe = !runner_.simulation().failed();
  const std::int64_t now = node::monotonic_nsec();
  const engine::World& world = runner_.simulation().world();
  const bool written = device.role() == Role::kMass
                           ? force_writer_.write(device.answer_forces(world, safe, now))
                           : position_writer_.write(device.answer_positions(world, safe, now));
  if (!written) ++unwritten_;
}

void Session::record_state() {
  const std::int64_t now = node::monotonic_nsec();
  absences_.report(now);
  silences_.report(now);
  std::uint64_t dropped = frames_.frames_left_out() + frames_.unwritten() + unwritten_;
  Simulation& simulation = runner_.simulation();
  std::uint64_t passivity_ticks = 0;
  const config::Clock clock = start_.launch.clock;
  bool has_sample = simulation.devices().empty() || clock == config::Clock::kAsap;
  for (const DeviceExchange& device : simulation.devices()) {
    dropped += device.refused_count() + device.missed_count();
    has_sample = has_sample || !device.is_lost();
    passivity_ticks += device.passivity_ticks();
  }
  dropped_.store(dropped, std::memory_order_relaxed);
  passivity_ticks_.store(passivity_ticks, std::memory_order_relaxed);
  set_phase(runner_.is_paused() ? msg::PHASE_PAUSED
            : has_sample        ? msg::PHASE_RUNNING
                                : msg::PHASE_WAITING);
  const bool realtime = clock == config::Clock::kRealtime;
  target_rate_hz_.store(realtime ? simulation.scene().gesture_rate_hz : 0.0,
                        std::memory_order_relaxed);

  // The status thread holds the lock for a copy at most; the loop never waits for it.
  const std::unique_lock lock(shown_mutex_, std::try_to_lock);
  if (!lock.owns_lock()) return;
  runner_.stage().limits.look(simulation.world());
  shown_.limit_number = runner_.stage().limits.largest();
  const PartnersSeen partners =
      simulation.partners().nearest().value_or(PartnersSeen{0, 0, msg::NO_INDEX});
  if (!partners.is_passed()) {
    shown_.crowding.clear();
  } else if (partners != shown_.partners ||
             shown_.version != runner_.stage().frames.shape().version) {
    shown_.crowding = crowding_text(simulation.scene(), partners);
  }
  shown_.partners = partners;
  if (clock != config::Clock::kRealtime || !loops_) shown_.of_world = look_at(simulation.world());
  shown_.loops = loops_;
  shown_.troubles = simulation.troubles();
  shown_.version = runner_.stage().frames.shape().version;
  shown_.changes = runner_.stage().changes.count(simulation.world());
}

/// After a command, in its thread: the status thread looks at the stage that is played now. The
/// loop changes stages only while a command waits for it.
void Session::change_shadow() {
  const std::lock_guard lock(shadow_mutex_);
  shadow_ = runner_.stage().shadow;
}

/// Real time: the status thread finds energy and state hash, of a copy of the world.
void Session::look_at_shadow() {
  std::shared_ptr<ShadowWorld> shadow;
  {
    const std::lock_guard lock(shadow_mutex_);
    shadow = shadow_;
  }
  const std::optional<WorldLook> look = shadow->look(kLookPatience);
  const std::lock_guard lock(shown_mutex_);
  if (look && shown_.loops) shown_.of_world = *look;
}

bool Session::finished() const noexcept {
  // Half a step of tolerance: the sum of steps is not exactly the duration.
  const Simulation& simulation = runner_.simulation();
  const double reached = runner_.played_s() + 0.5 * simulation.world().network().step();
  return node::stop_requested() || simulation.failed() ||
         (duration_s_ > 0.0 && reached >= duration_s_);
}

void Session::fill(msg::NodeStatus& status) {
  status.phase(phase_.load());
  status.text(refused_.text());
  status.target_rate_hz(target_rate_hz_.load());
  status.ticks(ticks_.load());
  late_ticks_.fill(status);
  status.dropped(dropped_.load());
  status.passivity_ticks(passivity_ticks_.load());
  if (status.passivity_ticks() > 0 && !std::exchange(passivity_reported_, true)) {
    spdlog::warn(
        "the forces of a hand in role liaison bring in more energy than it gives, for it is too "
        "stiff "
        "for the viscosity of its port or its samples are late: the port is damped");
  }

  if (start_.launch.clock == config::Clock::kRealtime) look_at_shadow();
  const std::lock_guard lock(shown_mutex_);
  const engine::Energy& energy = shown_.of_world.energy;
  if (status.text().empty()) status.text(shown_.crowding);
  if (!shown_.failure.empty()) status.text(shown_.failure);
  status.energy_j(energy.total());
  status.energy_drift(energy.largest > 0.0 ? energy.residual() / energy.largest : 0.0);
  status.integration_error_j(energy.integration_error());
  report_integration_error(energy);
  status.overflowed_steps(shown_.troubles.overflowed_steps);
  status.forgotten_pairs(shown_.troubles.forgotten_pairs);
  status.refused_inputs(shown_.troubles.refused_inputs);
  status.switching_energy_j(energy.switching);
  status.port_work_j(energy.port_work);
  status.dissipated_j(energy.dissipated);
  status.largest_limit_number(shown_.limit_number);
  status.largest_partners(shown_.partners.largest);
  status.certified_partners(shown_.partners.certified);
  status.step(shown_.of_world.step);
  status.state_hash(shown_.of_world.state_hash);
  status.lost_events(frames_.lost_events());
  status.changes().clear();
  if (shown_.version != liaisons_version_) return;  // the scene was changed this very moment
  for (std::size_t i = 0; i < liaisons_.size(); ++i) {
    status.changes().emplace_back();
    status.changes().back().liaison(liaisons_[i]);
    status.changes().back().changes(shown_.changes[i]);
  }
}

/// Warns when the steps have made or taken more than a hundredth of the largest energy.
void Session::report_integration_error(const engine::Energy& energy) {
  const std::int64_t now = node::monotonic_nsec();
  integration_errors_.report(now);
  const double error = energy.integration_error();
  const bool passed = is_error_large(energy);
  const bool was_passed = std::exchange(error_is_passed_, passed);
  if (!passed || was_passed || !integration_errors_.record(now)) return;
  spdlog::warn(
      "the steps have {} {:.3g} J that no account explains, above 1 % of the largest energy "
      "({:.3g} J): the step is too long for a liaison. A higher step rate helps",
      error > 0.0 ? "made" : "taken", std::abs(error), energy.largest);
}

void Session::publish_scene(const scene::Scene& scene, std::uint64_t version) {
  {
    const std::lock_guard lock(shown_mutex_);
    liaisons_ = ChangeCounter(scene.network.state_machines).names();
    liaisons_version_ = version;
  }
  msg::SceneDescription description = describe(scene, start_.epoch, version);
  if (!description_writer_.write(description))
    spdlog::error("DDS did not take the description of scene '{}'", scene.name);
  spdlog::info("scene '{}': {}, {} steps per second, {} per gesture", scene.name,
               scene::size_text(scene), scene.step_rate_hz,
               std::lround(scene.step_rate_hz / scene.gesture_rate_hz));
}

void Session::set_phase(msg::NodePhase phase) noexcept {
  phase_.store(phase);
}

}  // namespace cordis::sim
