// record_node/mcap/message_cursor.h -- the messages of a take, one after the other, by log time.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "record_node/mcap/chunk_contents.h"
#include "record_node/mcap/records.h"

namespace cordis::mcap {

/// Which messages are wanted.
struct MessageFilter {
  std::vector<std::string> topics;  ///< patterns, as of matches_topic(); empty: all
  std::uint64_t start_nsec = 0;     ///< log times from here on
  std::uint64_t end_nsec = std::numeric_limits<std::uint64_t>::max();  ///< up to here, with it
};

/// Unpacks a chunk when its time comes. Messages of the same time keep the order of the file.
/// Cost of a step: O(log of the chunks that overlap), and a chunk to unpack now and then.
class MessageCursor {
 public:
  /// What a reader hands over: all of it outlives the cursor.
  struct Source {
    std::span<const std::byte> file;
    std::vector<ChunkIndex> chunks;
    std::vector<MessageEntry> loose;   ///< messages outside chunks
    std::set<std::uint16_t> channels;  ///< wanted channels
  };
  MessageCursor(Source source, const MessageFilter& filter);

  /// The next message; its data are valid until the next call. @return false at the end
  bool next(Message& message);
  /// Chunks that could not be read, a sentence for each.
  const std::vector<std::string>& problems() const noexcept { return problems_; }

 private:
  /// A chunk that is open, or the loose messages.
  struct Open {
    std::shared_ptr<ChunkContents> contents;
    std::span<const std::byte> records;
    std::vector<MessageEntry> entries;  // by time, then by offset
    std::size_t next = 0;
    std::size_t rank = 0;  // in the file
    std::uint64_t time() const noexcept { return entries[next].log_time_nsec; }
  };
  struct IsLater {
    bool operator()(const std::unique_ptr<Open>& a, const std::unique_ptr<Open>& b) const noexcept {
      return a->time() != b->time() ? a->time() > b->time() : a->rank > b->rank;
    }
  };
  bool is_wanted(const Message& message) const;
  void open_next_chunk();
  void push(std::unique_ptr<Open> open);

  Source source_;
  MessageFilter filter_;
  std::size_t next_chunk_ = 0;
  std::uint64_t open_bytes_ = 0;
  std::vector<std::unique_ptr<Open>> open_;  // a heap
  std::unique_ptr<Open> current_;            // whose message was given last
  std::vector<std::shared_ptr<ChunkContents>> spare_;
  std::vector<std::string> problems_;
};

}  // namespace cordis::mcap
