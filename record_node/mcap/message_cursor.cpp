// record_node/mcap/message_cursor.cpp
#include "record_node/mcap/message_cursor.h"

#include <algorithm>
#include <utility>

namespace cordis::mcap {
namespace {

constexpr std::uint64_t kMaxOpenBytes = 4 * kMaxChunkSize;  // of chunks that overlap in time

}  // namespace

MessageCursor::MessageCursor(Source source, const MessageFilter& filter)
    : source_(std::move(source)), filter_(filter) {
  std::erase_if(source_.chunks, [this](const ChunkIndex& chunk) {
    if (chunk.end_nsec < filter_.start_nsec || chunk.start_nsec > filter_.end_nsec) return true;
    const auto& indexed = chunk.message_index_offsets;
    return !indexed.empty() &&
           std::none_of(indexed.begin(), indexed.end(), [this](const auto& channel) {
             return source_.channels.contains(channel.first);
           });
  });
  std::stable_sort(
      source_.chunks.begin(), source_.chunks.end(),
      [](const ChunkIndex& a, const ChunkIndex& b) { return a.start_nsec < b.start_nsec; });

  auto loose = std::make_unique<Open>();
  loose->records = source_.file;
  for (const MessageEntry& entry : source_.loose) {
    const auto record = first_record(source_.file.subspan(entry.offset));
    if (const auto message = parse_message(record->content); is_wanted(*message))
      loose->entries.push_back(entry);
  }
  push(std::move(loose));
}

bool MessageCursor::is_wanted(const Message& message) const {
  return source_.channels.contains(message.channel_id) &&
         message.log_time_nsec >= filter_.start_nsec && message.log_time_nsec <= filter_.end_nsec;
}

void MessageCursor::push(std::unique_ptr<Open> open) {
  if (open->next == open->entries.size()) {
    open_bytes_ -= open->contents ? open->records.size() : 0;
    if (open->contents) spare_.push_back(std::move(open->contents));
    return;
  }
  open_.push_back(std::move(open));
  std::push_heap(open_.begin(), open_.end(), IsLater());
}

void MessageCursor::open_next_chunk() {
  const ChunkIndex& index = source_.chunks[next_chunk_++];
  const auto fail = [&](const std::string& why) {
    problems_.push_back("chunk at byte " + std::to_string(index.offset) + ": " + why);
  };
  if (index.offset >= source_.file.size()) return fail("it lies beyond the file");
  const auto record = first_record(source_.file.subspan(index.offset));
  const auto chunk =
      record && record->opcode == Opcode::kChunk ? parse_chunk(record->content) : std::nullopt;
  if (!chunk) return fail("there is none");
  if (record->size() != index.length) return fail("it has another length");
  if (chunk->uncompressed_size > kMaxOpenBytes - open_bytes_)
    return fail("too many chunks overlap in time");
  auto open = std::make_unique<Open>();
  if (!spare_.empty()) {
    open->contents = std::move(spare_.back());
    spare_.pop_back();
  } else {
    open->contents = std::make_shared<ChunkContents>();
  }
  const std::string problem = open->contents->unpack(*chunk);
  if (!problem.empty()) {
    spare_.push_back(std::move(open->contents));
    return fail(problem);
  }
  open->records = open->contents->records();
  open->rank = index.offset;
  open_bytes_ += open->records.size();
  const bool is_whole =
      for_each_record(open->records, [&](const Record& each, std::uint64_t offset) {
        if (each.opcode != Opcode::kMessage) return true;
        const auto message = parse_message(each.content);
        if (message && is_wanted(*message))
          open->entries.push_back({message->log_time_nsec, offset});
        return true;
      });
  if (!is_whole) fail("it ends in the middle of a record");
  if (!std::is_sorted(open->entries.begin(), open->entries.end()))
    std::sort(open->entries.begin(), open->entries.end());
  push(std::move(open));
}

bool MessageCursor::next(Message& message) {
  if (current_) push(std::move(current_));
  current_.reset();
  while (next_chunk_ < source_.chunks.size() &&
         (open_.empty() || source_.chunks[next_chunk_].start_nsec <= open_.front()->time()))
    open_next_chunk();
  if (open_.empty()) return false;
  std::pop_heap(open_.begin(), open_.end(), IsLater());
  current_ = std::move(open_.back());
  open_.pop_back();
  const std::uint64_t offset = current_->entries[current_->next++].offset;
  const auto record = first_record(current_->records.subspan(offset));
  message = *parse_message(record->content);
  return true;
}

}  // namespace cordis::mcap
