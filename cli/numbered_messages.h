// cli/numbered_messages.h -- messages of a take by their numbers, in whatever order they came.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>

namespace cordis::cli {

/// Sorts a stream of messages that is nearly in order. A recorder that joins a session receives a
/// new message first, and then what the topic has kept. A clock that is set back changes the order
/// too.
template <class Message>
class NumberedMessages {
 public:
  /// The message with the least number of the next 256; false at the end. Of two messages of one
  /// number the first counts.
  /// @param read    gives the next message in the order in which they came; false at the end
  /// @param number  of a message
  template <class Read, class Number>
  bool next(Read read, Number number, Message& message) {
    while (waiting_.size() < kWaiting && read(message)) waiting_.emplace(number(message), message);
    if (waiting_.empty()) return false;
    message = std::move(waiting_.begin()->second);
    waiting_.erase(waiting_.begin());
    return true;
  }

 private:
  static constexpr std::size_t kWaiting = 256;  // some seconds of inputs, and of frames

  std::map<std::uint64_t, Message> waiting_;
};

}  // namespace cordis::cli
