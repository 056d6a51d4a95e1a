// record_node/mcap/summary.cpp
#include "record_node/mcap/summary.h"

#include <algorithm>

#include "record_node/mcap/crc32.h"
#include "record_node/mcap/format.h"

namespace cordis::mcap {
namespace {

/// Where the records of one kind lie.
struct Group {
  Opcode opcode;
  std::uint64_t start;
  std::uint64_t length;
};

}  // namespace

void count(Statistics& statistics, const Message& message) {
  const std::uint64_t time = message.log_time_nsec;
  statistics.start_nsec =
      statistics.message_count == 0 ? time : std::min(statistics.start_nsec, time);
  statistics.end_nsec = std::max(statistics.end_nsec, time);
  ++statistics.message_count;
  ++statistics.channel_message_counts[message.channel_id];
}

void add_messages(Statistics& statistics, const Statistics& more) {
  if (more.message_count == 0) return;
  statistics.start_nsec = statistics.message_count == 0
                              ? more.start_nsec
                              : std::min(statistics.start_nsec, more.start_nsec);
  statistics.end_nsec = std::max(statistics.end_nsec, more.end_nsec);
  statistics.message_count += more.message_count;
  for (const auto& [channel, messages] : more.channel_message_counts)
    statistics.channel_message_counts[channel] += messages;
}

void Summary::count_records() {
  statistics.schema_count = static_cast<std::uint16_t>(schemas.size());
  statistics.channel_count = static_cast<std::uint32_t>(channels.size());
  statistics.attachment_count = static_cast<std::uint32_t>(attachments.size());
  statistics.metadata_count = static_cast<std::uint32_t>(metadata.size());
  statistics.chunk_count = static_cast<std::uint32_t>(chunks.size());
}

void append_end(Bytes& out, Summary& summary, std::uint64_t position, std::uint32_t data_crc) {
  const std::size_t begin = out.size();
  const auto here = [&] { return position + (out.size() - begin); };
  append_data_end(out, data_crc);

  const std::size_t summary_begin = out.size();
  const std::uint64_t summary_start = here();
  summary.count_records();
  std::vector<Group> groups;
  const auto add_group = [&](Opcode opcode, auto append_all) {
    const std::uint64_t start = here();
    append_all();
    if (here() > start) groups.push_back({opcode, start, here() - start});
  };
  add_group(Opcode::kSchema, [&] {
    for (const auto& [id, schema] : summary.schemas) append(out, schema);
  });
  add_group(Opcode::kChannel, [&] {
    for (const auto& [id, channel] : summary.channels) append(out, channel);
  });
  add_group(Opcode::kStatistics, [&] { append(out, summary.statistics); });
  add_group(Opcode::kChunkIndex, [&] {
    for (const ChunkIndex& index : summary.chunks) append(out, index);
  });
  add_group(Opcode::kAttachmentIndex, [&] {
    for (const AttachmentIndex& index : summary.attachments) append(out, index);
  });
  add_group(Opcode::kMetadataIndex, [&] {
    for (const MetadataIndex& index : summary.metadata) append(out, index);
  });

  Footer footer{summary_start, here(), 0};
  for (const Group& group : groups)
    append_summary_offset(out, group.opcode, group.start, group.length);
  append(out, footer);
  const std::size_t crc_place = out.size() - sizeof footer.summary_crc;
  footer.summary_crc = crc32(std::span(out).subspan(summary_begin, crc_place - summary_begin));
  std::memcpy(out.data() + crc_place, &footer.summary_crc, sizeof footer.summary_crc);
  append_magic(out);
}

}  // namespace cordis::mcap
