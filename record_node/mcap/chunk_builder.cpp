// record_node/mcap/chunk_builder.cpp
#include "record_node/mcap/chunk_builder.h"

#include <algorithm>

#include "record_node/mcap/crc32.h"
#include "record_node/mcap/format.h"

namespace cordis::mcap {

void ChunkBuilder::add(const Schema& schema) {
  append(records_, schema);
}

void ChunkBuilder::add(const Channel& channel) {
  append(records_, channel);
}

void ChunkBuilder::add(const Message& message) {
  const std::uint64_t time = message.log_time_nsec;
  MessageIndex& index = entries_[message.channel_id];
  index.channel_id = message.channel_id;
  index.entries.push_back({time, records_.size()});
  append(records_, message);
  start_nsec_ = is_empty() ? time : std::min(start_nsec_, time);
  end_nsec_ = is_empty() ? time : std::max(end_nsec_, time);
  ++message_count_;
}

bool ChunkBuilder::finish(Bytes& out, std::uint64_t position, ChunkIndex& index) {
  const bool is_packed = compressor_.compression() != Compression::kNone;
  if (is_packed && !compressor_.compress(records_, packed_)) return false;
  ChunkView chunk;
  chunk.start_nsec = start_nsec_;
  chunk.end_nsec = end_nsec_;
  chunk.uncompressed_size = records_.size();
  chunk.uncompressed_crc = crc32(records_);
  chunk.compression = name_of(compressor_.compression());
  chunk.records = is_packed ? packed_ : records_;

  const std::size_t begin = out.size();
  append(out, chunk);
  index = {};
  index.start_nsec = start_nsec_;
  index.end_nsec = end_nsec_;
  index.offset = position + begin;
  index.length = out.size() - begin;
  index.compression = chunk.compression;
  index.compressed_size = chunk.records.size();
  index.uncompressed_size = chunk.uncompressed_size;
  append_message_indexes(out, position, entries_, index);
  return true;
}

void ChunkBuilder::clear() noexcept {
  records_.clear();
  for (auto& [channel, index] : entries_) index.entries.clear();  // they keep their memory
  message_count_ = 0;
}

void append_message_indexes(Bytes& out, std::uint64_t position,
                            const std::map<std::uint16_t, MessageIndex>& entries,
                            ChunkIndex& index) {
  for (const auto& [channel, messages] : entries) {
    if (messages.entries.empty()) continue;
    const std::size_t begin = out.size();
    const bool is_new =
        index.message_index_offsets.insert_or_assign(channel, position + begin).second;
    append(out, messages);
    if (is_new) index.message_index_length += out.size() - begin;
  }
}

}  // namespace cordis::mcap
