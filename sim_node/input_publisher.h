// sim_node/input_publisher.h -- publishes what the steps consume, so that they can be repeated.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

#include "idl/inputs.h"
#include "node/config/launch.h"
#include "node/dds/participant.h"
#include "node/dds/writer.h"
#include "sim_node/run/input_log.h"
#include "sim_node/run/request_source.h"

namespace cordis::sim {

/// Empties an input log into scene/inputs. It has no thread of its own: one thread calls publish().
class InputPublisher {
 public:
  /// @param keeps_devices  no bound lets go of the devices
  /// @param start          the scene that the session begins with
  /// @param log            must outlive this
  InputPublisher(dds::Participant& participant, std::uint64_t epoch, config::Clock clock,
                 bool keeps_devices, SceneSource start, InputLog& log);
  /// Waits a short while until who records has everything.
  ~InputPublisher();
  InputPublisher(const InputPublisher&) = delete;
  InputPublisher& operator=(const InputPublisher&) = delete;

  /// Publishes what has come: at once when it is much, else every 30 ms at most. The destructor
  /// publishes the rest.
  /// @return false when DDS did not take it
  [[nodiscard]] bool publish();

 private:
  void add(InputRecord& record);
  void add_sample(const InputRecord& record);
  void add_event(const InputRecord& record, msg::InputKind kind);
  bool collect();
  [[nodiscard]] bool write();

  InputLog& log_;
  dds::Writer<msg::SceneInputs> writer_;
  msg::SceneInputs batch_;
  std::size_t count_ = 0;            // inputs in it
  std::uint64_t written_turns_ = 0;  // of the last batch
  std::chrono::steady_clock::time_point written_at_;
};

}  // namespace cordis::sim
