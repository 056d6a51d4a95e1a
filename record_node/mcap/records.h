// record_node/mcap/records.h -- what a take holds: schemas, channels, messages, attachments.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace cordis::mcap {

/// The type of the messages of a channel, in words that a program can parse.
struct Schema {
  std::uint16_t id = 0;  ///< from 1; 0 stands for "no schema"
  std::string name;      ///< `cordis::msg::SceneFrame`
  std::string encoding;  ///< `omgidl`
  std::string data;      ///< self-contained text of the type
  bool operator==(const Schema&) const = default;
};

/// One topic with one type.
struct Channel {
  std::uint16_t id = 0;
  std::uint16_t schema_id = 0;  ///< 0: the type is not known
  std::string topic;
  std::string message_encoding;  ///< `cdr`: the payload with its 4 bytes of encapsulation
  std::map<std::string, std::string> metadata;
  bool operator==(const Channel&) const = default;
};

/// One sample. Its data belong to whoever hands it over.
struct Message {
  std::uint16_t channel_id = 0;
  std::uint32_t sequence = 0;           ///< number that its writer gave it
  std::uint64_t log_time_nsec = 0;      ///< when it was received; UNIX epoch
  std::uint64_t publish_time_nsec = 0;  ///< when its writer sent it
  std::span<const std::byte> data;
};

/// A file inside the take.
struct Attachment {
  std::string name;
  std::string media_type;
  std::uint64_t log_time_nsec = 0;
  std::uint64_t create_time_nsec = 0;
  std::span<const std::byte> data;
};

/// Named words about the take.
struct Metadata {
  std::string name;
  std::map<std::string, std::string> values;
  bool operator==(const Metadata&) const = default;
};

/// What a whole take counts.
struct Statistics {
  std::uint64_t message_count = 0;
  std::uint16_t schema_count = 0;
  std::uint32_t channel_count = 0;
  std::uint32_t attachment_count = 0;
  std::uint32_t metadata_count = 0;
  std::uint32_t chunk_count = 0;
  std::uint64_t start_nsec = 0;  ///< smallest log time; 0 without messages
  std::uint64_t end_nsec = 0;    ///< largest log time
  std::map<std::uint16_t, std::uint64_t> channel_message_counts;
  bool operator==(const Statistics&) const = default;
};

/// Where a chunk lies in the file, and what is in it.
struct ChunkIndex {
  std::uint64_t start_nsec = 0;
  std::uint64_t end_nsec = 0;
  std::uint64_t offset = 0;  ///< start of the record in the file
  std::uint64_t length = 0;  ///< length of the record, with its opcode and length
  std::map<std::uint16_t, std::uint64_t> message_index_offsets;  ///< by channel
  std::uint64_t message_index_length = 0;
  std::string compression;
  std::uint64_t compressed_size = 0;
  std::uint64_t uncompressed_size = 0;
  bool operator==(const ChunkIndex&) const = default;
};

/// Where an attachment lies in the file.
struct AttachmentIndex {
  std::uint64_t offset = 0;
  std::uint64_t length = 0;
  std::uint64_t log_time_nsec = 0;
  std::uint64_t create_time_nsec = 0;
  std::uint64_t data_size = 0;
  std::string name;
  std::string media_type;
  bool operator==(const AttachmentIndex&) const = default;
};

/// Where metadata lie in the file.
struct MetadataIndex {
  std::uint64_t offset = 0;
  std::uint64_t length = 0;
  std::string name;
  bool operator==(const MetadataIndex&) const = default;
};

/// Where a message lies in the contents of its chunk.
struct MessageEntry {
  std::uint64_t log_time_nsec = 0;
  std::uint64_t offset = 0;
  bool operator==(const MessageEntry&) const = default;
  bool operator<(const MessageEntry& other) const noexcept {
    return std::pair(log_time_nsec, offset) < std::pair(other.log_time_nsec, other.offset);
  }
};

/// The messages of one channel in one chunk.
struct MessageIndex {
  std::uint16_t channel_id = 0;
  std::vector<MessageEntry> entries;
};

}  // namespace cordis::mcap
