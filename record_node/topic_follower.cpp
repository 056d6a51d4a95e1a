// record_node/topic_follower.cpp
#include "record_node/topic_follower.h"

#include <chrono>
#include <exception>
#include <utility>

#include <spdlog/spdlog.h>

namespace cordis::record {
namespace {

constexpr auto kLookForWriters = std::chrono::milliseconds(20);

}  // namespace

TopicFollower::TopicFollower(dds::Participant& participant, IsWanted is_wanted, Sink sink)
    : participant_(participant),
      is_wanted_(std::move(is_wanted)),
      sink_(std::move(sink)),
      thread_([this] { loop(); }) {}

TopicFollower::~TopicFollower() {
  stop();
}

void TopicFollower::stop() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  woken_.notify_one();
  if (thread_.joinable()) thread_.join();
  readers_.clear();
}

/// Readers are made here, for the listeners that find writers must not.
void TopicFollower::loop() {
  std::unique_lock lock(mutex_);
  while (!ending_) {
    lock.unlock();
    for (const dds::FoundWriter& writer : participant_.writers()) read(writer.topic);
    lock.lock();
    woken_.wait_for(lock, kLookForWriters, [this] { return ending_; });
  }
}

void TopicFollower::read(const dds::RawTopic& topic) {
  if (readers_.contains(topic) || refused_.contains(topic) || !is_wanted_(topic.name)) return;
  try {
    auto reader = std::make_unique<dds::RawReader>(
        participant_, topic, [this, topic](const dds::RawSample& sample) { sink_(topic, sample); });
    readers_[topic] = std::move(reader);
  } catch (const std::exception& error) {
    refused_.insert(topic);
    spdlog::warn("{} is not read: {}", topic.name, error.what());
  }
}

}  // namespace cordis::record
