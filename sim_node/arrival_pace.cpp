// sim_node/arrival_pace.cpp
#include "sim_node/arrival_pace.h"

#include <algorithm>
#include <utility>

#include "node/processor_time.h"
#include "node/stop.h"
#include "node/time.h"

namespace cordis::sim {
namespace {

constexpr std::uint32_t kMaxMessages = 64;  // in a period, each of which wakes the loop
constexpr double kPolls = 16.0;             // in a period, at what comes beyond them

}  // namespace

ArrivalPace::ArrivalPace(double rate_hz) : rule_(rate_hz, node::monotonic_nsec()) {
  sent_.reserve(ArrivalRule::kMaxDevices);
}

void ArrivalPace::restart(double rate_hz) noexcept {
  rule_.restart(rate_hz, node::monotonic_nsec());
  is_first_ = true;
  is_waiting_ = false;
}

std::optional<node::LateCause> ArrivalPace::wait(Simulation& simulation, DeviceLink& devices,
                                                 InputLog& inputs) {
  if (!std::exchange(is_waiting_, true)) {
    computed_nsec_ = is_first_ ? 0 : node::thread_processor_nsec() - begun_processor_nsec_;
    is_first_ = false;
    waited_from_ = devices.arrival().count();
    rule_.begin_wait(sent(simulation));
  }
  if (!wait_for_samples(simulation, devices, inputs)) return std::nullopt;
  is_waiting_ = false;
  const std::uint64_t skipped = rule_.begin_tick(sent(simulation), node::monotonic_nsec());
  begun_processor_nsec_ = node::thread_processor_nsec();
  if (skipped == 0) return node::LateCause::kNone;
  return static_cast<double>(computed_nsec_) * rate_hz() < 1e9 ? node::LateCause::kMachine
                                                               : node::LateCause::kWork;
}

/// @return false when the tick is not due yet
bool ArrivalPace::wait_for_samples(Simulation& simulation, DeviceLink& devices, InputLog& inputs) {
  dds::Arrival& arrival = devices.arrival();
  const std::int64_t patience_end = node::monotonic_nsec() + kLongestWait;
  const auto between_polls = static_cast<std::int64_t>(1e9 / rate_hz() / kPolls);
  while (!node::stop_requested()) {
    const std::uint32_t seen = arrival.count();
    devices.receive(simulation, inputs);
    const std::int64_t now = node::monotonic_nsec();
    if (rule_.is_due(sent(simulation), now)) return true;
    if (now >= patience_end) return false;
    const std::int64_t end = std::min(rule_.grid().end_nsec(), patience_end);
    if (seen - waited_from_ < kMaxMessages) {
      arrival.wait_until(seen, end);
    } else {
      node::sleep_until(std::min(now + between_polls, end));
    }
  }
  return true;
}

std::span<const ArrivalRule::Device> ArrivalPace::sent(Simulation& simulation) {
  sent_.clear();
  for (const DeviceExchange& device : simulation.devices()) {
    sent_.push_back({.id = device.device_id(),
                     .sent = device.new_count() + device.lost_sample_count(),
                     .plays = device.has_received() && !device.is_silent()});
  }
  return sent_;
}

}  // namespace cordis::sim
