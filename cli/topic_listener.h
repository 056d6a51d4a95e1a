// cli/topic_listener.h -- reads the topics of a session, whatever their types.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <string>
#include <vector>

#include "cli/session_address.h"
#include "node/dds/participant.h"
#include "node/topic_follower.h"

namespace cordis::cli {

/// A message, and how it came.
struct ReceivedMessage {
  dds::RawTopic topic;
  std::vector<std::uint8_t> bytes;  ///< none where they are not kept
  std::size_t size = 0;             ///< bytes in the message
  std::int64_t source_nsec = 0;
  std::int64_t reception_nsec = 0;
  std::uint64_t sequence = 0;
  std::uint64_t missing = 0;  ///< numbers before it that never came: of a dds::RawSample
  dds::WriterId writer{};
};

/// Collects messages until they are taken; what is not taken in time is left out and counted.
class TopicListener {
 public:
  static constexpr std::size_t kMaxWaitingBytes = std::size_t{32} << 20;

  /// @param session  empty: the whole domain
  /// @param pattern  of topics; empty: all
  /// @param with_bytes  whether the messages themselves are kept
  /// @throws std::runtime_error when DDS refuses
  TopicListener(const SessionAddress& address, const std::string& pattern, bool with_bytes);

  /// Waits for messages, at most so long, and takes all.
  std::deque<ReceivedMessage> take(std::chrono::milliseconds at_most);
  std::uint64_t left_out() const;
  const dds::Participant& participant() const noexcept { return participant_; }

 private:
  void receive(const dds::RawTopic& topic, const dds::RawSample& sample);

  const bool with_bytes_;
  mutable std::mutex mutex_;
  std::condition_variable received_;
  std::deque<ReceivedMessage> waiting_;
  std::size_t waiting_bytes_ = 0;
  std::uint64_t left_out_ = 0;
  dds::Participant participant_;
  node::TopicFollower follower_;
};

}  // namespace cordis::cli
