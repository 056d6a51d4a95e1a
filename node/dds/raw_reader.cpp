// node/dds/raw_reader.cpp
#include "node/dds/raw_reader.h"

#include <atomic>
#include <map>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <utility>

#include <fastdds/dds/core/status/BaseStatus.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>

#include "idl/topics.h"
#include "node/dds/missing_numbers.h"
#include "node/dds/participant_impl.h"
#include "node/dds/raw_type.h"

namespace cordis::dds {

namespace rtps = eprosima::fastrtps::rtps;

namespace {

constexpr std::int64_t kFrameAnswerNsec = 200'000;

eprosima::fastrtps::Duration_t duration_of(std::int64_t nsec) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  return {static_cast<std::int32_t>(nsec / kSecond), static_cast<std::uint32_t>(nsec % kSecond)};
}

fast::DataReaderQos qos_of(const RawTopic& topic) {
  fast::DataReaderQos qos;
  qos.reliability().kind =
      topic.reliable ? fast::RELIABLE_RELIABILITY_QOS : fast::BEST_EFFORT_RELIABILITY_QOS;
  qos.durability().kind =
      topic.transient_local ? fast::TRANSIENT_LOCAL_DURABILITY_QOS : fast::VOLATILE_DURABILITY_QOS;
  qos.ownership().kind =
      topic.exclusive ? fast::EXCLUSIVE_OWNERSHIP_QOS : fast::SHARED_OWNERSHIP_QOS;
  if (topic.deadline_nsec > 0) qos.deadline().period = duration_of(topic.deadline_nsec);
  // A scene that is recorded without real time waits for the answer to each frame.
  if (topic.name == msg::TOPIC_FRAME)
    qos.reliable_reader_qos().times.heartbeatResponseDelay = duration_of(kFrameAnswerNsec);
  qos.history().kind = fast::KEEP_ALL_HISTORY_QOS;
  qos.resource_limits().max_samples = 0;  // no limit: each is taken as it comes
  qos.resource_limits().max_instances = 0;
  qos.resource_limits().max_samples_per_instance = 0;
  qos.resource_limits().allocated_samples = 8;
  qos.data_sharing().off();
  qos.endpoint().history_memory_policy = rtps::DYNAMIC_REUSABLE_MEMORY_MODE;
  return qos;
}

}  // namespace

struct RawReader::Impl final : fast::DataReaderListener, Endpoint {
  Impl(Participant::Impl& joined, RawTopic read, std::function<void(const RawSample&)> use)
      : participant(joined), topic(std::move(read)), sink(std::move(use)) {}

  Participant::Impl& participant;
  const RawTopic topic;
  const std::function<void(const RawSample&)> sink;

  /// A writer of the topic.
  struct Known {
    bool is_own = true;  // offers just this topic
    std::uint32_t strength = 0;
  };

  // Two presences may deliver at once while one replaces the other.
  std::mutex in_use;  // of all below but `lost`
  RawMessage message;
  std::map<WriterId, Known> writers;  // that were found
  MissingNumbers numbers{topic.exclusive};
  std::atomic<std::uint64_t> lost{0};

  fast::DataReader* reader = nullptr;
  fast::Subscriber* subscriber = nullptr;
  Presence* presence = nullptr;
  fast::DataReader* prepared = nullptr;
  fast::Subscriber* next_subscriber = nullptr;
  Presence* next_presence = nullptr;

  void prepare(Presence& joined) override {
    fast::Topic* read =
        joined.topic(topic.name, fast::TypeSupport(new RawType(topic.type, topic.keyed)));
    {
      const std::lock_guard lock(in_use);
      next_presence = &joined;
    }
    // Messages may come before this returns, with locks of DDS held: no lock is held here.
    next_subscriber = &joined.subscriber();
    prepared = next_subscriber->create_datareader(read, qos_of(topic), this,
                                                  fast::StatusMask::data_available()
                                                      << fast::StatusMask::sample_lost());
    if (prepared == nullptr) throw std::runtime_error("DDS refused to read " + topic.name);
  }

  void change_over() noexcept override {
    const std::lock_guard lock(in_use);
    reader = prepared;
    subscriber = next_subscriber;
    presence = next_presence;
  }

  /// A writer that is not found yet is looked for again at its next message.
  Known known(const WriterId& writer) {
    const auto entry = writers.find(writer);
    if (entry != writers.end()) return entry->second;
    std::optional<FoundWriter> found = next_presence->writer(writer);
    if (!found && presence != nullptr && presence != next_presence)
      found = presence->writer(writer);
    if (!found) return {};
    const Known now{.is_own = found->topic == topic, .strength = found->strength};
    writers.emplace(writer, now);
    return now;
  }

  void on_sample_lost(fast::DataReader*, const fast::SampleLostStatus& status) override {
    lost = static_cast<std::uint64_t>(status.total_count);
  }

  void on_data_available(fast::DataReader* from) override {
    const std::lock_guard lock(in_use);
    try {
      fast::SampleInfo info;
      while (from->take_next_sample(&message, &info) == ReturnCode_t::RETCODE_OK) {
        if (!info.valid_data) continue;
        const WriterId writer = writer_id(info.sample_identity.writer_guid());
        const Known from_whom = known(writer);
        if (!from_whom.is_own) continue;
        const std::uint64_t sequence = info.sample_identity.sequence_number().to64long();
        const MissingNumbers::Noted noted =
            numbers.note(writer, from_whom.strength, topic.keyed ? key_of(message) : 0, sequence);
        sink({.data = message.data(),
              .size = message.size(),
              .source_nsec = info.source_timestamp.to_ns(),
              .reception_nsec = info.reception_timestamp.to_ns(),
              .writer = writer,
              .sequence = sequence,
              .is_first = noted.is_first,
              .missing = noted.missing});
      }
    } catch (...) {  // no memory for it: lost
      ++lost;
    }
  }
};

RawReader::RawReader(Participant& participant, const RawTopic& topic,
                     std::function<void(const RawSample&)> sink)
    : impl_(std::make_unique<Impl>(participant.impl(), topic, std::move(sink))) {
  participant.impl().add(*impl_);
}

RawReader::~RawReader() {
  impl_->participant.remove(*impl_, [this] {
    impl_->reader->set_listener(nullptr);
    impl_->subscriber->delete_datareader(impl_->reader);
  });
}

std::uint64_t RawReader::lost_count() const noexcept {
  return impl_->lost;
}

}  // namespace cordis::dds
