// viz_node/topic_board.h -- the newest messages of a session as bytes, for clients that subscribe.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "node/dds/participant.h"
#include "node/dds/raw_reader.h"
#include "node/log_time.h"

namespace cordis::viz {

/// A topic that clients may subscribe to.
struct TopicChannel {
  std::uint32_t id = 0;  ///< from 1; stays with its topic and type in one life of viz_node
  std::string topic;
  std::string type;  ///< one of the contract: its schema is known
};

/// A message as it came.
struct TopicMessage {
  std::uint32_t channel = 0;
  std::uint64_t number = 0;         ///< counts the messages of all channels, from 1
  std::uint64_t index = 0;          ///< counts those of its channel, from 1
  std::uint64_t log_time_nsec = 0;  ///< as in a take
  std::vector<std::uint8_t> bytes;  ///< begins with 4 bytes of encapsulation
};

/// What the threads of DDS write and the thread of the server reads. Memory is bounded, whoever
/// reads: who falls behind by kMaxBytes or kMaxMessages loses the oldest. Topics to which no client
/// subscribes are not read. Any thread.
class TopicBoard {
 public:
  static constexpr std::size_t kMaxBytes = std::size_t{8} << 20;  ///< but one message always fits
  static constexpr std::size_t kMaxMessages = 4096;

  using Messages = std::vector<std::shared_ptr<const TopicMessage>>;
  using Channels = std::vector<TopicChannel>;

  /// Where a subscription begins.
  struct Start {
    std::uint64_t last_index = 0;  ///< index of the newest message of the channel
    Messages kept;                 ///< what the topic keeps for late joiners
  };

  /// Called after each change, from the thread that made it. Set before the first change.
  void on_change(std::function<void()> call) { changed_ = std::move(call); }

  /// Takes what there is to read. Topics of types beyond the contract are left out.
  void set_writers(const std::vector<dds::FoundWriter>& writers,
                   const std::vector<dds::Peer>& peers);

  /// True while a client subscribes to the topic. After a no its reader is removed.
  bool is_wanted(const dds::RawTopic& topic);

  void add(const dds::RawTopic& topic, const dds::RawSample& sample);

  /// The channels that have a writer now; another list after each change. Never null.
  std::shared_ptr<const Channels> channels() const;

  /// Counts a subscriber. @return nothing if no such channel has a writer
  std::optional<Start> subscribe(std::uint32_t channel);
  /// Ends a subscription that began.
  void unsubscribe(std::uint32_t channel);

  /// The oldest message after `number` that `is_wanted` takes; nullptr when there is none. `number`
  /// becomes that of the last message looked at.
  template <class IsWanted>
  std::shared_ptr<const TopicMessage> next_after(std::uint64_t& number, IsWanted is_wanted) const {
    const std::lock_guard lock(mutex_);
    if (messages_.empty()) return nullptr;
    const std::uint64_t first = messages_.front()->number;
    number = std::max(number, first - 1);
    while (number - (first - 1) < messages_.size()) {
      const auto& message = messages_[number - (first - 1)];
      ++number;
      if (is_wanted(*message)) return message;
    }
    return nullptr;
  }

 private:
  using Name = std::pair<std::string, std::string>;  // topic and type
  using Key = std::array<std::uint8_t, 4>;

  struct Channel {
    TopicChannel about;
    bool has_writer = false;
    std::size_t subscribers = 0;
    std::uint64_t messages = 0;
    /// The newest of each writer and key, of a topic that keeps it for late joiners.
    std::map<std::pair<dds::WriterId, Key>, std::shared_ptr<const TopicMessage>> kept;
  };

  struct Writer {
    node::LogTime log_time;
    bool is_of_loop_here = false;
  };

  Channel* find(const dds::RawTopic& topic);  // the lock is held
  Channel* find(std::uint32_t id);            // likewise
  void take_writers(const std::vector<dds::FoundWriter>& writers,
                    const std::vector<dds::Peer>& peers);  // likewise
  void publish_channels();                                 // likewise
  void push(std::shared_ptr<const TopicMessage> message);  // likewise
  void call_changed() const {
    if (changed_) changed_();
  }

  std::function<void()> changed_;
  mutable std::mutex mutex_;
  std::deque<Channel> all_;  // its place + 1 is its id
  std::map<Name, Channel*> by_name_;
  std::map<dds::WriterId, Writer> writers_;
  std::shared_ptr<const Channels> channels_ = std::make_shared<const Channels>();
  std::deque<std::shared_ptr<const TopicMessage>> messages_;  // without a gap in their numbers
  std::size_t bytes_ = 0;
  std::uint64_t last_number_ = 0;
};

}  // namespace cordis::viz
