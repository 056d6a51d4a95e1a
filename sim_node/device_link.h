// sim_node/device_link.h -- the force loop of a sim_node over DDS, and the devices that join it.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <map>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "idl/gesture.h"
#include "node/config/launch.h"
#include "node/dds/arrival.h"
#include "node/dds/participant.h"
#include "node/dds/reader.h"
#include "node/dds/writer.h"
#include "sim_node/devices/answer_delay.h"
#include "sim_node/devices/device_reach.h"
#include "sim_node/devices/real_devices.h"
#include "sim_node/devices/refused_devices.h"
#include "sim_node/devices/undescribed_devices.h"
#include "sim_node/run/input_log.h"
#include "sim_node/run/simulation.h"

namespace cordis::sim {

/// Takes the samples of devices for the exchanges of a simulation, and sends the answers back.
/// A thread of its own receives the descriptions of devices that join the session.
class DeviceLink {
 public:
  /// @param participant       for descriptions
  /// @param loop_participant  for samples and answers, which wait for no other thread
  /// @param epoch             of this sim_node
  /// @param delay_quantile    real time: share of the answers within the delay that counts
  DeviceLink(dds::Participant& participant, dds::Participant& loop_participant, std::uint64_t epoch,
             config::Clock clock, double delay_quantile);
  ~DeviceLink();
  DeviceLink(const DeviceLink&) = delete;
  DeviceLink& operator=(const DeviceLink&) = delete;

  /// Begins to receive descriptions.
  void start();
  /// True if a node reads all topics on which the devices of a scene are answered.
  bool has_reader_of(const std::string& node, const scene::Scene& scene) const;

  /// The scene that devices must support from now on; any thread.
  void play(const scene::Scene& scene);
  /// Why devices that have a force now would lose it in this scene; empty when none would. Any thread.
  std::string objection_to(const scene::Scene& scene) const;
  /// Why devices are refused, or which are answered late; empty when none is. Any thread.
  std::string refusal() const;
  /// How late the devices of the scene are answered, and what they support; empty until that is
  /// measured. Any thread.
  std::string loops() const { return refused_.loops_text(); }
  /// The devices of the scene that are not simulated; any thread.
  const RealDevices& real_devices() const noexcept { return real_; }
  /// Loop: from now on simulated time passes so many times as fast as real time. Below 1 the answers
  /// are not measured: no hand feels how late they are.
  void set_time_scale(double scale) noexcept { measures_ = scale == 1.0; }

  /// Loop: takes what the devices have sent. A device that repeats an answered sample gets its
  /// last answer again, in real time once in a tick. What is taken goes into the log.
  void receive(Simulation& simulation, InputLog& inputs);
  /// Loop, in lockstep: true while a sample of the device waits for the description of its device.
  bool holds_sample_of(const DeviceExchange& device) const;
  /// Loop: waits for what arrives after receive() has begun, at most so long.
  void wait(std::chrono::nanoseconds at_most);
  /// Loop: counts the samples of all devices, and what else arrives on their topics.
  dds::Arrival& arrival() noexcept { return arrival_; }
  /// Loop: answers every device that has been received; otherwise every device of the scene.
  void answer_received(Simulation& simulation);
  void answer_all(Simulation& simulation);
  /// Loop: answers that DDS did not take.
  std::uint64_t unwritten() const noexcept { return unwritten_; }

 private:
  /// A sample of a device that has not described itself yet.
  template <class Sample>
  struct HeldSample {
    Sample sample;
    std::int64_t waited_nsec = 0;  // while this process ran
    std::int64_t checked_nsec = 0;
  };
  template <class Reader, class Sample>
  void take_all(Reader& reader, Sample& sample, std::vector<HeldSample<Sample>>& held,
                Simulation& simulation, InputLog& inputs);
  template <class Sample>
  bool holds(const Sample& sample, std::vector<HeldSample<Sample>>& held);
  template <class Sample>
  void take(const Sample& sample, DeviceExchange& device, Simulation& simulation, InputLog& inputs);
  template <class Sample>
  void record_delay(const Sample& sample, const DeviceExchange& device) noexcept;
  void answer(DeviceExchange& device, const Simulation& simulation);
  bool may_repeat(const DeviceExchange& device) noexcept;
  void listen();
  void keep_described();
  void update_real_devices();

  /// A process, and a device that it has described.
  using Described = std::pair<dds::ParticipantPrefix, std::uint32_t>;
  struct Description {
    std::uint64_t epoch = 0;
    std::string device;
    std::string driver;
  };

  std::uint64_t epoch_;
  config::Clock clock_;
  dds::Arrival arrival_;
  std::uint32_t seen_ = 0;  // messages when receive() began
  dds::Reader<msg::GesturePositions> position_reader_;
  dds::Reader<msg::GestureForces> force_reader_;
  dds::Writer<msg::GesturePositions> position_writer_;
  dds::Writer<msg::GestureForces> force_writer_;
  msg::GesturePositions position_sample_;
  msg::GestureForces force_sample_;
  std::uint64_t unwritten_ = 0;
  std::vector<std::uint32_t> repeated_;  // real time: devices that got an answer again in this tick
  std::atomic<bool> measures_{true};     // the delays of answers
  AnswerDelays delays_;
  RefusedDevices refused_;
  RealDevices real_;
  ReachTable reaches_;
  UndescribedDevices undescribed_{reaches_};
  std::vector<HeldSample<msg::GesturePositions>> held_positions_;  // in lockstep
  std::vector<HeldSample<msg::GestureForces>> held_forces_;
  dds::Participant& participant_;
  dds::Reader<msg::DeviceDescription> device_reader_;
  std::map<Described, Description> described_;  // of the listener
  std::atomic<bool> ending_{false};
  std::thread listener_;  // uses what stands above but the samples
};

}  // namespace cordis::sim
