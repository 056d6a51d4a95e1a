// record_node/recorder.cpp
#include "record_node/recorder.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <mutex>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "idl/topics.h"
#include "node/topic_follower.h"
#include "record_node/mcap/topic_glob.h"
#include "record_node/plan_report.h"
#include "record_node/recorded_writer.h"
#include "record_node/sample_queue.h"
#include "record_node/take_writer.h"

namespace cordis::record {
namespace {

using Clock = std::chrono::steady_clock;

dds::ParticipantConfig member_of(const RecorderConfig& config) {
  dds::ParticipantConfig member{config.domain, config.session, config.node + "/topics"};
  member.every_partition = config.session.empty();
  member.network = config.network;
  member.security = config.security;
  member.observes = true;
  return member;
}

}  // namespace

struct Recorder::Impl {
  explicit Impl(RecorderConfig wanted)
      : config(std::move(wanted)),
        queue(config.queue_bytes),
        plan(config.plan_command),
        participant(member_of(config)),
        file(config, plan, queue, writers,
             [this](const dds::WriterId& id) { return origin_of(id); }),
        follower(
            participant, [this](const dds::RawTopic& topic) { return is_wanted(topic.name); },
            [this](const dds::RawTopic& topic, const dds::RawSample& sample) {
              take(topic, sample);
            },
            [this](const std::vector<dds::FoundWriter>& found) {
              const std::lock_guard lock(known_mutex);
              for (const dds::FoundWriter& writer : found) topics_found.insert(writer.topic.name);
            }) {}

  ~Impl() { close(); }

  const RecorderConfig config;
  const Clock::time_point began = Clock::now();
  SampleQueue queue;
  RecordedWriters writers;
  PlanReport plan;  // begins before there are sockets that its process would inherit
  dds::Participant participant;
  TakeWriter file;
  std::mutex known_mutex;
  std::map<dds::WriterId, RecordedWriter*> known;
  std::set<std::string> topics_found;
  node::TopicFollower follower;

  bool is_wanted(const std::string& topic) const {
    return mcap::matches_topic(topic, config.topics) &&
           (config.excluded.empty() || !mcap::matches_topic(topic, config.excluded));
  }

  RecordedWriter* writer_of(const dds::RawTopic& topic, const dds::WriterId& id) {
    const std::lock_guard lock(known_mutex);
    RecordedWriter*& writer = known[id];
    if (writer == nullptr) writer = &writers.add(topic, id);
    return writer;
  }

  /// Called from threads of DDS, one at a time for a topic.
  void take(const dds::RawTopic& topic, const dds::RawSample& sample) {
    RecordedWriter* const writer = writer_of(topic, sample.writer);
    if (!sample.is_first) writer->lost += sample.missing;
    if (sample.is_first && !topic.transient_local) writer->before += sample.missing;
    ++writer->messages;
    writer->bytes += sample.size;
    const QueuedSample queued{.channel = writer->number,
                              .sequence = static_cast<std::uint32_t>(sample.sequence),
                              .log_time_nsec = static_cast<std::uint64_t>(sample.reception_nsec),
                              .publish_time_nsec = static_cast<std::uint64_t>(sample.source_nsec)};
    const bool is_frame = topic.name == msg::TOPIC_FRAME;
    if (file.is_over() || !queue.push(queued, {sample.data, sample.size}, is_frame))
      ++writer->dropped;
  }

  TakeWriter::Origin origin_of(const dds::WriterId& id) const {
    TakeWriter::Origin origin;
    for (const dds::FoundWriter& writer : participant.writers()) {
      if (writer.id != id) continue;
      for (const std::string& partition : writer.partitions)
        origin.partitions += (origin.partitions.empty() ? "" : ",") + partition;
    }
    for (const dds::Peer& peer : participant.peers()) {
      if (!std::equal(peer.prefix.begin(), peer.prefix.end(), id.begin())) continue;
      origin.process = peer.name;
      origin.is_here = peer.is_here();
    }
    return origin;
  }

  RecorderFigures figures() const {
    RecorderFigures sum;
    std::set<std::string> topics;
    writers.for_each([&](const RecordedWriter& writer) {
      sum.messages += writer.messages;
      sum.bytes += writer.bytes;
      const std::uint64_t lost = writer.lost;
      sum.missed.dropped += writer.dropped;
      sum.missed.lost += lost;
      if (is_replacing(writer.topic.name)) sum.missed.replaced += lost;
      sum.missed.before += writer.before;
      topics.insert(writer.topic.name);
    });
    sum.topics = topics.size();
    sum.waiting_bytes = queue.waiting_bytes();
    sum.file_bytes = file.file_bytes();
    sum.seconds = std::chrono::duration<double>(Clock::now() - began).count();
    sum.is_over = file.is_over();
    sum.has_failed = file.has_failed();
    sum.problem = file.problem();
    return sum;
  }

  void close() {
    follower.stop();
    file.close();
  }
};

Recorder::Recorder(RecorderConfig config) : impl_(std::make_unique<Impl>(std::move(config))) {}

Recorder::~Recorder() = default;

RecorderFigures Recorder::figures() const {
  return impl_->figures();
}

std::string Recorder::unmatched() const {
  const std::lock_guard lock(impl_->known_mutex);
  const std::set<std::string>& topics = impl_->topics_found;
  std::vector<std::string> patterns;
  for (const std::string& pattern : impl_->config.topics) {
    if (std::ranges::none_of(topics, [&pattern](const std::string& topic) {
          return mcap::matches_topic(topic, {pattern});
        }))
      patterns.push_back(pattern);
  }
  if (patterns.empty()) return {};
  return fmt::format("no topic fits '{}'; there {}", fmt::join(patterns, "', '"),
                     topics.empty() ? "is none" : fmt::format("are {}", fmt::join(topics, ", ")));
}

std::string Recorder::mismatch() const {
  return impl_->participant.mismatch();
}

RecorderFigures Recorder::close() {
  impl_->close();
  return impl_->figures();
}

}  // namespace cordis::record
