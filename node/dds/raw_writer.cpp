// node/dds/raw_writer.cpp
#include "node/dds/raw_writer.h"

#include <map>
#include <mutex>
#include <stdexcept>
#include <utility>

#include <fastdds/dds/core/status/PublicationMatchedStatus.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>

#include "idl/topics.h"
#include "node/dds/participant_impl.h"
#include "node/dds/raw_type.h"

namespace cordis::dds {
namespace {

constexpr int kStreamDepth = 256;  // of a reliable topic: what a slow reader may still ask for
constexpr int kFrameDepth = 4;     // likewise, of messages that may have 100 MB

/// What a topic of Cordis has beyond what a reader sees of it.
TopicQos row_of(const RawTopic& topic) {
  const bool is_frame = topic.name == msg::TOPIC_FRAME;
  if (topic.name == msg::TOPIC_INPUTS && topic.transient_local)
    return qos_of(Topic::kInputs, false, false);
  return {.name = topic.name.c_str(),
          .reliable = topic.reliable,
          .transient_local = topic.transient_local,
          .history_depth = is_frame                                   ? kFrameDepth
                           : topic.reliable && !topic.transient_local ? kStreamDepth
                                                                      : 1,
          .asynchronous = is_frame,
          .heartbeat_msec = 20,
          .exclusive_for_msec = topic.exclusive ? 20 : 0};
}

}  // namespace

struct RawWriter::Impl final : Endpoint {
  Impl(Participant::Impl& joined, RawTopic written)
      : participant(joined), topic(std::move(written)) {}

  Participant::Impl& participant;
  const RawTopic topic;

  std::mutex in_use;
  fast::DataWriter* writer = nullptr;
  fast::Publisher* publisher = nullptr;
  RawMessage message;
  std::map<std::uint32_t, RawMessage> kept;  // for late joiners: the last message of each key

  fast::DataWriter* prepared = nullptr;
  fast::Publisher* next_publisher = nullptr;

  void prepare(Presence& presence) override {
    fast::Topic* written =
        presence.topic(topic.name, fast::TypeSupport(new RawType(topic.type, topic.keyed)));
    next_publisher = &presence.publisher();
    prepared = next_publisher->create_datawriter(written, writer_qos_of(row_of(topic)));
    if (prepared == nullptr) throw std::runtime_error("DDS refused to write " + topic.name);
  }

  void change_over() noexcept override {
    const std::lock_guard lock(in_use);
    writer = prepared;
    publisher = next_publisher;
    for (auto& [key, last] : kept) send(last);
  }

  bool send(RawMessage& sent) noexcept {
    try {
      return writer->write(&sent);
    } catch (...) {
      return false;
    }
  }
};

RawWriter::RawWriter(Participant& participant, const RawTopic& topic)
    : impl_(std::make_unique<Impl>(participant.impl(), topic)) {
  participant.impl().add(*impl_);
}

RawWriter::~RawWriter() {
  impl_->participant.remove(*impl_, [this] { impl_->publisher->delete_datawriter(impl_->writer); });
}

bool RawWriter::write(const std::vector<std::uint8_t>& message) noexcept {
  const std::lock_guard lock(impl_->in_use);
  try {
    impl_->message = message;
    if (impl_->topic.transient_local)
      impl_->kept[impl_->topic.keyed ? key_of(message) : 0] = message;
  } catch (...) {
    return false;
  }
  return impl_->send(impl_->message);
}

int RawWriter::matched_count() const noexcept {
  const std::lock_guard lock(impl_->in_use);
  fast::PublicationMatchedStatus status;
  impl_->writer->get_publication_matched_status(status);
  return status.current_count;
}

void RawWriter::finish() noexcept {
  const std::chrono::milliseconds at_most = impl_->participant.farewell();
  const std::lock_guard lock(impl_->in_use);
  static_cast<void>(wait_for_acknowledgments(*impl_->writer, at_most));
}

}  // namespace cordis::dds
