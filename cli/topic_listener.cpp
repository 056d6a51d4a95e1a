// cli/topic_listener.cpp
#include "cli/topic_listener.h"

#include <utility>

#include <unistd.h>

#include "record_node/mcap/topic_glob.h"

namespace cordis::cli {
namespace {

dds::ParticipantConfig member_of(const SessionAddress& address) {
  dds::ParticipantConfig member{address.domain, address.session,
                                "cordis " + std::to_string(getpid())};
  member.every_partition = address.session.empty();
  member.network = address.network;
  member.security = security_for(address, node::Role::kController);
  return member;
}

std::vector<std::string> patterns_of(const std::string& pattern) {
  if (pattern.empty()) return {};
  return {pattern};
}

}  // namespace

TopicListener::TopicListener(const SessionAddress& address, const std::string& pattern,
                             bool with_bytes)
    : with_bytes_(with_bytes),
      participant_(member_of(address)),
      follower_(
          participant_,
          [patterns = patterns_of(pattern)](const dds::RawTopic& topic) {
            return mcap::matches_topic(topic.name, patterns);
          },
          [this](const dds::RawTopic& topic, const dds::RawSample& sample) {
            receive(topic, sample);
          }) {}

void TopicListener::receive(const dds::RawTopic& topic, const dds::RawSample& sample) {
  {
    const std::lock_guard lock(mutex_);
    if (waiting_bytes_ > kMaxWaitingBytes) {
      ++left_out_;
      return;
    }
    ReceivedMessage& message = waiting_.emplace_back();
    message.topic = topic;
    message.source_nsec = sample.source_nsec;
    message.reception_nsec = sample.reception_nsec;
    message.sequence = sample.sequence;
    message.missing = sample.missing;
    message.writer = sample.writer;
    message.size = sample.size;
    if (with_bytes_) message.bytes.assign(sample.data, sample.data + sample.size);
    waiting_bytes_ += sample.size;
  }
  received_.notify_one();
}

std::deque<ReceivedMessage> TopicListener::take(std::chrono::milliseconds at_most) {
  std::unique_lock lock(mutex_);
  received_.wait_for(lock, at_most, [this] { return !waiting_.empty(); });
  waiting_bytes_ = 0;
  return std::exchange(waiting_, {});
}

std::uint64_t TopicListener::left_out() const {
  const std::lock_guard lock(mutex_);
  return left_out_;
}

}  // namespace cordis::cli
