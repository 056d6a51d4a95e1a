// viz_node/topic_board.cpp
#include "viz_node/topic_board.h"

#include <span>

#include "idl/schema_text.h"
#include "node/assert.h"

namespace cordis::viz {

TopicBoard::Channel* TopicBoard::find(const dds::RawTopic& topic) {
  const auto found = by_name_.find({topic.name, topic.type});
  return found == by_name_.end() ? nullptr : found->second;
}

TopicBoard::Channel* TopicBoard::find(std::uint32_t id) {
  return id == 0 || id > all_.size() ? nullptr : &all_[id - 1];
}

void TopicBoard::set_writers(const std::vector<dds::FoundWriter>& writers,
                             const std::vector<dds::Peer>& peers) {
  bool is_changed = false;
  {
    const std::lock_guard lock(mutex_);
    const std::shared_ptr<const Channels> before = channels_;
    take_writers(writers, peers);
    publish_channels();
    is_changed = channels_ != before;
  }
  if (is_changed) call_changed();
}

void TopicBoard::take_writers(const std::vector<dds::FoundWriter>& writers,
                              const std::vector<dds::Peer>& peers) {
  for (Channel& channel : all_) channel.has_writer = false;
  std::map<dds::WriterId, Writer> known;
  for (const dds::FoundWriter& writer : writers) {
    if (msg::schema_text_of(writer.topic.type).empty()) continue;
    Channel*& channel = by_name_[{writer.topic.name, writer.topic.type}];
    if (channel == nullptr) {
      channel = &all_.emplace_back();
      channel->about = {static_cast<std::uint32_t>(all_.size()), writer.topic.name,
                        writer.topic.type};
    }
    channel->has_writer = true;
    Writer& state = known[writer.id] = writers_[writer.id];
    state.is_of_loop_here =
        node::is_of_loop(writer.topic.name) &&
        std::ranges::any_of(peers, [&writer](const dds::Peer& peer) {
          return peer.is_here() && std::ranges::equal(peer.prefix, std::span(writer.id).first(12));
        });
  }
  writers_ = std::move(known);
  for (Channel& channel : all_) {
    std::erase_if(channel.kept,
                  [this](const auto& entry) { return !writers_.contains(entry.first.first); });
  }
}

/// Makes another list if the channels that have a writer are others.
void TopicBoard::publish_channels() {
  Channels now;
  for (const Channel& channel : all_) {
    if (channel.has_writer) now.push_back(channel.about);
  }
  if (!std::ranges::equal(now, *channels_, {}, &TopicChannel::id, &TopicChannel::id))
    channels_ = std::make_shared<const Channels>(std::move(now));
}

bool TopicBoard::is_wanted(const dds::RawTopic& topic) {
  const std::lock_guard lock(mutex_);
  Channel* const channel = find(topic);
  if (channel == nullptr) return false;
  if (channel->subscribers > 0) return true;
  channel->kept.clear();  // the next reader gets it again
  return false;
}

void TopicBoard::add(const dds::RawTopic& topic, const dds::RawSample& sample) {
  auto message = std::make_shared<TopicMessage>();
  message->bytes.assign(sample.data, sample.data + sample.size);
  {
    const std::lock_guard lock(mutex_);
    Channel* const channel = find(topic);
    if (channel == nullptr) return;
    message->channel = channel->about.id;
    message->index = ++channel->messages;
    Writer& writer = writers_[sample.writer];
    message->log_time_nsec = writer.log_time.next(static_cast<std::uint64_t>(sample.reception_nsec),
                                                  static_cast<std::uint64_t>(sample.source_nsec),
                                                  writer.is_of_loop_here);
    if (topic.transient_local) {
      Key key{};  // as RawType understands it
      if (topic.keyed && sample.size >= 8) std::copy_n(sample.data + 4, key.size(), key.begin());
      channel->kept[{sample.writer, key}] = message;
    }
    if (channel->subscribers == 0) return;
    message->number = ++last_number_;
    push(std::move(message));
  }
  call_changed();
}

void TopicBoard::push(std::shared_ptr<const TopicMessage> message) {
  bytes_ += message->bytes.size();
  messages_.push_back(std::move(message));
  while (messages_.size() > 1 && (bytes_ > kMaxBytes || messages_.size() > kMaxMessages)) {
    bytes_ -= messages_.front()->bytes.size();
    messages_.pop_front();
  }
}

std::shared_ptr<const TopicBoard::Channels> TopicBoard::channels() const {
  const std::lock_guard lock(mutex_);
  return channels_;
}

std::optional<TopicBoard::Start> TopicBoard::subscribe(std::uint32_t id) {
  const std::lock_guard lock(mutex_);
  Channel* const channel = find(id);
  if (channel == nullptr || !channel->has_writer) return std::nullopt;
  ++channel->subscribers;
  Start start{.last_index = channel->messages, .kept = {}};
  for (const auto& [writer, message] : channel->kept) start.kept.push_back(message);
  std::ranges::sort(start.kept, {}, &TopicMessage::index);
  return start;
}

void TopicBoard::unsubscribe(std::uint32_t id) {
  const std::lock_guard lock(mutex_);
  Channel* const channel = find(id);
  CORDIS_ASSERT(channel != nullptr && channel->subscribers > 0);
  --channel->subscribers;
  if (std::ranges::any_of(all_, [](const Channel& each) { return each.subscribers > 0; })) return;
  messages_.clear();
  bytes_ = 0;
}

}  // namespace cordis::viz
