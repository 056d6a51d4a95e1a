// record_node/mcap/format.cpp
#include "record_node/mcap/format.h"

#include <utility>

#include "record_node/mcap/byte_reader.h"
#include "record_node/mcap/crc32.h"

namespace cordis::mcap {
namespace {

/// Appends the head of a record now and its length at the end of its life.
class RecordWriter : public ByteWriter {
 public:
  RecordWriter(Bytes& out, Opcode opcode) : ByteWriter(out) {
    number(static_cast<std::uint8_t>(opcode));
    begin_ = begin_length<std::uint64_t>();
  }
  RecordWriter(const RecordWriter&) = delete;
  RecordWriter& operator=(const RecordWriter&) = delete;
  ~RecordWriter() { end_length<std::uint64_t>(begin_); }

  std::size_t begin() const noexcept { return begin_; }

 private:
  std::size_t begin_;
};

template <class T>
std::optional<T> unless_failed(const ByteReader& reader, T value) {
  if (reader.failed()) return std::nullopt;
  return value;
}

}  // namespace

std::optional<Record> first_record(std::span<const std::byte> bytes) {
  ByteReader reader(bytes);
  Record record;
  record.opcode = static_cast<Opcode>(reader.number<std::uint8_t>());
  record.content = reader.raw(reader.number<std::uint64_t>());
  return unless_failed(reader, record);
}

std::optional<Schema> parse_schema(std::span<const std::byte> content) {
  ByteReader reader(content);
  Schema schema;
  schema.id = reader.number<std::uint16_t>();
  schema.name = reader.text();
  schema.encoding = reader.text();
  schema.data = reader.text();
  return unless_failed(reader, std::move(schema));
}

std::optional<Channel> parse_channel(std::span<const std::byte> content) {
  ByteReader reader(content);
  Channel channel;
  channel.id = reader.number<std::uint16_t>();
  channel.schema_id = reader.number<std::uint16_t>();
  channel.topic = reader.text();
  channel.message_encoding = reader.text();
  channel.metadata = reader.text_map();
  return unless_failed(reader, std::move(channel));
}

std::optional<Message> parse_message(std::span<const std::byte> content) {
  ByteReader reader(content);
  Message message;
  message.channel_id = reader.number<std::uint16_t>();
  message.sequence = reader.number<std::uint32_t>();
  message.log_time_nsec = reader.number<std::uint64_t>();
  message.publish_time_nsec = reader.number<std::uint64_t>();
  message.data = reader.rest();
  return unless_failed(reader, message);
}

std::optional<ChunkView> parse_chunk(std::span<const std::byte> content) {
  ByteReader reader(content);
  ChunkView chunk;
  chunk.start_nsec = reader.number<std::uint64_t>();
  chunk.end_nsec = reader.number<std::uint64_t>();
  chunk.uncompressed_size = reader.number<std::uint64_t>();
  chunk.uncompressed_crc = reader.number<std::uint32_t>();
  chunk.compression = reader.text();
  chunk.records = reader.raw(reader.number<std::uint64_t>());
  return unless_failed(reader, std::move(chunk));
}

std::optional<MessageIndex> parse_message_index(std::span<const std::byte> content) {
  ByteReader reader(content);
  MessageIndex index;
  index.channel_id = reader.number<std::uint16_t>();
  ByteReader entries(reader.raw(reader.number<std::uint32_t>()));
  index.entries.reserve(entries.rest().size() / sizeof(MessageEntry));
  while (!entries.rest().empty()) {
    MessageEntry& entry = index.entries.emplace_back();
    entry.log_time_nsec = entries.number<std::uint64_t>();
    entry.offset = entries.number<std::uint64_t>();
  }
  if (entries.failed()) return std::nullopt;
  return unless_failed(reader, std::move(index));
}

std::optional<ChunkIndex> parse_chunk_index(std::span<const std::byte> content) {
  ByteReader reader(content);
  ChunkIndex index;
  index.start_nsec = reader.number<std::uint64_t>();
  index.end_nsec = reader.number<std::uint64_t>();
  index.offset = reader.number<std::uint64_t>();
  index.length = reader.number<std::uint64_t>();
  index.message_index_offsets = reader.count_map();
  index.message_index_length = reader.number<std::uint64_t>();
  index.compression = reader.text();
  index.compressed_size = reader.number<std::uint64_t>();
  index.uncompressed_size = reader.number<std::uint64_t>();
  return unless_failed(reader, std::move(index));
}

std::optional<AttachmentView> parse_attachment(std::span<const std::byte> content) {
  ByteReader reader(content);
  AttachmentView view;
  Attachment& attachment = view.attachment;
  attachment.log_time_nsec = reader.number<std::uint64_t>();
  attachment.create_time_nsec = reader.number<std::uint64_t>();
  attachment.name = reader.text();
  attachment.media_type = reader.text();
  attachment.data = reader.raw(reader.number<std::uint64_t>());
  const std::size_t checked = content.size() - reader.rest().size();
  const auto crc = reader.number<std::uint32_t>();
  if (reader.failed()) return std::nullopt;
  view.is_intact = crc == 0 || crc == crc32(content.first(checked));
  return view;
}

std::optional<AttachmentIndex> parse_attachment_index(std::span<const std::byte> content) {
  ByteReader reader(content);
  AttachmentIndex index;
  index.offset = reader.number<std::uint64_t>();
  index.length = reader.number<std::uint64_t>();
  index.log_time_nsec = reader.number<std::uint64_t>();
  index.create_time_nsec = reader.number<std::uint64_t>();
  index.data_size = reader.number<std::uint64_t>();
  index.name = reader.text();
  index.media_type = reader.text();
  return unless_failed(reader, std::move(index));
}

std::optional<Statistics> parse_statistics(std::span<const std::byte> content) {
  ByteReader reader(content);
  Statistics statistics;
  statistics.message_count = reader.number<std::uint64_t>();
  statistics.schema_count = reader.number<std::uint16_t>();
  statistics.channel_count = reader.number<std::uint32_t>();
  statistics.attachment_count = reader.number<std::uint32_t>();
  statistics.metadata_count = reader.number<std::uint32_t>();
  statistics.chunk_count = reader.number<std::uint32_t>();
  statistics.start_nsec = reader.number<std::uint64_t>();
  statistics.end_nsec = reader.number<std::uint64_t>();
  statistics.channel_message_counts = reader.count_map();
  return unless_failed(reader, std::move(statistics));
}

std::optional<Metadata> parse_metadata(std::span<const std::byte> content) {
  ByteReader reader(content);
  Metadata metadata;
  metadata.name = reader.text();
  metadata.values = reader.text_map();
  return unless_failed(reader, std::move(metadata));
}

std::optional<MetadataIndex> parse_metadata_index(std::span<const std::byte> content) {
  ByteReader reader(content);
  MetadataIndex index;
  index.offset = reader.number<std::uint64_t>();
  index.length = reader.number<std::uint64_t>();
  index.name = reader.text();
  return unless_failed(reader, std::move(index));
}

std::optional<Footer> parse_footer(std::span<const std::byte> content) {
  ByteReader reader(content);
  Footer footer;
  footer.summary_start = reader.number<std::uint64_t>();
  footer.summary_offset_start = reader.number<std::uint64_t>();
  footer.summary_crc = reader.number<std::uint32_t>();
  return unless_failed(reader, footer);
}

void append_magic(Bytes& out) {
  ByteWriter(out).raw(std::as_bytes(std::span(kMagic)));
}

void append_header(Bytes& out, const std::string& library) {
  RecordWriter record(out, Opcode::kHeader);
  record.text("");  // no profile: `ros2` would promise types of ROS
  record.text(library);
}

void append(Bytes& out, const Schema& schema) {
  RecordWriter record(out, Opcode::kSchema);
  record.number(schema.id);
  record.text(schema.name);
  record.text(schema.encoding);
  record.text(schema.data);
}

void append(Bytes& out, const Channel& channel) {
  RecordWriter record(out, Opcode::kChannel);
  record.number(channel.id);
  record.number(channel.schema_id);
  record.text(channel.topic);
  record.text(channel.message_encoding);
  record.text_map(channel.metadata);
}

void append(Bytes& out, const Message& message) {
  RecordWriter record(out, Opcode::kMessage);
  record.number(message.channel_id);
  record.number(message.sequence);
  record.number(message.log_time_nsec);
  record.number(message.publish_time_nsec);
  record.raw(message.data);
}

void append(Bytes& out, const ChunkView& chunk) {
  RecordWriter record(out, Opcode::kChunk);
  record.number(chunk.start_nsec);
  record.number(chunk.end_nsec);
  record.number(chunk.uncompressed_size);
  record.number(chunk.uncompressed_crc);
  record.text(chunk.compression);
  record.number(static_cast<std::uint64_t>(chunk.records.size()));
  record.raw(chunk.records);
}

void append(Bytes& out, const MessageIndex& index) {
  RecordWriter record(out, Opcode::kMessageIndex);
  record.number(index.channel_id);
  record.number(static_cast<std::uint32_t>(index.entries.size() * sizeof(MessageEntry)));
  record.raw(std::as_bytes(std::span(index.entries)));
}

void append(Bytes& out, const ChunkIndex& index) {
  RecordWriter record(out, Opcode::kChunkIndex);
  record.number(index.start_nsec);
  record.number(index.end_nsec);
  record.number(index.offset);
  record.number(index.length);
  record.count_map(index.message_index_offsets);
  record.number(index.message_index_length);
  record.text(index.compression);
  record.number(index.compressed_size);
  record.number(index.uncompressed_size);
}

void append(Bytes& out, const Attachment& attachment) {
  RecordWriter record(out, Opcode::kAttachment);
  record.number(attachment.log_time_nsec);
  record.number(attachment.create_time_nsec);
  record.text(attachment.name);
  record.text(attachment.media_type);
  record.number(static_cast<std::uint64_t>(attachment.data.size()));
  record.raw(attachment.data);
  record.number(crc32(std::span(out).subspan(record.begin())));
}

void append(Bytes& out, const AttachmentIndex& index) {
  RecordWriter record(out, Opcode::kAttachmentIndex);
  record.number(index.offset);
  record.number(index.length);
  record.number(index.log_time_nsec);
  record.number(index.create_time_nsec);
  record.number(index.data_size);
  record.text(index.name);
  record.text(index.media_type);
}

void append(Bytes& out, const Statistics& statistics) {
  RecordWriter record(out, Opcode::kStatistics);
  record.number(statistics.message_count);
  record.number(statistics.schema_count);
  record.number(statistics.channel_count);
  record.number(statistics.attachment_count);
  record.number(statistics.metadata_count);
  record.number(statistics.chunk_count);
  record.number(statistics.start_nsec);
  record.number(statistics.end_nsec);
  record.count_map(statistics.channel_message_counts);
}

void append(Bytes& out, const Metadata& metadata) {
  RecordWriter record(out, Opcode::kMetadata);
  record.text(metadata.name);
  record.text_map(metadata.values);
}

void append(Bytes& out, const MetadataIndex& index) {
  RecordWriter record(out, Opcode::kMetadataIndex);
  record.number(index.offset);
  record.number(index.length);
  record.text(index.name);
}

void append_data_end(Bytes& out, std::uint32_t data_crc) {
  RecordWriter record(out, Opcode::kDataEnd);
  record.number(data_crc);
}

void append_summary_offset(Bytes& out, Opcode group, std::uint64_t start, std::uint64_t length) {
  RecordWriter record(out, Opcode::kSummaryOffset);
  record.number(static_cast<std::uint8_t>(group));
  record.number(start);
  record.number(length);
}

void append(Bytes& out, const Footer& footer) {
  RecordWriter record(out, Opcode::kFooter);
  record.number(footer.summary_start);
  record.number(footer.summary_offset_start);
  record.number(footer.summary_crc);
}

AttachmentIndex index_of(const Attachment& attachment, std::uint64_t offset, std::uint64_t length) {
  return {offset,
          length,
          attachment.log_time_nsec,
          attachment.create_time_nsec,
          attachment.data.size(),
          attachment.name,
          attachment.media_type};
}

}  // namespace cordis::mcap
