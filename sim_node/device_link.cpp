// sim_node/device_link.cpp
#include "sim_node/device_link.h"

#include <algorithm>
#include <type_traits>
#include <utility>

#include "node/time.h"
#include "sim_node/checks/device_check.h"

namespace cordis::sim {
namespace {

using namespace std::chrono_literals;

constexpr auto kLongestWait = 250ms;  // for a device that joins; then measured delays are looked at

// In lockstep a first sample waits so long for the description of its device. Every device of
// Cordis describes itself before it samples: only one that never does so waits to the end.
constexpr std::int64_t kLongestHold = 5'000'000'000;  // [ns]
// A process that was stopped has not waited.
constexpr std::int64_t kLongestTurn = 100'000'000;  // [ns]

}  // namespace

DeviceLink::DeviceLink(dds::Participant& participant, dds::Participant& loop_participant,
                       std::uint64_t epoch, config::Clock clock, double delay_quantile)
    : epoch_(epoch),
      clock_(clock),
      position_reader_(loop_participant, dds::Topic::kPositions, &arrival_),
      force_reader_(loop_participant, dds::Topic::kForces, &arrival_),
      position_writer_(loop_participant, dds::Topic::kPositions),
      force_writer_(loop_participant, dds::Topic::kForces),
      delays_(delay_quantile),
      refused_(delay_periods_of(clock), clock == config::Clock::kRealtime ? &delays_ : nullptr),
      participant_(participant),
      device_reader_(participant, dds::Topic::kDevice) {
  repeated_.reserve(64);  // as many devices as a scene has at most
}

DeviceLink::~DeviceLink() {
  ending_ = true;
  device_reader_.interrupt();
  if (listener_.joinable()) listener_.join();
}

void DeviceLink::start() {
  listener_ = std::thread([this] { listen(); });
}

bool DeviceLink::has_reader_of(const std::string& node, const scene::Scene& scene) const {
  return std::ranges::all_of(scene.ports, [&](const scene::Port& port) {
    return port.role == Role::kMass ? force_writer_.has_reader_of(node)
                                    : position_writer_.has_reader_of(node);
  });
}

void DeviceLink::listen() {
  msg::DeviceDescription description;
  while (!ending_) {
    while (device_reader_.take(description)) {
      const bool is_elsewhere = !device_reader_.is_of_this_host();
      const bool is_new = refused_.receive(description, node::monotonic_nsec(), is_elsewhere);
      // A process that has joined again is another peer: it is the same device, and stays known.
      if (!is_new && !reaches_.knows(description.device_id(), description.epoch())) continue;
      if (is_new) reaches_.put(description.device_id(), description.epoch(), reach_of(description));
      described_[{device_reader_.last_writer(), description.device_id()}] = {
          description.epoch(), description.device(), description.driver()};
      keep_described();
    }
    update_real_devices();
    refused_.measure(node::monotonic_nsec(), measures_);
    refused_.report_repeats();
    undescribed_.report();
    if (!ending_) device_reader_.wait(kLongestWait);
  }
}

/// Keeps the devices whose processes are there: one on standby sends nothing. Of each process the newest epoch counts.
void DeviceLink::keep_described() {
  const std::vector<dds::Peer> peers = participant_.peers();
  std::erase_if(described_, [&peers](const auto& entry) {
    return std::ranges::find(peers, entry.first.first, &dds::Peer::prefix) == peers.end();
  });
  for (const auto& [device, description] : described_) {
    refused_.keep(description.epoch);
    reaches_.keep(description.epoch);
  }
}

void DeviceLink::update_real_devices() {
  const std::vector<dds::Peer> peers = participant_.peers();
  std::vector<RealDevices::Device> devices;
  for (const auto& [who, description] : described_) {
    if (std::ranges::find(peers, who.first, &dds::Peer::prefix) == peers.end()) continue;
    devices.push_back({who.second, description.device, description.driver});
  }
  real_.update(std::move(devices));
}

void DeviceLink::play(const scene::Scene& scene) {
  refused_.play(scene);
  undescribed_.play(scene);
  real_.play(scene);
}

std::string DeviceLink::objection_to(const scene::Scene& scene) const {
  return refused_.objection_to(scene);
}

std::string DeviceLink::refusal() const {
  const std::string refused = refused_.text();
  const std::string undescribed = undescribed_.text();
  return refused + (refused.empty() || undescribed.empty() ? "" : "; ") + undescribed;
}

void DeviceLink::receive(Simulation& simulation, InputLog& inputs) {
  seen_ = arrival_.count();
  arrival_.update();
  take_all(position_reader_, position_sample_, held_positions_, simulation, inputs);
  take_all(force_reader_, force_sample_, held_forces_, simulation, inputs);
}

bool DeviceLink::holds_sample_of(const DeviceExchange& device) const {
  const auto is_of = [&device](const auto& held) {
    return held.sample.device_id() == device.device_id();
  };
  return std::ranges::any_of(held_positions_, is_of) || std::ranges::any_of(held_forces_, is_of);
}

template <class Reader, class Sample>
void DeviceLink::take_all(Reader& reader, Sample& sample, std::vector<HeldSample<Sample>>& held,
                          Simulation& simulation, InputLog& inputs) {
  constexpr Role kRole =
      std::is_same_v<Sample, msg::GesturePositions> ? Role::kMass : Role::kLiaison;
  const auto take_one = [&](const Sample& one) {
    DeviceExchange* device = simulation.find(one.device_id());
    // The other direction of the same topic is our own, or of a device without a port in the scene.
    if (device == nullptr || device->role() != kRole || one.epoch() == epoch_) return true;
    if (holds(one, held)) return false;
    take(one, *device, simulation, inputs);
    return true;
  };
  std::erase_if(held, [&](const HeldSample<Sample>& waiting) { return take_one(waiting.sample); });
  const auto is_newer = [&sample](const HeldSample<Sample>& waiting) {
    return waiting.sample.device_id() == sample.device_id();
  };
  while (reader.take(sample)) {
    if (take_one(sample)) std::erase_if(held, is_newer);
  }
}

/// In lockstep the result does not depend on when a device describes itself: its first sample waits
/// until it has, at most kLongestHold.
/// @return whether it waits; it is among those held then
template <class Sample>
bool DeviceLink::holds(const Sample& sample, std::vector<HeldSample<Sample>>& held) {
  const std::uint32_t device_id = sample.device_id();
  const std::uint64_t epoch = sample.epoch();
  if (clock_ != config::Clock::kLockstep || reaches_.knows(device_id, epoch) ||
      undescribed_.is_recorded_for_good(device_id, epoch)) {
    return false;
  }
  const std::int64_t now = node::monotonic_nsec();
  const auto known = std::ranges::find_if(held, [device_id](const HeldSample<Sample>& waiting) {
    return waiting.sample.device_id() == device_id;
  });
  if (known == held.end()) {
    held.push_back({sample, 0, now});
    return true;
  }
  if (known->sample.epoch() != epoch) {
    *known = {sample, 0, now};
    return true;
  }
  known->waited_nsec += std::min(now - std::exchange(known->checked_nsec, now), kLongestTurn);
  known->sample = sample;
  return known->waited_nsec < kLongestHold;
}

template <class Sample>
void DeviceLink::take(const Sample& sample, DeviceExchange& device, Simulation& simulation,
                      InputLog& inputs) {
  const bool is_for_good = undescribed_.is_recorded_for_good(sample.device_id(), sample.epoch());
  const bool is_described = !is_for_good && reaches_.knows(sample.device_id(), sample.epoch());
  // A described process plays it, or did a moment ago.
  if (!is_described && (device.is_described() || !device.is_disconnected())) return device.refuse();
  if (!is_described) {
    undescribed_.record(sample.device_id(), sample.epoch(), clock_ == config::Clock::kLockstep,
                        node::monotonic_nsec());
  }
  const bool is_supported = is_described && !refused_.refuses(sample.epoch());
  const DeviceReach reach =
      is_described ? reaches_.find(sample.device_id(), sample.epoch()) : DeviceReach();
  const DeviceExchange::Reception reception = device.receive(sample, is_supported, reach);
  const bool repeated = reception == DeviceExchange::Reception::kRepeated;
  if (!repeated) inputs.sample(sample, is_supported, reach);
  if (is_described && reception == DeviceExchange::Reception::kNew) device.record_described();
  if (reception == DeviceExchange::Reception::kNew) record_delay(sample, device);
  // A sample that has not been played yet has no answer.
  const bool played = !device.has_new_sample() && simulation.is_between_ticks();
  if (!repeated || !played || !may_repeat(device)) return;
  answer(device, simulation);
  inputs.repeat(sample.device_id());
}

/// In lockstep a device asks again for as long as it gets no answer. In real time who floods the
/// topic gets no more of them.
bool DeviceLink::may_repeat(const DeviceExchange& device) noexcept {
  if (clock_ == config::Clock::kLockstep) return true;
  if (repeated_.size() == repeated_.capacity() ||
      std::ranges::find(repeated_, device.device_id()) != repeated_.end()) {
    return false;
  }
  repeated_.push_back(device.device_id());
  return true;
}

/// What the sample reports of its answers, unless none was sent.
template <class Sample>
void DeviceLink::record_delay(const Sample& sample, const DeviceExchange& device) noexcept {
  const std::int64_t now = node::monotonic_nsec();
  if (!measures_ || sample.answered_epoch() != epoch_ || device.is_restarting()) {
    delays_.leave_out(sample.epoch(), now);
  } else {
    delays_.record(sample.epoch(),
                   {sample.sample(), sample.answered_sample(), sample.answer_delay_s()}, now);
  }
}

void DeviceLink::wait(std::chrono::nanoseconds at_most) {
  arrival_.wait_until(seen_, node::monotonic_nsec() + at_most.count());
}

void DeviceLink::answer_received(Simulation& simulation) {
  repeated_.clear();
  for (DeviceExchange& device : simulation.devices()) {
    if (device.has_received()) answer(device, simulation);
  }
}

void DeviceLink::answer_all(Simulation& simulation) {
  for (DeviceExchange& device : simulation.devices()) answer(device, simulation);
}

void DeviceLink::answer(DeviceExchange& device, const Simulation& simulation) {
  const bool safe = !simulation.failed() && simulation.passed_bound() == PassedBound::kNone;
  const std::int64_t now = node::monotonic_nsec();
  const engine::World& world = simulation.world();
  // An answer that is not sent counts as one: a session that is computed again has all of them.
  const bool is_withheld = clock_ == config::Clock::kRealtime && device.is_restarting();
  const auto send = [&](auto& writer, auto& answer) {
    if (is_withheld) return;
    delays_.answer(device.received_epoch(), device.received_sample(), answer.sample(), now);
    if (!writer.write(answer)) ++unwritten_;
  };
  if (device.role() == Role::kMass) {
    send(force_writer_, device.answer_forces(world, safe, now));
  } else {
    send(position_writer_, device.answer_positions(world, safe, now));
  }
}

}  // namespace cordis::sim
