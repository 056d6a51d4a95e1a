// record_node/mcap/stored_summary.cpp
#include "record_node/mcap/stored_summary.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "record_node/mcap/chunk_contents.h"
#include "record_node/mcap/crc32.h"
#include "record_node/mcap/format.h"

namespace cordis::mcap {
namespace {

/// Moves a value that was read to where it belongs. @return false when there is none
template <class T, class Place>
bool take(std::optional<T> value, Place place) {
  if (value) place(std::move(*value));
  return value.has_value();
}

bool read_record(const Record& record, Summary& summary) {
  const auto& content = record.content;
  switch (record.opcode) {
    case Opcode::kSchema:
      return take(parse_schema(content),
                  [&](Schema&& schema) { summary.schemas.emplace(schema.id, std::move(schema)); });
    case Opcode::kChannel:
      return take(parse_channel(content), [&](Channel&& channel) {
        summary.channels.emplace(channel.id, std::move(channel));
      });
    case Opcode::kStatistics:
      return take(parse_statistics(content),
                  [&](Statistics&& statistics) { summary.statistics = std::move(statistics); });
    case Opcode::kChunkIndex:
      return take(parse_chunk_index(content),
                  [&](ChunkIndex&& index) { summary.chunks.push_back(std::move(index)); });
    case Opcode::kAttachmentIndex:
      return take(parse_attachment_index(content), [&](AttachmentIndex&& index) {
        summary.attachments.push_back(std::move(index));
      });
    case Opcode::kMetadataIndex:
      return take(parse_metadata_index(content),
                  [&](MetadataIndex&& index) { summary.metadata.push_back(std::move(index)); });
    default:
      return true;
  }
}

/// How many messages the indexes of the chunks list at most; nothing when a chunk has no index.
std::optional<std::uint64_t> indexed_count(const std::vector<ChunkIndex>& chunks) {
  constexpr std::uint64_t kHead = kRecordHead + 2 + 4;  // of the index of one channel
  std::uint64_t count = 0;
  for (const ChunkIndex& chunk : chunks) {
    const std::uint64_t heads = kHead * chunk.message_index_offsets.size();
    if (heads == 0 || chunk.message_index_length < heads) return std::nullopt;
    count += (chunk.message_index_length - heads) / sizeof(MessageEntry);
  }
  return count;
}

/// True if the summary says where all its messages are. None may stand outside the chunks.
bool is_complete(const Summary& summary) {
  const Statistics& statistics = summary.statistics;
  for (const auto& [id, channel] : summary.channels) {
    if (channel.schema_id != 0 && !summary.schemas.contains(channel.schema_id)) return false;
  }
  const auto indexed = indexed_count(summary.chunks);
  if (indexed && *indexed < statistics.message_count) return false;
  return statistics.chunk_count == summary.chunks.size() &&
         (statistics.message_count == 0 || !summary.chunks.empty()) &&
         statistics.channel_count == summary.channels.size() &&
         statistics.attachment_count == summary.attachments.size() &&
         statistics.metadata_count == summary.metadata.size();
}

/// True if the chunks stand one behind the other, each in a place of its own, before `end`.
bool have_room(std::vector<ChunkIndex> chunks, std::uint64_t end) {
  std::ranges::sort(chunks, {}, &ChunkIndex::offset);
  std::uint64_t place = kMagic.size();  // where the record before ends
  for (const ChunkIndex& chunk : chunks) {
    const bool follows =
        chunk.offset == place || (chunk.offset > place && chunk.offset - place >= kRecordHead);
    if (!follows || chunk.length < kRecordHead) return false;
    if (chunk.offset > end || chunk.length > end - chunk.offset) return false;
    place = chunk.offset + chunk.length;
  }
  return true;
}

}  // namespace

std::string read_stored_summary(std::span<const std::byte> file, Summary& summary) {
  constexpr std::size_t kEnd = kFooterSize + kMagic.size();
  if (file.size() < kMagic.size() + kEnd) return "it ends too early";
  const auto magic = std::as_bytes(std::span(kMagic));
  const auto tail = file.last(kEnd);
  if (!std::equal(magic.begin(), magic.end(), tail.last(magic.size()).begin()))
    return "it was not closed";
  const auto record = first_record(tail);
  const auto footer =
      record && record->opcode == Opcode::kFooter ? parse_footer(record->content) : std::nullopt;
  if (!footer) return "its footer is damaged";
  const std::uint64_t footer_start = file.size() - kEnd;
  if (footer->summary_start == 0) return kNoSummary;
  if (footer->summary_start > footer_start) return "its footer is damaged";
  const auto checked =
      file.subspan(footer->summary_start,
                   file.size() - magic.size() - sizeof footer->summary_crc - footer->summary_start);
  if (footer->summary_crc != 0 && crc32(checked) != footer->summary_crc)
    return "its summary is damaged";
  bool is_readable = true;
  const auto records = file.subspan(footer->summary_start, footer_start - footer->summary_start);
  const bool is_whole = for_each_record(records, [&](const Record& each, std::uint64_t /*offset*/) {
    is_readable = is_readable && read_record(each, summary);
    return is_readable;
  });
  if (!is_whole || !is_readable || !have_room(summary.chunks, footer->summary_start))
    return "its summary is damaged";
  return is_complete(summary) ? "" : kIncompleteSummary;
}

}  // namespace cordis::mcap
