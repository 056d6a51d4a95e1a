// tests/resim/take_recorder.h -- records what re-simulation needs of a session.
#pragma once

#include <atomic>
#include <filesystem>
#include <string>
#include <thread>

#include "idl/gesture.h"
#include "idl/inputs.h"
#include "idl/scene.h"
#include "node/dds/participant.h"
#include "node/dds/reader.h"
#include "record_node/mcap/writer.h"

namespace cordis::test {

/// Subscribes descriptions, frames and inputs, and writes them to a take until finish().
class TakeRecorder {
 public:
  TakeRecorder(dds::Participant& participant, const std::filesystem::path& path);
  ~TakeRecorder();
  TakeRecorder(const TakeRecorder&) = delete;
  TakeRecorder& operator=(const TakeRecorder&) = delete;

  /// Writes what has still come, and closes the take.
  void finish();

 private:
  template <class Message>
  struct Channel {
    dds::Reader<Message> reader;
    std::uint16_t id = 0;
    std::uint32_t sequence = 0;
    Message message{};
  };
  template <class Message>
  std::uint16_t add(const std::string& topic, const std::string& type);
  template <class Message>
  bool drain(Channel<Message>& channel);
  void record();

  mcap::Writer writer_;
  Channel<msg::SceneDescription> descriptions_;
  Channel<msg::DeviceDescription> devices_;
  Channel<msg::SceneFrame> frames_;
  Channel<msg::SceneInputs> inputs_;
  std::atomic<bool> ending_{false};
  std::thread thread_;
};

}  // namespace cordis::test
