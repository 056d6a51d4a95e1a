// record_node/mcap/summary.h -- the end of a take: what it holds, and where.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "record_node/mcap/byte_writer.h"
#include "record_node/mcap/records.h"

namespace cordis::mcap {

/// Everything that a reader needs before it reads messages.
struct Summary {
  std::map<std::uint16_t, Schema> schemas;
  std::map<std::uint16_t, Channel> channels;
  Statistics statistics;
  std::vector<ChunkIndex> chunks;  ///< in the order of the file
  std::vector<AttachmentIndex> attachments;
  std::vector<MetadataIndex> metadata;

  /// Brings the counts of the statistics, but those of messages, in line with the lists.
  void count_records();
};

/// Counts one message.
void count(Statistics& statistics, const Message& message);
/// Adds the messages that `more` counts.
void add_messages(Statistics& statistics, const Statistics& more);

/// Appends the end of a file that has `position` bytes of this CRC before it: the end of the data,
/// the summary, its offsets, the footer and the magic.
void append_end(Bytes& out, Summary& summary, std::uint64_t position, std::uint32_t data_crc);

}  // namespace cordis::mcap
