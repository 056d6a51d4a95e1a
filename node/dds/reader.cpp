// node/dds/reader.cpp
#include "node/dds/reader.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <mutex>
#include <stdexcept>
#include <string>
#include <vector>

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
  Impl(Participant::Impl& joined, Topic topic, Arrival* announced, Repair repair)
      : participant(joined),
        row(row_of(topic, joined.config(), repair)),
        arrival(announced),
        mailbox(announced != nullptr ? kMailboxRoom * row.history_depth : 0) {}

  static TopicQos row_of(Topic topic, const ParticipantConfig& config, Repair repair) noexcept {
    TopicQos row = qos_of(topic, config.lockstep, config.standbys);
    if (repair == Repair::kNone) row.reliable = false;
    return row;
  }

  Participant::Impl& participant;
  const TopicQos row;
  Arrival* const arrival;

  /// A message that has been taken out of DDS, and who wrote it.
  struct Letter {
    Message message;
    rtps::GUID_t writer;
  };

  // Messages taken out of DDS when arrivals are reported, oldest first from mailbox_first on. If
  // only the newest message of a topic counts, the mailbox holds one of each device and writer.
  static constexpr std::size_t kMailboxRoom = 64;  // devices
  std::mutex mailbox_mutex;
  std::vector<Letter> mailbox;
  std::size_t mailbox_first = 0;
  std::size_t mailbox_count = 0;

  std::mutex in_use;  // held by whoever uses the reader; free but while it changes over
  fast::DataReader* reader = nullptr;
  fast::Subscriber* subscriber = nullptr;
  std::atomic<Presence*> presence{nullptr};

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
    Presence* none = nullptr;
    presence.compare_exchange_strong(none, &joined);  // messages may come before change_over()
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

  ParticipantPrefix last_writer{};  // of the message taken last; of the thread that takes

  static ParticipantPrefix prefix_of(const rtps::GUID_t& writer) noexcept {
    ParticipantPrefix prefix;
    std::copy_n(writer.guidPrefix.value, prefix.size(), prefix.begin());
    return prefix;
  }

  /// True if a message is of a writer that speaks another version of the wire.
  bool is_refused(const Message& message, const rtps::GUID_t& writer) {
    const ParticipantPrefix prefix = prefix_of(writer);
    if constexpr (requires { message.wire_version(); }) {
      Presence* const joined = presence;
      const std::uint32_t version = message.wire_version();
      if (version != participant.config().wire_version) joined->evaluate(prefix, version);
      return version != participant.config().wire_version || joined->refuses(prefix);
    } else {
      return has_other_wire_version(prefix, participant.config().wire_version);
    }
  }

  void on_data_available(fast::DataReader* available) override {
    if (arrival != nullptr) {
      collect(*available);
      arrival->announce();
    }
    {
      const std::lock_guard lock(mutex);
      pending = true;
    }
    arrived.notify_one();
  }

  /// Takes out of DDS what there is. The thread that DDS receives with holds locks of DDS while it
  /// is here: a loop that it wakes must not need them.
  void collect(fast::DataReader& available) noexcept {
    Letter letter;
    while (take_from(available, letter.message, letter.writer)) {
      // What this node writes on the same topic is not for it.
      if (letter.writer.guidPrefix == available.guid().guidPrefix) continue;
      const std::lock_guard lock(mailbox_mutex);
      if (Letter* const before = older_than(letter)) {
        *before = letter;
        continue;
      }
      mailbox[(mailbox_first + mailbox_count) % mailbox.size()] = letter;
      const bool is_full = mailbox_count == mailbox.size();  // then the oldest has been replaced
      mailbox_first = (mailbox_first + (is_full ? 1 : 0)) % mailbox.size();
      mailbox_count += is_full ? 0 : 1;
    }
  }

  /// The message that a newer one of the same device and writer replaces; nullptr when every message
  /// counts, or when there is none.
  Letter* older_than(const Letter& letter) noexcept {
    if constexpr (requires { letter.message.device_id(); }) {
      for (std::size_t i = 0; !row.reliable && i < mailbox_count; ++i) {
        Letter& one = mailbox[(mailbox_first + i) % mailbox.size()];
        const bool is_same_device = one.message.device_id() == letter.message.device_id();
        if (is_same_device && one.writer == letter.writer) return &one;
      }
    }
    return nullptr;
  }

  bool take_collected(Message& message) noexcept {
    const std::lock_guard lock(mailbox_mutex);
    if (mailbox_count == 0) return false;
    message = mailbox[mailbox_first].message;
    last_writer = prefix_of(mailbox[mailbox_first].writer);
    mailbox_first = (mailbox_first + 1) % mailbox.size();
    --mailbox_count;
    return true;
  }

  bool take_from(fast::DataReader& from, Message& message, rtps::GUID_t& writer) noexcept {
    try {
      fast::SampleInfo info;
      while (from.take_next_sample(&message, &info) == ReturnCode_t::RETCODE_OK) {
        writer = rtps::iHandle2GUID(info.publication_handle);
        if (info.valid_data && !is_refused(message, writer)) return true;
      }
    } catch (...) {  // a message too large to hold counts as none
    }
    return false;
  }
};

template <class Message>
Reader<Message>::Reader(Participant& participant, Topic topic, Arrival* arrival, Repair repair)
    : impl_(std::make_unique<Impl>(participant.impl(), topic, arrival, repair)) {
  if (arrival != nullptr) arrival->attach(participant.impl().present_socket());
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
  if (impl_->arrival != nullptr) return impl_->take_collected(message);
  const std::lock_guard lock(impl_->in_use);
  rtps::GUID_t writer;
  if (!impl_->take_from(*impl_->reader, message, writer)) return false;
  impl_->last_writer = Impl::prefix_of(writer);
  return true;
}

template <class Message>
bool Reader<Message>::is_of_this_host() const {
  const std::lock_guard lock(impl_->in_use);
  return impl_->presence.load()->is_here(impl_->last_writer);
}

template <class Message>
ParticipantPrefix Reader<Message>::last_writer() const noexcept {
  return impl_->last_writer;
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
template class Reader<msg::PointerTarget>;
template class Reader<msg::PointerState>;
template class Reader<msg::SceneDescription>;
template class Reader<msg::SceneFrame>;
template class Reader<msg::SceneSignals>;
template class Reader<msg::SceneSound>;
template class Reader<msg::SceneEvents>;
template class Reader<msg::SceneInputs>;
template class Reader<msg::ControlCommand>;
template class Reader<msg::ControlReply>;
template class Reader<msg::NodeStatus>;

}  // namespace cordis::dds
