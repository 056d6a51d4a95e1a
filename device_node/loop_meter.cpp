// device_node/loop_meter.cpp
#include "device_node/loop_meter.h"

namespace cordis::device {
namespace {

constexpr std::uint64_t kTicksPerPublication = 256;

struct PhaseWords {
  msg::NodePhase phase;
  const char* text;
};

PhaseWords words_of(Phase phase) noexcept {
  switch (phase) {
    case Phase::kWaiting:
      return {msg::PHASE_WAITING, "waits for a scene that plays this device; motors off"};
    case Phase::kUnused:
      return {msg::PHASE_UNUSED, "the scene does not play this device; motors off"};
    case Phase::kRunning:
      return {msg::PHASE_RUNNING, ""};
    case Phase::kStandby:
      return {msg::PHASE_STANDBY,
              "the scene answers another process that plays this device; ready to take over"};
    case Phase::kLost:
      return {msg::PHASE_LOST, "no answer from the scene in time, or no device; motors at zero"};
    case Phase::kDisconnected:
      return {msg::PHASE_DISCONNECTED,
              "the board has let go of its motors; forces return by the ramp"};
    case Phase::kStopped:
      return {msg::PHASE_STOPPED, ""};
    case Phase::kNeverConnected:
      return {msg::PHASE_FAILED, "the device was never connected"};
    case Phase::kReplaced:
      return {msg::PHASE_STOPPED, "the device was never connected; another node played it"};
    case Phase::kTaken:
      return {msg::PHASE_FAILED, "another process drove the device"};
  }
  return {msg::PHASE_FAILED, "unknown phase"};
}

}  // namespace

void LoopMeter::record_device(bool has_device, bool other_plays, bool is_taken) noexcept {
  is_sought_.store(true, std::memory_order_relaxed);
  if (has_device) was_connected_.store(true, std::memory_order_relaxed);
  is_taken_.store(is_taken, std::memory_order_relaxed);
  if (other_plays) was_replaced_.store(true, std::memory_order_relaxed);
}

Phase LoopMeter::last_phase() const noexcept {
  const bool missed =
      is_sought_.load(std::memory_order_relaxed) && !was_connected_.load(std::memory_order_relaxed);
  if (!missed) return Phase::kStopped;
  if (was_replaced_.load(std::memory_order_relaxed)) return Phase::kReplaced;
  return is_taken_.load(std::memory_order_relaxed) ? Phase::kTaken : Phase::kNeverConnected;
}

void LoopMeter::count_tick() noexcept {
  const std::uint64_t ticks = ticks_.fetch_add(1, std::memory_order_relaxed) + 1;
  if (ticks % kTicksPerPublication == 0) publish_latency();
}

void LoopMeter::record_energy(double given_j, bool damping) noexcept {
  given_j_.store(given_j, std::memory_order_relaxed);
  if (damping) passivity_ticks_.fetch_add(1, std::memory_order_relaxed);
}

void LoopMeter::record_answer(std::uint64_t step) noexcept {
  link_samples_.fetch_add(step, std::memory_order_relaxed);
  link_unanswered_.fetch_add(step - 1, std::memory_order_relaxed);
}

void LoopMeter::publish_latency() noexcept {
  latency_count_.store(latency_.count(), std::memory_order_relaxed);
  latency_p50_s_.store(latency_.quantile_nsec(0.5) * 1e-9, std::memory_order_relaxed);
  latency_p99_s_.store(latency_.quantile_nsec(0.99) * 1e-9, std::memory_order_relaxed);
  latency_max_s_.store(static_cast<double>(latency_.largest_nsec()) * 1e-9,
                       std::memory_order_relaxed);
}

void LoopMeter::fill(msg::NodeStatus& status) const {
  const PhaseWords words = words_of(phase());
  status.phase(words.phase);
  const bool waits = phase() == Phase::kLost && is_taken_.load(std::memory_order_relaxed);
  status.text(waits ? "another process drives this device; waits until it is free" : words.text);
  status.ticks(ticks());
  late_ticks_.fill(status);
  status.dropped(dropped());
  status.port_energy_j(given_j_.load(std::memory_order_relaxed));
  status.passivity_ticks(passivity_ticks_.load(std::memory_order_relaxed));
  status.link_samples(link_samples_.load(std::memory_order_relaxed));
  status.link_unanswered(link_unanswered_.load(std::memory_order_relaxed));
  status.latency_count(latency_count_.load(std::memory_order_relaxed));
  status.latency_p50_s(latency_p50_s_.load(std::memory_order_relaxed));
  status.latency_p99_s(latency_p99_s_.load(std::memory_order_relaxed));
  status.latency_max_s(latency_max_s_.load(std::memory_order_relaxed));
}

}  // namespace cordis::device
