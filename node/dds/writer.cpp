// node/dds/writer.cpp
#include "node/dds/writer.h"

#include <stdexcept>

#include <fastdds/dds/core/status/PublicationMatchedStatus.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>

#include "node/dds/message_types.h"
#include "node/dds/participant_impl.h"

namespace cordis::dds {

template <class Message>
struct Writer<Message>::Impl {
  fast::Publisher* publisher = nullptr;
  fast::DataWriter* writer = nullptr;
};

template <class Message>
Writer<Message>::Writer(Participant& participant, Topic topic, int strength)
    : impl_(std::make_unique<Impl>()) {
  using eprosima::fastrtps::Duration_t;
  Participant::Impl& shared = participant.impl();
  const TopicQos row = qos_of(topic, shared.membership.lockstep, shared.membership.stand_ins);
  fast::Topic* dds_topic =
      shared.topic(row, fast::TypeSupport(new typename TypeOf<Message>::Type()));

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

  impl_->publisher = shared.publisher;
  impl_->writer = shared.publisher->create_datawriter(dds_topic, qos);
  if (impl_->writer == nullptr) {
    throw std::runtime_error(std::string("DDS refused to write ") + row.name);
  }
}

template <class Message>
Writer<Message>::~Writer() {
  if (impl_->writer != nullptr) impl_->publisher->delete_datawriter(impl_->writer);
}

template <class Message>
bool Writer<Message>::write(Message& message) noexcept {
  try {
    return impl_->writer->write(&message);
  } catch (...) {
    return false;
  }
}

template <class Message>
int Writer<Message>::matched_count() const noexcept {
  fast::PublicationMatchedStatus status;
  impl_->writer->get_publication_matched_status(status);
  return status.current_count;
}

template <class Message>
bool Writer<Message>::wait_until_acknowledged(std::chrono::milliseconds at_most) noexcept {
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
