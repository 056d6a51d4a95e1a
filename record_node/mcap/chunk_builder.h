// record_node/mcap/chunk_builder.h -- the open chunk of a take: messages and their index.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "record_node/mcap/compression.h"
#include "record_node/mcap/records.h"

namespace cordis::mcap {

/// Collects the records of one chunk after the other.
class ChunkBuilder {
 public:
  explicit ChunkBuilder(Compression compression) : compressor_(compression) {}

  void add(const Schema& schema);
  void add(const Channel& channel);
  void add(const Message& message);

  bool is_empty() const noexcept { return message_count_ == 0; }
  std::uint64_t message_count() const noexcept { return message_count_; }
  /// Size of its records, unpacked [bytes].
  std::size_t size() const noexcept { return records_.size(); }

  /// Appends the chunk and its message indexes to `out`, the offsets of `index` as if `out` began at
  /// `position` of the file. @return false when packing fails
  bool finish(Bytes& out, std::uint64_t position, ChunkIndex& index);
  /// Begins the next chunk.
  void clear() noexcept;

 private:
  Compressor compressor_;
  Bytes records_;
  Bytes packed_;
  std::map<std::uint16_t, MessageIndex> entries_;
  std::uint64_t message_count_ = 0;
  std::uint64_t start_nsec_ = 0;
  std::uint64_t end_nsec_ = 0;
};

/// Appends the indexes of a chunk that are not empty, and notes in `index` where they are.
void append_message_indexes(Bytes& out, std::uint64_t position,
                            const std::map<std::uint16_t, MessageIndex>& entries,
                            ChunkIndex& index);

}  // namespace cordis::mcap
