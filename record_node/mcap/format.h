// record_node/mcap/format.h -- the records of an MCAP file as bytes (https://mcap.dev/spec).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "record_node/mcap/byte_writer.h"
#include "record_node/mcap/records.h"

namespace cordis::mcap {

/// What begins and ends a file.
inline constexpr std::array<unsigned char, 8> kMagic{0x89, 'M', 'C', 'A', 'P', '0', '\r', '\n'};
/// Bytes of an opcode and a length, which begin every record.
inline constexpr std::size_t kRecordHead = 9;
/// Bytes of a footer record.
inline constexpr std::size_t kFooterSize = kRecordHead + 20;

enum class Opcode : std::uint8_t {
  kHeader = 0x01,
  kFooter,
  kSchema,
  kChannel,
  kMessage,
  kChunk,
  kMessageIndex,
  kChunkIndex,
  kAttachment,
  kAttachmentIndex,
  kStatistics,
  kMetadata,
  kMetadataIndex,
  kSummaryOffset,
  kDataEnd,
  /// First of those that readers skip: damaged bytes that `recover` leaves in their place.
  kDamaged = 0x80,
};

/// The record that begins at the front of some bytes.
struct Record {
  Opcode opcode{};
  std::span<const std::byte> content;
  std::size_t size() const noexcept { return kRecordHead + content.size(); }
};

/// The frame of a chunk; its records may be compressed.
struct ChunkView {
  std::uint64_t start_nsec = 0;
  std::uint64_t end_nsec = 0;
  std::uint64_t uncompressed_size = 0;
  std::uint32_t uncompressed_crc = 0;
  std::string compression;
  std::span<const std::byte> records;
};

struct AttachmentView {
  Attachment attachment;
  bool is_intact = true;  ///< its CRC fits, or it has none
};

struct Footer {
  std::uint64_t summary_start = 0;
  std::uint64_t summary_offset_start = 0;
  std::uint32_t summary_crc = 0;
};

/// The first record of some bytes; none when they hold no whole record.
std::optional<Record> first_record(std::span<const std::byte> bytes);

// What a record holds. None when a length in it does not fit; bytes after it are allowed, as MCAP says.
std::optional<Schema> parse_schema(std::span<const std::byte> content);
std::optional<Channel> parse_channel(std::span<const std::byte> content);
std::optional<Message> parse_message(std::span<const std::byte> content);
std::optional<ChunkView> parse_chunk(std::span<const std::byte> content);
std::optional<MessageIndex> parse_message_index(std::span<const std::byte> content);
std::optional<ChunkIndex> parse_chunk_index(std::span<const std::byte> content);
std::optional<AttachmentView> parse_attachment(std::span<const std::byte> content);
std::optional<AttachmentIndex> parse_attachment_index(std::span<const std::byte> content);
std::optional<Statistics> parse_statistics(std::span<const std::byte> content);
std::optional<Metadata> parse_metadata(std::span<const std::byte> content);
std::optional<MetadataIndex> parse_metadata_index(std::span<const std::byte> content);
std::optional<Footer> parse_footer(std::span<const std::byte> content);

// Appends one record.
void append_magic(Bytes& out);
void append_header(Bytes& out, const std::string& library);
void append(Bytes& out, const Schema& schema);
void append(Bytes& out, const Channel& channel);
void append(Bytes& out, const Message& message);
void append(Bytes& out, const ChunkView& chunk);
void append(Bytes& out, const MessageIndex& index);
void append(Bytes& out, const ChunkIndex& index);
void append(Bytes& out, const Attachment& attachment);
void append(Bytes& out, const AttachmentIndex& index);
void append(Bytes& out, const Statistics& statistics);
void append(Bytes& out, const Metadata& metadata);
void append(Bytes& out, const MetadataIndex& index);
void append_data_end(Bytes& out, std::uint32_t data_crc);
void append_summary_offset(Bytes& out, Opcode group, std::uint64_t start, std::uint64_t length);
/// The footer, its CRC filled in by the caller.
void append(Bytes& out, const Footer& footer);

/// The place of an attachment whose record begins at `offset` and takes `length` bytes.
AttachmentIndex index_of(const Attachment& attachment, std::uint64_t offset, std::uint64_t length);

}  // namespace cordis::mcap
