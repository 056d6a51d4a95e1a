// device_node/device.cpp
#include "device_node/device.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <thread>
#include <utility>

#include <spdlog/spdlog.h>

#include "device_node/dds_channel.h"
#include "device_node/drivers/guardian.h"
#include "node/paced_loop.h"
#include "node/stop.h"
#include "node/tick_cost.h"
#include "node/time.h"
#include "node/time_scale.h"

namespace cordis::device {
namespace {

using std::chrono::milliseconds;

constexpr auto kScenePollPeriod = milliseconds(100);   // for a scene, while there is none
constexpr double kGuardianChecksPerSecond = 50.0;      // after the guardian
constexpr auto kRepeatAfter = milliseconds(100);       // of silence in lockstep
constexpr auto kLockstepPatience = milliseconds(500);  // of silence before the scene counts as lost
constexpr std::int64_t kSampleAgain = 5'000'000;       // after the pace, in slow motion [ns]
constexpr double kLongestPoll = 300e-6;                // for an answer, in a period [s]
constexpr auto kLongSilence = std::chrono::seconds(2);  // after which its cause is looked for

/// CLOCK_BOOTTIME [ns]: CLOCK_MONOTONIC stops while the machine sleeps.
std::int64_t since_boot_nsec() noexcept {
  timespec now{};
  clock_gettime(CLOCK_BOOTTIME, &now);
  return static_cast<std::int64_t>(now.tv_sec) * 1'000'000'000 + now.tv_nsec;
}

/// "kfb1 at 192.168.0.7:5005"; of a simulated device "mock".
std::string name_of_driver(const DeviceConfig& config, const Driver& driver) {
  const std::string address = driver.address();
  return config.driver + (address.empty() ? "" : " at " + address);
}

void watch_guardian() noexcept {
  Guardian* const guardian = Guardian::of_process();
  if (guardian != nullptr) guardian->watch();
}

}  // namespace

Device::Device(LoadedDevice device, dds::Participant& participant, dds::Participant& for_loop,
               config::Clock clock, const Exchange::Series& series)
    : config_(std::move(device.config)),
      driver_(traced(std::move(device.driver), config_.trace, config_.layout)),
      for_loop_(for_loop),
      clock_(clock),
      description_(participant, dds::Topic::kDevice),
      roster_(participant),
      series_(series),
      phases_(config_.name, name_of_driver(config_, *driver_),
              clock == config::Clock::kLockstep
                  ? std::chrono::duration<double>(kLockstepPatience).count()
                  : config_.force_guard.watchdog_s),
      scenes_(participant, config_, *driver_),
      status_(
          participant, msg::KIND_DEVICE_NODE, series.epoch,
          [this](msg::NodeStatus& status) {
            meter_.fill(status);
            if (meter_.phase() == Phase::kNeverConnected || meter_.phase() == Phase::kReplaced)
              status.text("driver " + name_of_driver(config_, *driver_) + ": " + status.text());
            const std::string refusal = scenes_.refusal();
            if (!refusal.empty()) status.text("refused " + refusal);
            if (status.text().empty() && status.phase() != msg::PHASE_STOPPED)
              status.text(what_it_is(config_));
            // in lockstep the scene's answers set the pace
            status.target_rate_hz(
                clock_ == config::Clock::kLockstep ? 0.0 : config_.layout.rate_hz * time_scale());
          },
          nullptr, &for_loop) {
  if (PointerPort* const port = driver_->pointer_port())
    pointer_.emplace(participant, config_, *port, series.epoch);
}

void Device::run() {
  spdlog::info("{}, waiting for a scene that plays '{}'", what_it_is(config_), config_.name);
  describe();
  while (!node::stop_requested()) {
    part_ = scenes_.part();
    if (part_.wanted) {
      play(part_.role);
    } else {
      record_unused();
      scenes_.wait_for_another(part_, kScenePollPeriod);
      watch_guardian();
      phases_.report(node::monotonic_nsec());
    }
  }
  meter_.publish_latency();
  meter_.set_phase(meter_.last_phase());
}

/// Publishes what the device is and what it supports.
void Device::describe() {
  msg::DeviceDescription description = description_of(config_);
  description.epoch(series_.epoch);
  description.plays_mass(driver_->can_play(Role::kMass));
  description.plays_liaison(driver_->can_play(Role::kLiaison));
  if (!description_.write(description))
    spdlog::error("DDS did not take the description of '{}'", config_.name);
}

/// Reports once that the scene, if there is one, does not play the device.
void Device::record_unused() {
  if (!part_.is_present || meter_.phase() == Phase::kUnused) return;
  meter_.set_phase(Phase::kUnused);
  status_.publish_now();
}

/// Plays one role until it changes or a stop is requested.
void Device::play(Role role) {
  const bool lockstep = clock_ == config::Clock::kLockstep;
  const bool may_poll =
      !lockstep && driver_->changes_within_period() && std::thread::hardware_concurrency() > 1;
  if (!lockstep && driver_->changes_within_period() && std::thread::hardware_concurrency() < 2)
    spdlog::info("sleeps until its answers come: polling needs a second core");
  const double poll_s = std::min(kLongestPoll, Exchange::kAnswerShare / config_.layout.rate_hz);
  const auto channel = make_dds_channel(for_loop_, role, config_.device_id, config_.strength,
                                        may_poll ? std::llround(poll_s * 1e9) : 0);
  if (clock_ == config::Clock::kRealtime) ask_for_realtime();
  Exchange exchange({.config = config_,
                     .driver = *driver_,
                     .channel = *channel,
                     .meter = meter_,
                     .role = role,
                     .series = series_,
                     .lockstep = lockstep,
                     .clock = &node::monotonic_nsec,
                     .since_boot = &since_boot_nsec,
                     .repeat_nsec = for_loop_.config().standbys ? kSampleAgain : 0});
  phases_.start();
  const node::TickCost cost;
  const std::uint64_t ticks_before = meter_.ticks();
  if (lockstep) {
    play_in_lockstep(exchange);
  } else {
    play_paced(exchange);
  }
  leave(exchange);
  const std::string cost_text = cost.text(meter_.ticks() - ticks_before, channel->polled_s());
  if (!cost_text.empty()) spdlog::info("{}", cost_text);
  series_.last_sample = exchange.last_sample();
  meter_.set_phase(Phase::kWaiting);
}

void Device::ask_for_realtime() {
  if (std::exchange(realtime_asked_, true)) return;
  const node::RealtimeGrant grant = node::make_realtime(node::kLoopPriority);
  spdlog::info("loop thread: {}, memory {}",
               grant.fifo ? "realtime priority" : "no realtime priority (not permitted)",
               grant.memory_locked ? "locked" : "not locked");
}

/// Devices of this world play in real time whatever the scene says.
double Device::time_scale() const noexcept {
  return driver_->has_motors() ? node::kFullTimeScale : scenes_.time_scale();
}

void Device::play_paced(Exchange& exchange) {
  double scale = time_scale();
  exchange.set_time_scale(scale);
  node::PacedLoop pace(config_.layout.rate_hz * scale);
  while (has_part() && !node::stop_requested()) {
    if (const double wanted = time_scale(); wanted != scale) {
      scale = wanted;
      exchange.set_time_scale(scale);
      pace = node::PacedLoop(config_.layout.rate_hz * scale);
    }
    if (scale < node::kFullTimeScale && pace.next_nsec() > node::monotonic_nsec() + kSampleAgain) {
      node::sleep_until(node::monotonic_nsec() + kSampleAgain);
      exchange.hold_port();
      continue;
    }
    pace.wait();
    meter_.late_ticks().count(pace.late_cause());
    exchange.play_period();
    if (exchange.misses_the_scene()) meter_.late_ticks().count_silent();
    record_phase(exchange);
    keep_guardian();
    exchange.use_late_answer(pace.next_nsec());
  }
}

/// Motors of this world have its pace: their guard counts in periods. A slower scene makes them slower.
void Device::play_in_lockstep(Exchange& exchange) {
  node::PacedLoop pace(config_.layout.rate_hz);
  while (has_part() && !node::stop_requested()) {
    if (exchange.has_motors()) pace.wait();
    exchange.send_sample();
    if (!await_answer(exchange)) return;
    exchange.step();
    record_phase(exchange);
    keep_guardian();
  }
}

/// Sends the last sample again and again until it is answered, while forces on motors fade; false when
/// the part is over first.
bool Device::await_answer(Exchange& exchange) {
  const bool has_motors = exchange.has_motors();
  const std::chrono::nanoseconds period(std::llround(1e9 / config_.layout.rate_hz));
  std::chrono::nanoseconds silent{0};
  std::chrono::nanoseconds asked{0};
  while (!exchange.await_answer(has_motors ? period : kRepeatAfter)) {
    if (node::stop_requested() || !has_part()) return false;
    silent += has_motors ? period : kRepeatAfter;
    if (has_motors) {
      exchange.age_answer();
      record_phase(exchange);
      keep_guardian();
    }
    if (silent - asked < kRepeatAfter) continue;
    asked = silent;
    ask_again(exchange, silent);
  }
  return true;
}

/// Sends the last sample again, and reports a silence that is long.
void Device::ask_again(Exchange& exchange, std::chrono::nanoseconds silent) {
  roster_.update();
  if (silent >= kLockstepPatience && meter_.phase() == Phase::kRunning) {
    meter_.set_phase(Phase::kLost);
    record_phase(exchange);
  }
  const bool never_answered = meter_.phase() == Phase::kWaiting;
  if (silent >= kLongSilence && never_answered && !std::exchange(silence_reported_, true)) {
    const std::string alive = roster_.name_of(msg::KIND_SIM_NODE);
    spdlog::warn("no answer to the first sample for {} s: {}", kLongSilence.count(),
                 alive.empty() ? "no sim_node of the session is alive"
                               : "sim_node " + alive + " is alive, and does not answer");
  }
  exchange.repeat_sample();
}

/// Lets the forces fade. A simulated device in lockstep stays as it is: time stops.
void Device::leave(Exchange& exchange) {
  if (clock_ == config::Clock::kLockstep && !exchange.has_motors()) return;
  node::PacedLoop pace(config_.layout.rate_hz);
  exchange.leave();
  while (!exchange.has_left()) {
    pace.wait();
    exchange.play_period();
  }
}

/// Looks after the guardian now and then, for it costs a system call.
void Device::keep_guardian() const noexcept {
  const auto ticks_per_check =
      static_cast<std::uint64_t>(std::max(1.0, config_.layout.rate_hz / kGuardianChecksPerSecond));
  if (meter_.ticks() % ticks_per_check == 0) watch_guardian();
}

/// Reports a change of phase.
void Device::record_phase(const Exchange& exchange) {
  const std::int64_t now = node::monotonic_nsec();
  if (phases_.note(meter_.phase(), exchange.has_device(), now, exchange.is_taken()))
    status_.publish_now();
  phases_.report(now);
}

}  // namespace cordis::device
