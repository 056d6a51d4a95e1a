// record_node/recorded_writer.h -- what one writer says on one topic: a channel of the take.
#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <mutex>
#include <utility>

#include "node/dds/participant.h"
#include "node/log_time.h"

namespace cordis::record {

struct RecordedWriter {
  RecordedWriter(dds::RawTopic written, const dds::WriterId& writer, std::uint32_t place)
      : topic(std::move(written)), id(writer), number(place) {}

  const dds::RawTopic topic;
  const dds::WriterId id;
  const std::uint32_t number;  ///< its place in the list, from 0

  std::atomic<std::uint64_t> messages{0};  ///< received messages
  std::atomic<std::uint64_t> bytes{0};     ///< their size
  std::atomic<std::uint64_t> dropped{0};   ///< received messages that found no room or disk
  std::atomic<std::uint64_t> lost{0};      ///< messages that never came, by its numbers
  /// Numbers before the first message that came: written before the reader was found. 0 for a topic
  /// that is kept for late joiners, whose newest message alone is wanted.
  std::atomic<std::uint64_t> before{0};

  std::uint16_t channel = 0;     ///< belongs to the thread of the file; 0: not in it yet
  bool is_of_loop_here = false;  ///< likewise: a force loop of this host writes it
  node::LogTime log_time;        ///< likewise
};

/// The writers so far; any thread adds one or looks at one. None leaves.
class RecordedWriters {
 public:
  RecordedWriter& add(const dds::RawTopic& topic, const dds::WriterId& writer) {
    const std::lock_guard lock(mutex_);
    return writers_.emplace_back(topic, writer, static_cast<std::uint32_t>(writers_.size()));
  }
  RecordedWriter& at(std::uint32_t number) {
    const std::lock_guard lock(mutex_);
    return writers_[number];
  }
  template <class Use>
  void for_each(Use use) {
    const std::lock_guard lock(mutex_);
    for (RecordedWriter& writer : writers_) use(writer);
  }
  template <class Use>
  void for_each(Use use) const {
    const std::lock_guard lock(mutex_);
    for (const RecordedWriter& writer : writers_) use(writer);
  }

 private:
  mutable std::mutex mutex_;
  std::deque<RecordedWriter> writers_;
};

}  // namespace cordis::record
