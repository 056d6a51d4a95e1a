// node/dds/reader.cpp
#include "node/dds/reader.h"

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <stdexcept>
#include <string>

#include <fastdds/dds/core/status/SubscriptionMatchedStatus.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>

#include "node/dds/message_types.h"
#include "node/dds/participant_impl.h"

namespace cordis::dds {

namespace rtps = eprosima::fastrtps::rtps;

template <class Message>
struct Reader<Message>::Impl final : fast::DataReaderListener, Endpoint {
  Impl(Participant::Impl& joined, Topic topic)
      : participant(joined),
        row(qos_of(topic, joined.config().lockstep, joined.config().standbys)) {}

  Participant::Impl& participant;
  const TopicQos row;

  std::mutex in_use;  // held by whoever uses the reader; free but while it changes over
  fast::DataReader* reader = nullptr;
  fast::Subscriber* subscriber = nullptr;
  Presence* presence = nullptr;

  fast::DataReader* prepared = nullptr;
  fast::Subscriber* next_subscriber = nullptr;
  Presence* next_presence = nullptr;

  std::mutex mutex;
  std::condition_variable arrived;
  bool pending = false;
  bool interrupted = false;

  void prepare(Presence& joined) override {
    fast::Topic* topic = joined.topic(row, fast::TypeSupport(new typename TypeOf<Message>::Type()));
    fast::DataReaderQos qos;
    apply(row, qos);
    next_subscriber = &joined.subscriber();
    next_presence = &joined;
    prepared =
        next_subscriber->create_datareader(topic, qos, this, fast::StatusMask::data_available());
    if (prepared == nullptr) {
      throw std::runtime_error(std::string("DDS refused to read ") + row.name);
    }
  }

  void change_over() noexcept override {
    const std::lock_guard lock(in_use);
    reader = prepared;
    subscriber = next_subscriber;
    presence = next_presence;
  }

  /// True if a message is of a writer that speaks another version of the wire.
  bool is_refused(const Message& message, const fast::SampleInfo& info) const {
    const rtps::GUID_t writer = rtps::iHandle2GUID(info.publication_handle);
    ParticipantPrefix prefix;
    std::copy_n(writer.guidPrefix.value, prefix.size(), prefix.begin());
    if constexpr (requires { message.wire_version(); }) {
      const std::uint32_t version = message.wire_version();
      if (version != participant.config().wire_version) presence->judge(prefix, version);
      return version != participant.config().wire_version || presence->refuses(prefix);
    } else {
      return presence->refuses(prefix);
    }
  }

  void on_data_available(fast::DataReader*) override {
    {
      const std::lock_guard lock(mutex);
      pending = true;
    }
    arrived.notify_one();
  }
};

template <class Message>
Reader<Message>::Reader(Participant& participant, Topic topic)
    : impl_(std::make_unique<Impl>(participant.impl(), topic)) {
  participant.impl().add(*impl_);
}

template <class Message>
Reader<Message>::~Reader() {
  impl_->participant.remove(*impl_, [this] {
    impl_->reader->set_listener(nullptr);
    impl_->subscriber->delete_datareader(impl_->reader);
  });
}

template <class Message>
bool Reader<Message>::take(Message& message) noexcept {
  const std::lock_guard lock(impl_->in_use);
  try {
    fast::SampleInfo info;
    while (impl_->reader->take_next_sample(&message, &info) == ReturnCode_t::RETCODE_OK) {
      if (info.valid_data && !impl_->is_refused(message, info)) return true;
    }
  } catch (...) {  // a message too large to hold counts as none
  }
  return false;
}

template <class Message>
bool Reader<Message>::wait(std::chrono::nanoseconds at_most) noexcept {
  std::unique_lock lock(impl_->mutex);
  impl_->arrived.wait_for(lock, at_most, [this] { return impl_->pending || impl_->interrupted; });
  impl_->interrupted = false;
  // A message may have been taken since the listener spoke; the caller's take() then finds nothing
  // and waits again.
  const bool pending = impl_->pending;
  impl_->pending = false;
  return pending;
}

template <class Message>
void Reader<Message>::interrupt() noexcept {
  {
    const std::lock_guard lock(impl_->mutex);
    impl_->interrupted = true;
  }
  impl_->arrived.notify_one();
}

template <class Message>
int Reader<Message>::matched_count() const noexcept {
  const std::lock_guard lock(impl_->in_use);
  fast::SubscriptionMatchedStatus status;
  impl_->reader->get_subscription_matched_status(status);
  return status.current_count;
}

template class Reader<msg::GesturePositions>;
template class Reader<msg::GestureForces>;
template class Reader<msg::DeviceDescription>;
template class Reader<msg::SceneDescription>;
template class Reader<msg::SceneFrame>;
template class Reader<msg::SceneSignals>;
template class Reader<msg::SceneEvents>;
template class Reader<msg::ControlCommand>;
template class Reader<msg::ControlReply>;
template class Reader<msg::NodeStatus>;

}  // namespace cordis::dds
