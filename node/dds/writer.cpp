// node/dds/writer.cpp
#include "node/dds/writer.h"

#include <mutex>
#include <stdexcept>
#include <string>

#include <fastdds/dds/core/status/PublicationMatchedStatus.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>

#include "node/dds/message_types.h"
#include "node/dds/participant_impl.h"

namespace cordis::dds {

template <class Message>
struct Writer<Message>::Impl final : Endpoint {
  Impl(Participant::Impl& joined, Topic topic, int strength_among_writers)
      : participant(joined),
        row(qos_of(topic, joined.config().lockstep, joined.config().standbys)),
        strength(strength_among_writers) {}

  Participant::Impl& participant;
  const TopicQos row;
  const int strength;

  std::mutex in_use;  // held by whoever uses the writer; free but while it changes over
  fast::DataWriter* writer = nullptr;
  fast::Publisher* publisher = nullptr;
  std::unique_ptr<Message> kept;  // for late joiners: the last message

  fast::DataWriter* prepared = nullptr;
  fast::Publisher* next_publisher = nullptr;

  void prepare(Presence& presence) override {
    fast::Topic* topic =
        presence.topic(row, fast::TypeSupport(new typename TypeOf<Message>::Type()));
    next_publisher = &presence.publisher();
    prepared = next_publisher->create_datawriter(topic, qos());
    if (prepared == nullptr) {
      throw std::runtime_error(std::string("DDS refused to write ") + row.name);
    }
  }

  void change_over() noexcept override {
    const std::lock_guard lock(in_use);
    writer = prepared;
    publisher = next_publisher;
    if (kept != nullptr) send(*kept);
  }

  fast::DataWriterQos qos() const {
    using eprosima::fastrtps::Duration_t;
    fast::DataWriterQos qos;
    apply(row, qos);
    qos.ownership_strength().value = static_cast<std::uint32_t>(strength);
    qos.publish_mode().kind =
        row.asynchronous ? fast::ASYNCHRONOUS_PUBLISH_MODE : fast::SYNCHRONOUS_PUBLISH_MODE;
    qos.reliable_writer_qos().times.heartbeatPeriod =
        Duration_t(0, static_cast<std::uint32_t>(row.heartbeat_msec) * 1'000'000u);
    // A reader that does not take must never hold the writer: with keep-last the oldest sample is
    // overwritten.
    qos.reliability().max_blocking_time = Duration_t(0, 1'000'000u);
    return qos;
  }

  bool send(Message& message) noexcept {
    try {
      return writer->write(&message);
    } catch (...) {
      return false;
    }
  }

  /// @return false when memory is short
  bool keep(const Message& message) noexcept {
    try {
      if (kept == nullptr) {
        kept = std::make_unique<Message>(message);
      } else {
        *kept = message;
      }
      return true;
    } catch (...) {
      return false;
    }
  }
};

template <class Message>
Writer<Message>::Writer(Participant& participant, Topic topic, int strength)
    : impl_(std::make_unique<Impl>(participant.impl(), topic, strength)) {
  participant.impl().add(*impl_);
}

template <class Message>
Writer<Message>::~Writer() {
  impl_->participant.remove(*impl_, [this] { impl_->publisher->delete_datawriter(impl_->writer); });
}

template <class Message>
bool Writer<Message>::write(Message& message) noexcept {
  if constexpr (requires { message.wire_version(0u); })
    message.wire_version(impl_->participant.config().wire_version);
  const std::lock_guard lock(impl_->in_use);
  if (impl_->row.transient_local && !impl_->keep(message)) return false;
  return impl_->send(message);
}

template <class Message>
int Writer<Message>::matched_count() const noexcept {
  const std::lock_guard lock(impl_->in_use);
  fast::PublicationMatchedStatus status;
  impl_->writer->get_publication_matched_status(status);
  return status.current_count;
}

template <class Message>
bool Writer<Message>::wait_until_acknowledged(std::chrono::milliseconds at_most) noexcept {
  const std::lock_guard lock(impl_->in_use);
  const auto msec = at_most.count();
  const eprosima::fastrtps::Duration_t limit(static_cast<std::int32_t>(msec / 1000),
                                             static_cast<std::uint32_t>(msec % 1000) * 1'000'000u);
  return impl_->writer->wait_for_acknowledgments(limit) == ReturnCode_t::RETCODE_OK;
}

template class Writer<msg::GesturePositions>;
template class Writer<msg::GestureForces>;
template class Writer<msg::DeviceDescription>;
template class Writer<msg::SceneDescription>;
template class Writer<msg::SceneFrame>;
template class Writer<msg::SceneSignals>;
template class Writer<msg::SceneEvents>;
template class Writer<msg::ControlCommand>;
template class Writer<msg::ControlReply>;
template class Writer<msg::NodeStatus>;

}  // namespace cordis::dds
