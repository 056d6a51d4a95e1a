// node/dds/writer.cpp
#include "node/dds/writer.h"

#include <algorithm>
#include <cstddef>
#include <mutex>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include <fastdds/dds/core/status/PublicationMatchedStatus.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/DataWriterListener.hpp>

#include "node/assert.h"
#include "node/dds/message_types.h"
#include "node/dds/participant_impl.h"

namespace cordis::dds {

/// Which participants have a reader that a writer sends to.
class ReaderOwners final : public fast::DataWriterListener {
 public:
  void on_publication_matched(fast::DataWriter*,
                              const fast::PublicationMatchedStatus& info) override {
    ParticipantPrefix prefix;
    for (std::size_t i = 0; i < prefix.size(); ++i)
      prefix[i] = info.last_subscription_handle.value[i];
    const std::lock_guard lock(mutex_);
    if (info.current_count_change > 0) owners_.insert(prefix);
    if (info.current_count_change < 0) owners_.erase(prefix);
  }
  bool has(const ParticipantPrefix& prefix) const {
    const std::lock_guard lock(mutex_);
    return owners_.contains(prefix);
  }

 private:
  mutable std::mutex mutex_;
  std::set<ParticipantPrefix> owners_;
};

template <class Message>
struct Writer<Message>::Impl final : Endpoint {
  Impl(Participant::Impl& joined, Topic topic, int strength_among_writers)
      : participant(joined),
        row(qos_of(topic, joined.config().lockstep, joined.config().standbys)),
        strength(strength_among_writers) {
    CORDIS_ASSERT(strength_among_writers >= 0);
  }

  Participant::Impl& participant;
  const TopicQos row;
  const int strength;

  std::mutex in_use;  // held by whoever uses the writer; free but while it changes over
  fast::DataWriter* writer = nullptr;
  fast::Publisher* publisher = nullptr;
  std::unique_ptr<Message> kept;  // for late joiners: the last message
  ReaderOwners owners;            // outlives the writer

  fast::DataWriter* prepared = nullptr;
  fast::Publisher* next_publisher = nullptr;

  void prepare(Presence& presence) override {
    fast::Topic* topic =
        presence.topic(row, fast::TypeSupport(new typename TypeOf<Message>::Type()));
    next_publisher = &presence.publisher();
    prepared = next_publisher->create_datawriter(topic, qos(), &owners,
                                                 fast::StatusMask::publication_matched());
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
    fast::DataWriterQos qos = writer_qos_of(row);
    qos.ownership_strength().value = static_cast<std::uint32_t>(strength);
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
bool Writer<Message>::has_reader_of(const std::string& node) const {
  const std::string name = impl_->participant.config().session + "/" + node;
  const std::vector<Peer> peers = impl_->participant.peers();
  return std::any_of(peers.begin(), peers.end(), [&](const Peer& peer) {
    return peer.name == name && impl_->owners.has(peer.prefix);
  });
}

template <class Message>
bool Writer<Message>::wait_until_acknowledged(std::chrono::milliseconds at_most) noexcept {
  const std::lock_guard lock(impl_->in_use);
  return wait_for_acknowledgments(*impl_->writer, at_most);
}

template <class Message>
void Writer<Message>::finish() noexcept {
  static_cast<void>(wait_until_acknowledged(impl_->participant.farewell()));
}

template class Writer<msg::GesturePositions>;
template class Writer<msg::GestureForces>;
template class Writer<msg::DeviceDescription>;
template class Writer<msg::PointerTarget>;
template class Writer<msg::PointerState>;
template class Writer<msg::SceneDescription>;
template class Writer<msg::SceneFrame>;
template class Writer<msg::SceneSignals>;
template class Writer<msg::SceneSound>;
template class Writer<msg::SceneEvents>;
template class Writer<msg::SceneInputs>;
template class Writer<msg::ControlCommand>;
template class Writer<msg::ControlReply>;
template class Writer<msg::NodeStatus>;

}  // namespace cordis::dds
