// node/topic_follower.cpp
#include "node/topic_follower.h"

#include <chrono>
#include <exception>
#include <utility>

#include <spdlog/spdlog.h>

namespace cordis::node {
namespace {

constexpr auto kWriterPollPeriod = std::chrono::milliseconds(20);

}  // namespace

TopicFollower::TopicFollower(dds::Participant& participant, IsWanted is_wanted, Sink sink,
                             Found found)
    : participant_(participant),
      is_wanted_(std::move(is_wanted)),
      sink_(std::move(sink)),
      found_(std::move(found)),
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
    update();
    lock.lock();
    woken_.wait_for(lock, kWriterPollPeriod, [this] { return ending_; });
  }
}

void TopicFollower::update() {
  const std::vector<dds::FoundWriter> writers = participant_.writers();
  if (found_) found_(writers);
  std::erase_if(readers_, [this](const auto& entry) { return !is_wanted_(entry.first); });
  for (const dds::FoundWriter& writer : writers) read(writer.topic);
}

void TopicFollower::read(const dds::RawTopic& topic) {
  if (readers_.contains(topic) || refused_.contains(topic) || !is_wanted_(topic)) return;
  try {
    auto reader = std::make_unique<dds::RawReader>(
        participant_, topic, [this, topic](const dds::RawSample& sample) { sink_(topic, sample); });
    readers_[topic] = std::move(reader);
  } catch (const std::exception& error) {
    refused_.insert(topic);
    spdlog::warn("{} is not read: {}", topic.name, error.what());
  }
}

}  // namespace cordis::node
