// tests/resim/take_recorder.cpp
#include "tests/resim/take_recorder.h"

#include <chrono>

#include <gtest/gtest.h>

#include "idl/schema_text.h"
#include "idl/topics.h"
#include "node/dds/payload.h"

namespace cordis::test {
namespace {

std::uint64_t now_nsec() {
  return static_cast<std::uint64_t>(std::chrono::system_clock::now().time_since_epoch() /
                                    std::chrono::nanoseconds(1));
}

}  // namespace

TakeRecorder::TakeRecorder(dds::Participant& participant, const std::filesystem::path& path)
    : writer_(path),
      descriptions_{{participant, dds::Topic::kDescription}},
      devices_{{participant, dds::Topic::kDevice}},
      frames_{{participant, dds::Topic::kFrame}},
      inputs_{{participant, dds::Topic::kInputs}} {
  descriptions_.id = add<msg::SceneDescription>(msg::TOPIC_DESCRIPTION, "SceneDescription");
  devices_.id = add<msg::DeviceDescription>(msg::TOPIC_DEVICE, "DeviceDescription");
  frames_.id = add<msg::SceneFrame>(msg::TOPIC_FRAME, "SceneFrame");
  inputs_.id = add<msg::SceneInputs>(msg::TOPIC_INPUTS, "SceneInputs");
  thread_ = std::thread([this] { record(); });
}

TakeRecorder::~TakeRecorder() {
  finish();
}

template <class Message>
std::uint16_t TakeRecorder::add(const std::string& topic, const std::string& type) {
  const std::string name = "cordis::msg::" + type;
  const std::string text(msg::schema_text_of(name));
  EXPECT_FALSE(text.empty()) << name;
  const std::uint16_t schema = writer_.add_schema({0, name, "omgidl", text});
  return writer_.add_channel({0, schema, topic, "cdr", {}});
}

template <class Message>
bool TakeRecorder::drain(Channel<Message>& channel) {
  bool any = false;
  while (channel.reader.take(channel.message)) {
    any = true;
    const std::vector<std::byte> payload = dds::encode(channel.message);
    const std::uint64_t now = now_nsec();
    EXPECT_EQ(writer_.write({channel.id, ++channel.sequence, now, now, payload}),
              mcap::WriteStatus::kOk);
  }
  return any;
}

void TakeRecorder::record() {
  for (bool ends = false;;) {
    bool any = drain(descriptions_);
    any = drain(devices_) || any;
    any = drain(inputs_) || any;
    any = drain(frames_) || any;
    if (any) continue;
    if (ends) return;
    ends = ending_;
    inputs_.reader.wait(std::chrono::milliseconds(5));
  }
}

void TakeRecorder::finish() {
  if (!thread_.joinable()) return;
  ending_ = true;
  thread_.join();
  EXPECT_EQ(writer_.close(), mcap::WriteStatus::kOk) << writer_.problem();
}

}  // namespace cordis::test
