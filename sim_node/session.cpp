// sim_node/session.cpp
#include "sim_node/session.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include <spdlog/spdlog.h>

#include "node/stop.h"
#include "node/time.h"
#include "sim_node/describe.h"

namespace cordis::sim {
namespace {

using namespace std::chrono_literals;

constexpr int kLoopPriority = 80;
// Devices of this host sample at the beginning of a period: in its middle their samples have
// arrived, and the answer has until the next beginning to travel. Without it the phases are left to
// chance, and the delay is up to two periods.
constexpr double kPhase = 0.5;
constexpr auto kLockstepPatience =
    50ms;  // how long a wait for a sample may keep the loop from seeing a stop

std::uint64_t ticks_per_frame(const scene::Scene& scene) {
  return static_cast<std::uint64_t>(
      std::max(1.0, std::round(scene.gesture_rate_hz / scene.frame_rate_hz)));
}

}  // namespace

Session::Session(const node::NodeStart& start, SimConfig config)
    : start_(start),
      duration_s_(config.duration_s),
      participant_(start.membership()),
      simulation_(std::move(config.scene), start.run),
      ticks_per_frame_(ticks_per_frame(simulation_.scene())),
      position_reader_(participant_, dds::Topic::kPositions),
      force_reader_(participant_, dds::Topic::kForces),
      position_writer_(participant_, dds::Topic::kPositions),
      force_writer_(participant_, dds::Topic::kForces),
      description_writer_(participant_, dds::Topic::kDescription),
      frames_(participant_, start.run, simulation_.world().network().mat_count(),
              simulation_.scene().signals.count(), static_cast<std::size_t>(ticks_per_frame_),
              static_cast<std::uint32_t>(simulation_.steps_per_tick()),
              layout_of(simulation_.scene())),
      status_(participant_, "sim_node", start.run,
              [this](msg::NodeStatus& status) { fill(status); }) {}

int Session::run() {
  msg::SceneDescription description = describe(simulation_.scene(), start_.run);
  description_writer_.write(description);
  spdlog::info("scene '{}': {} MATs, {} links, {} steps per second, {} per gesture",
               simulation_.scene().name, simulation_.world().network().mat_count(),
               simulation_.world().network().link_count(), simulation_.scene().step_rate_hz,
               simulation_.steps_per_tick());
  set_phase(simulation_.devices().empty() ? "running" : "waiting");
  note_state();

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
  note_state();
  if (simulation_.failed()) {
    set_phase("failed");
    spdlog::error("{}", simulation_.failure());
    return 1;
  }
  set_phase("stopped");
  spdlog::info("state hash {:016x} after {} steps", simulation_.world().state_hash(),
               simulation_.world().step_count());
  return 0;
}

void Session::run_realtime() {
  const node::RealtimeGrant grant = node::make_realtime(kLoopPriority);
  spdlog::info("real-time priority {}, memory {}",
               grant.fifo ? "granted" : "not permitted, going on without",
               grant.memory_locked ? "locked" : "not locked");
  node::PacedLoop loop(simulation_.scene().gesture_rate_hz, kPhase);
  while (!finished()) {
    loop.wait();
    overruns_.store(loop.overruns(), std::memory_order_relaxed);
    receive();
    tick();
    for (DeviceExchange& device : simulation_.devices()) {
      if (device.was_heard()) answer(device);
    }
  }
}

void Session::run_lockstep() {
  if (simulation_.devices().empty()) return run_asap();
  while (!finished()) {
    if (!receive_lockstep()) continue;
    tick();
    for (DeviceExchange& device : simulation_.devices()) answer(device);
  }
}

void Session::run_asap() {
  while (!finished()) {
    receive();
    std::array<bool, kMaxAxes>
        fresh{};  // whether a device waits for an answer; more devices than this are answered late
    std::size_t index = 0;
    for (const DeviceExchange& device : simulation_.devices()) {
      if (index < fresh.size()) fresh[index++] = device.has_new_sample();
    }
    tick();
    index = 0;
    for (DeviceExchange& device : simulation_.devices()) {
      if (index < fresh.size() && fresh[index++]) answer(device);
    }
  }
}

void Session::receive() {
  const auto take = [this](auto& reader, auto& sample, Role role) {
    while (reader.take(sample)) {
      DeviceExchange* device = simulation_.find(sample.device_id());
      // The other direction of the same topic is our own, or that of a device the scene has no port
      // for.
      if (device == nullptr || device->role() != role || sample.run() == start_.run) continue;
      if (device->receive(sample) == DeviceExchange::Reception::kRepeated) answer(*device);
    }
  };
  take(position_reader_, position_sample_, Role::kMass);
  take(force_reader_, force_sample_, Role::kLiaison);
}

bool Session::receive_lockstep() {
  receive();
  for (const DeviceExchange& device : simulation_.devices()) {
    if (device.has_new_sample()) continue;
    if (device.role() == Role::kMass) {
      position_reader_.wait(kLockstepPatience);
    } else {
      force_reader_.wait(kLockstepPatience);
    }
    return false;
  }
  return true;
}

void Session::tick() {
  const std::uint64_t step =
      simulation_.world().step_count() + static_cast<std::uint64_t>(simulation_.steps_per_tick());
  simulation_.tick(frames_.next_row(step));
  const std::uint64_t count = simulation_.tick_count();
  ticks_.store(count, std::memory_order_relaxed);
  if (count % ticks_per_frame_ == 0) {
    if (start_.launch.clock != config::Clock::kRealtime) frames_.wait_until_free();
    frames_.offer_frame(simulation_.world(), simulation_.simulated_s(), node::monotonic_nsec());
    note_state();
  }
}

void Session::answer(DeviceExchange& device) {
  const bool safe = !simulation_.failed();
  const std::int64_t now = node::monotonic_nsec();
  if (device.role() == Role::kMass) {
    force_writer_.write(device.answer_forces(simulation_.world(), safe, now));
  } else {
    position_writer_.write(device.answer_positions(simulation_.world(), safe, now));
  }
}

void Session::note_state() {
  std::uint64_t dropped = frames_.frames_left_out();
  bool heard = simulation_.devices().empty();
  for (const DeviceExchange& device : simulation_.devices()) {
    dropped += device.refused_count() + device.missed_count();
    heard = heard || !device.is_lost();
  }
  dropped_.store(dropped, std::memory_order_relaxed);
  phase_.store(heard ? "running" : "waiting", std::memory_order_relaxed);

  // The status thread holds the lock for a copy at most; the loop never waits for it.
  const std::unique_lock lock(shown_mutex_, std::try_to_lock);
  if (!lock.owns_lock()) return;
  shown_.energy = simulation_.world().energy();
  shown_.step = simulation_.world().step_count();
  shown_.state_hash = simulation_.world().state_hash();
}

bool Session::finished() const noexcept {
  // Half a step of tolerance: the sum of steps is not exactly the duration.
  const double reached = simulation_.simulated_s() + 0.5 * simulation_.world().network().step();
  return node::stop_requested() || simulation_.failed() ||
         (duration_s_ > 0.0 && reached >= duration_s_);
}

void Session::fill(msg::NodeStatus& status) {
  status.phase(phase_.load());
  const bool realtime = start_.launch.clock == config::Clock::kRealtime;
  status.target_rate_hz(realtime ? simulation_.scene().gesture_rate_hz : 0.0);
  status.ticks(ticks_.load());
  status.overruns(overruns_.load());
  status.dropped(dropped_.load());

  const std::lock_guard lock(shown_mutex_);
  status.energy_j(shown_.energy.total());
  status.energy_drift(shown_.energy.largest > 0.0 ? shown_.energy.residual() / shown_.energy.largest
                                                  : 0.0);
  status.step(shown_.step);
  status.state_hash(shown_.state_hash);
}

void Session::set_phase(const char* phase) noexcept {
  phase_.store(phase);
}

}  // namespace cordis::sim
