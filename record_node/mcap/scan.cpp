// record_node/mcap/scan.cpp
#include "record_node/mcap/scan.h"

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

#include "node/assert.h"
#include "record_node/mcap/byte_reader.h"
#include "record_node/mcap/chunk_contents.h"
#include "record_node/mcap/stored_summary.h"

namespace cordis::mcap {
namespace {

constexpr std::size_t kDataEndContent = 4;

std::size_t matching_magic(std::span<const std::byte> bytes) noexcept {
  std::size_t matches = 0;
  for (std::size_t i = 0; i < kMagic.size() && i < bytes.size(); ++i)
    matches += std::to_integer<unsigned char>(bytes[i]) == kMagic[i] ? 1 : 0;
  return matches;
}

/// True if a chunk's lengths fill its record exactly, as those of a damaged one hardly do.
bool is_exact_chunk(std::span<const std::byte> content) {
  const auto chunk = parse_chunk(content);
  if (!chunk) return false;
  const std::size_t head = 8 + 8 + 8 + 4 + 4 + chunk->compression.size() + 8;
  return compression_named(chunk->compression).has_value() &&
         content.size() == head + chunk->records.size();
}

bool is_exact_attachment(std::span<const std::byte> content) {
  constexpr std::size_t kFixed = 8 + 8 + 4 + 4 + 8 + 4;
  const auto length_at = [&content]<class T>(std::size_t place, T) -> std::uint64_t {
    T value{};
    if (place + sizeof value > content.size()) return content.size();
    std::memcpy(&value, content.data() + place, sizeof value);
    return value;
  };
  if (content.size() < kFixed) return false;
  const std::uint64_t name = length_at(16, std::uint32_t{});
  if (name > content.size()) return false;
  const std::uint64_t type = length_at(20 + name, std::uint32_t{});
  if (type > content.size()) return false;
  const std::uint64_t data = length_at(24 + name + type, std::uint64_t{});
  return data <= content.size() && kFixed + name + type + data == content.size();
}

/// True if a value fills its record, without bytes after it that a wrong length would give it.
template <class T>
bool fills(const T& value, std::span<const std::byte> content) {
  Bytes bytes;
  append(bytes, value);
  return bytes.size() == kRecordHead + content.size();
}

bool is_exact_header(std::span<const std::byte> content) {
  ByteReader header(content);
  static_cast<void>(header.text());
  static_cast<void>(header.text());
  return header.is_exact();
}

/// True if both have the same entries in any order.
bool is_same(const MessageIndex& a, const MessageIndex& b) {
  if (a.entries == b.entries) return true;
  std::vector<MessageEntry> first = a.entries;
  std::vector<MessageEntry> second = b.entries;
  std::sort(first.begin(), first.end());
  std::sort(second.begin(), second.end());
  return first == second;
}

Channel lost_channel(std::uint16_t id) {
  return {id, 0, "lost_channel_" + std::to_string(id), "", {}};
}

class Scanner {
 public:
  explicit Scanner(std::span<const std::byte> bytes) : bytes_(bytes) {
    const std::string why = read_stored_summary(bytes, stored_);
    if (!why.empty() && why != kIncompleteSummary) stored_ = {};
    find_known_chunks();
  }

  Scan run();

 private:
  /// What to do after a record.
  enum class Next : std::uint8_t { kGoOn, kDamaged, kEnd };

  Next visit(const Record& record);
  Next visit_chunk(const Record& record);
  Next visit_message_index(const Record& record);
  void add_message_index(ChunkIndex& chunk, std::uint16_t channel, std::uint64_t size) const;
  bool is_moved_index(const MessageIndex& index, std::uint64_t size);
  Next visit_attachment(const Record& record);
  Next visit_message(const Record& record);
  Next visit_end(const Record& record);
  template <class T>
  bool add_description(std::map<std::uint16_t, T>& known, std::optional<T> value,
                       std::span<const std::byte> content);
  bool add_schema(std::span<const std::byte> content);
  bool add_channel(std::span<const std::byte> content);
  bool knows_schema(std::uint16_t id);
  bool knows_channel(std::uint16_t id);
  void name_lost_channel(std::uint16_t id);
  std::string read_chunk(const ChunkView& chunk, Statistics& statistics);
  void end_chunk();
  void return_unused();
  void find_known_chunks();
  bool is_known_chunk(std::uint64_t offset) const;
  bool is_before_known_chunk(std::uint64_t offset) const;
  bool covers_known_chunk(std::uint64_t offset, const Record& record) const;
  bool is_plausible(std::uint64_t offset) const;
  bool begins_data(std::uint64_t offset) const;
  bool ends_data(std::uint64_t offset) const;
  std::uint64_t next_record(std::uint64_t offset) const;
  void damage(std::uint64_t length, std::string what, bool is_loss = true) {
    scan_.damages.push_back({position_, length, std::move(what), is_loss});
  }

  std::span<const std::byte> bytes_;
  Summary stored_;                               // of the file, where it is sound
  std::vector<std::uint16_t> borrowed_schemas_;  // of stored_, as no record of the data has them
  std::vector<std::uint16_t> borrowed_channels_;
  std::set<std::uint16_t> lost_channels_;    // named by name_lost_channel()
  std::vector<std::uint64_t> known_chunks_;  // of stored_, their places in order
  std::uint64_t position_ = 0;
  Scan scan_;
  ChunkContents contents_;
  bool is_chunk_open_ = false;  // its records are read
  using Places = std::map<std::uint16_t, std::vector<Damage>>;
  Places schemas_;  // outside chunks: where they are, if they are wrong; more than once if repeated
  Places channels_;
  bool is_in_chunk_ = false;  // the message indexes of the last chunk may follow
  std::map<std::uint16_t, MessageIndex> entries_;  // of the last chunk
};

/// Takes a schema or a channel. That of a chunk, which a CRC protects, replaces another of its number.
template <class T>
bool Scanner::add_description(std::map<std::uint16_t, T>& known, std::optional<T> value,
                              std::span<const std::byte> content) {
  if (!value || !fills(*value, content)) return false;
  const auto [found, is_new] = known.try_emplace(value->id, *value);
  Places& places = std::is_same_v<T, Schema> ? schemas_ : channels_;
  const std::uint16_t id = value->id;
  const bool is_same = found->second == *value;
  if (!is_chunk_open_ && (is_new || (is_same && places.contains(id)))) {
    places[id].push_back(
        {position_, kRecordHead + content.size(), "it is not what a chunk repeats", false});
  }
  if (is_new || is_same) return true;
  if (!is_chunk_open_ || !places.contains(id)) return false;
  found->second = std::move(*value);
  std::ranges::move(places.extract(id).mapped(), std::back_inserter(scan_.damages));
  return true;
}

bool Scanner::add_schema(std::span<const std::byte> content) {
  auto schema = parse_schema(content);
  if (schema && schema->id == 0) return false;
  return add_description(scan_.summary.schemas, std::move(schema), content);
}

bool Scanner::add_channel(std::span<const std::byte> content) {
  auto channel = parse_channel(content);
  if (channel && channel->schema_id != 0 && !knows_schema(channel->schema_id)) return false;
  if (channel && fills(*channel, content) && lost_channels_.erase(channel->id) != 0) {
    scan_.summary.channels.erase(channel->id);
    std::erase(borrowed_channels_, channel->id);
  }
  return add_description(scan_.summary.channels, std::move(channel), content);
}

/// True if a schema was found. One whose record is damaged is that of the summary of the file.
bool Scanner::knows_schema(std::uint16_t id) {
  if (scan_.summary.schemas.contains(id)) return true;
  const auto stored = stored_.schemas.find(id);
  if (stored == stored_.schemas.end()) return false;
  scan_.summary.schemas.insert(*stored);
  borrowed_schemas_.push_back(id);
  return true;
}

/// As knows_schema(), of a channel.
bool Scanner::knows_channel(std::uint16_t id) {
  if (scan_.summary.channels.contains(id)) return true;
  const auto stored = stored_.channels.find(id);
  if (stored == stored_.channels.end()) return false;
  const std::uint16_t schema = stored->second.schema_id;
  if (schema != 0 && !knows_schema(schema)) return false;
  scan_.summary.channels.insert(*stored);
  borrowed_channels_.push_back(id);
  return true;
}

/// Gives a channel a topic of its number. Its description is lost, but not its messages.
void Scanner::name_lost_channel(std::uint16_t id) {
  if (!scan_.summary.channels.try_emplace(id, lost_channel(id)).second) return;
  lost_channels_.insert(id);
  borrowed_channels_.push_back(id);
}

/// Drops what was taken from the summary of the file for messages that could not be kept.
void Scanner::return_unused() {
  Summary& summary = scan_.summary;
  for (const std::uint16_t id : borrowed_channels_) {
    if (!summary.statistics.channel_message_counts.contains(id)) summary.channels.erase(id);
  }
  for (const std::uint16_t id : borrowed_schemas_) {
    const bool is_used = std::ranges::any_of(
        summary.channels, [id](const auto& channel) { return channel.second.schema_id == id; });
    if (!is_used) summary.schemas.erase(id);
  }
}

/// Counts the messages of a chunk and collects their index. @return what is wrong
std::string Scanner::read_chunk(const ChunkView& chunk, Statistics& statistics) {
  std::string problem = contents_.unpack(chunk);
  if (!problem.empty()) return problem;
  for (auto& [channel, index] : entries_) index.entries.clear();
  MessageIndex* last = nullptr;  // of the channel before: mostly the same
  const bool is_whole =
      for_each_record(contents_.records(), [&](const Record& record, std::uint64_t offset) {
        if (record.opcode == Opcode::kSchema && !add_schema(record.content))
          problem = "a schema in it is wrong";
        if (record.opcode == Opcode::kChannel && !add_channel(record.content))
          problem = "a channel in it is wrong";
        if (record.opcode != Opcode::kMessage) return problem.empty();
        const auto message = parse_message(record.content);
        if (!message) {
          problem = "a message in it is too short";
        } else if (last == nullptr || last->channel_id != message->channel_id) {
          if (!knows_channel(message->channel_id)) name_lost_channel(message->channel_id);
          last = &entries_[message->channel_id];
          last->channel_id = message->channel_id;
        }
        if (!problem.empty()) return false;
        last->entries.push_back({message->log_time_nsec, offset});
        count(statistics, *message);
        return true;
      });
  if (problem.empty() && !is_whole) return "it ends in the middle of a record";
  return problem;
}

Scanner::Next Scanner::visit_chunk(const Record& record) {
  end_chunk();
  if (!is_exact_chunk(record.content) && !is_known_chunk(position_)) return Next::kDamaged;
  const auto chunk = parse_chunk(record.content);
  Statistics statistics;
  is_chunk_open_ = true;
  const std::string problem = read_chunk(*chunk, statistics);
  is_chunk_open_ = false;
  if (!problem.empty()) {
    damage(record.size(), "chunk: " + problem);
    return Next::kGoOn;
  }
  if (statistics.message_count != 0 &&
      (chunk->start_nsec != statistics.start_nsec || chunk->end_nsec != statistics.end_nsec))
    scan_.wrong_times.push_back(scan_.summary.chunks.size());
  ChunkIndex& index = scan_.summary.chunks.emplace_back();
  index.start_nsec = statistics.start_nsec;
  index.end_nsec = statistics.end_nsec;
  index.offset = position_;
  index.length = record.size();
  index.compression = chunk->compression;
  index.compressed_size = chunk->records.size();
  index.uncompressed_size = chunk->uncompressed_size;
  add_messages(scan_.summary.statistics, statistics);
  is_in_chunk_ = true;
  return Next::kGoOn;
}

Scanner::Next Scanner::visit_message_index(const Record& record) {
  auto index = parse_message_index(record.content);
  constexpr std::size_t kHead = 2 + 4;
  const bool is_exact =
      index && record.content.size() == kHead + sizeof(MessageEntry) * index->entries.size();
  if (!is_exact) return Next::kDamaged;
  if (index->entries.empty()) return Next::kGoOn;
  const auto own = entries_.find(index->channel_id);
  const bool is_own = is_in_chunk_ && own != entries_.end() && is_same(own->second, *index);
  // One that the last chunk has already may be that of an earlier chunk with the same messages.
  const bool is_first =
      is_own && !scan_.summary.chunks.back().message_index_offsets.contains(index->channel_id);
  if (!is_first && is_moved_index(*index, record.size())) return Next::kGoOn;
  if (is_own) {
    add_message_index(scan_.summary.chunks.back(), index->channel_id, record.size());
  } else {
    damage(record.size(), "message index: it does not fit its chunk", /*is_loss=*/false);
  }
  return Next::kGoOn;
}

/// The newest index of a channel counts. One that is written twice counts once in the length: that
/// says how many messages the chunk has.
void Scanner::add_message_index(ChunkIndex& chunk, std::uint16_t channel,
                                std::uint64_t size) const {
  const bool is_new = chunk.message_index_offsets.insert_or_assign(channel, position_).second;
  if (is_new) chunk.message_index_length += size;
}

/// True if the index is that of an earlier chunk: `recover` writes it after the last one.
bool Scanner::is_moved_index(const MessageIndex& index, std::uint64_t size) {
  for (MissingIndex& missing : scan_.missing) {
    const auto entry = missing.entries.find(index.channel_id);
    if (entry == missing.entries.end() || !is_same(entry->second, index)) continue;
    add_message_index(scan_.summary.chunks[missing.chunk], index.channel_id, size);
    missing.entries.erase(entry);
    return true;
  }
  return false;
}

/// Looks whether the chunk that ends here had an index of all its channels.
void Scanner::end_chunk() {
  if (!std::exchange(is_in_chunk_, false)) return;
  ChunkIndex& chunk = scan_.summary.chunks.back();
  std::erase_if(entries_, [&chunk](const auto& entry) {
    return entry.second.entries.empty() || chunk.message_index_offsets.contains(entry.first);
  });
  if (entries_.empty()) return;
  scan_.missing.push_back({scan_.summary.chunks.size() - 1, std::exchange(entries_, {})});
}

Scanner::Next Scanner::visit_attachment(const Record& record) {
  if (!is_exact_attachment(record.content)) return Next::kDamaged;
  const auto view = parse_attachment(record.content);
  if (!view->is_intact) {
    damage(record.size(), "attachment " + view->attachment.name + ": its CRC does not fit");
    return Next::kGoOn;
  }
  scan_.summary.attachments.push_back(index_of(view->attachment, position_, record.size()));
  return Next::kGoOn;
}

Scanner::Next Scanner::visit_message(const Record& record) {
  const auto message = parse_message(record.content);
  if (!message || !knows_channel(message->channel_id)) return Next::kDamaged;
  scan_.loose.push_back({message->log_time_nsec, position_});
  count(scan_.summary.statistics, *message);
  return Next::kGoOn;
}

/// A record that stands after the data.
Scanner::Next Scanner::visit_end(const Record& record) {
  bool is_sound = false;
  if (record.opcode == Opcode::kDataEnd) is_sound = record.content.size() == kDataEndContent;
  if (record.opcode == Opcode::kFooter)
    is_sound = position_ + record.size() + kMagic.size() == bytes_.size();
  if (record.opcode == Opcode::kStatistics) is_sound = parse_statistics(record.content).has_value();
  if (!is_sound || is_before_known_chunk(position_)) return Next::kDamaged;
  if (record.opcode == Opcode::kDataEnd) {
    scan_.has_data_end = true;
    std::memcpy(&scan_.stored_data_crc, record.content.data(), kDataEndContent);
  }
  return Next::kEnd;
}

Scanner::Next Scanner::visit(const Record& record) {
  switch (record.opcode) {
    case Opcode::kChunk:
      return visit_chunk(record);
    case Opcode::kMessageIndex:
      return visit_message_index(record);
    case Opcode::kHeader:
      return position_ == kMagic.size() && is_exact_header(record.content) ? Next::kGoOn
                                                                           : Next::kDamaged;
    case Opcode::kSchema:
      return add_schema(record.content) ? Next::kGoOn : Next::kDamaged;
    case Opcode::kChannel:
      return add_channel(record.content) ? Next::kGoOn : Next::kDamaged;
    case Opcode::kMessage:
      return visit_message(record);
    case Opcode::kAttachment:
      return visit_attachment(record);
    case Opcode::kMetadata: {
      const auto metadata = parse_metadata(record.content);
      if (!metadata || !fills(*metadata, record.content)) return Next::kDamaged;
      scan_.summary.metadata.push_back({position_, record.size(), metadata->name});
      return Next::kGoOn;
    }
    case Opcode::kDataEnd:
    case Opcode::kFooter:
    case Opcode::kStatistics:
      return visit_end(record);
    default:
      if (record.opcode == Opcode::kDamaged) return Next::kGoOn;
      // Records of others are skipped, but not a chunk whose opcode is wrong.
      return record.opcode > Opcode::kDamaged && !is_exact_chunk(record.content) &&
                     !is_exact_attachment(record.content)
                 ? Next::kGoOn
                 : Next::kDamaged;
  }
}

/// The chunks that the summary of the file knows and that are where it says.
void Scanner::find_known_chunks() {
  for (const ChunkIndex& index : stored_.chunks) {
    const auto record = first_record(bytes_.subspan(index.offset));
    if (record && record->opcode == Opcode::kChunk && record->size() == index.length &&
        parse_chunk(record->content))
      known_chunks_.push_back(index.offset);
  }
  std::ranges::sort(known_chunks_);
}

bool Scanner::is_known_chunk(std::uint64_t offset) const {
  return std::ranges::binary_search(known_chunks_, offset);
}

/// True if a known chunk begins after this place.
bool Scanner::is_before_known_chunk(std::uint64_t offset) const {
  return !known_chunks_.empty() && known_chunks_.back() > offset;
}

/// True if a known chunk begins inside the record, or so soon after it that no record has room between.
bool Scanner::covers_known_chunk(std::uint64_t offset, const Record& record) const {
  const std::uint64_t end = offset + record.size();
  const auto next = std::ranges::upper_bound(known_chunks_, offset);
  return next != known_chunks_.end() && *next != end && *next < end + kRecordHead;
}

bool Scanner::is_plausible(std::uint64_t offset) const {
  if (offset == bytes_.size()) return false;
  const auto record = first_record(bytes_.subspan(offset));
  if (!record || record->opcode < Opcode::kHeader) return false;
  return record->opcode <= Opcode::kDataEnd || record->opcode == Opcode::kDamaged;
}

/// True if a chunk or an attachment begins here, as the summary says or its lengths show.
bool Scanner::begins_data(std::uint64_t offset) const {
  if (is_known_chunk(offset)) return true;
  const auto opcode = static_cast<Opcode>(bytes_[offset]);
  if (opcode != Opcode::kChunk && opcode != Opcode::kAttachment) return false;
  const auto record = first_record(bytes_.subspan(offset));
  if (!record || covers_known_chunk(offset, *record)) return false;
  return opcode == Opcode::kChunk ? is_exact_chunk(record->content)
                                  : is_exact_attachment(record->content);
}

/// True if the data end here.
bool Scanner::ends_data(std::uint64_t offset) const {
  if (static_cast<Opcode>(bytes_[offset]) != Opcode::kDataEnd) return false;
  const auto record = first_record(bytes_.subspan(offset));
  return record && record->content.size() == kDataEndContent && !is_before_known_chunk(offset) &&
         is_plausible(offset + record->size());
}

/// Where reading can go on after a damaged record; the size of the file when nowhere.
std::uint64_t Scanner::next_record(std::uint64_t offset) const {
  const auto record = first_record(bytes_.subspan(offset));
  const bool has_end =
      record && is_plausible(offset + record->size()) && !covers_known_chunk(offset, *record);
  const std::uint64_t end = has_end ? offset + record->size() : bytes_.size();
  // The length of a record that may hold data is right when its parts fill it.
  if (has_end && (is_exact_chunk(record->content) || is_exact_attachment(record->content)))
    return end;
  for (std::uint64_t next = offset + kRecordHead; next < end; ++next) {
    if (begins_data(next) || (!has_end && ends_data(next))) return next;
  }
  return end;
}

Scan Scanner::run() {
  if (matching_magic(bytes_) != kMagic.size()) damage(kMagic.size(), "magic at the start", false);
  position_ = kMagic.size();
  while (position_ < bytes_.size()) {
    const auto record = first_record(bytes_.subspan(position_));
    const bool is_possible = record && !covers_known_chunk(position_, *record);
    const Next next = is_possible ? visit(*record) : Next::kDamaged;
    if (next == Next::kEnd) break;
    if (next == Next::kDamaged) {
      const std::uint64_t end = next_record(position_);
      const bool is_tail = end == bytes_.size();
      const auto opcode = static_cast<Opcode>(bytes_[position_]);
      const bool is_loss = (opcode != Opcode::kMessageIndex && opcode != Opcode::kDataEnd) ||
                           (record && is_exact_chunk(record->content));
      damage(end - position_,
             is_tail ? "the file ends in the middle of a record" : "no record can be read",
             is_loss);
      if (is_tail) break;
      position_ = end;
      continue;
    }
    position_ += record->size();
  }
  end_chunk();
  std::erase_if(scan_.missing, [](const MissingIndex& missing) { return missing.entries.empty(); });
  std::sort(scan_.damages.begin(), scan_.damages.end(),
            [](const Damage& a, const Damage& b) { return a.offset < b.offset; });
  scan_.data_end = position_;
  return_unused();
  scan_.summary.count_records();
  return std::move(scan_);
}

}  // namespace

bool Scan::has_loss() const noexcept {
  return std::any_of(damages.begin(), damages.end(),
                     [](const Damage& damage) { return damage.is_loss; });
}

bool is_mcap(std::span<const std::byte> bytes) noexcept {
  return bytes.size() >= kMagic.size() && matching_magic(bytes) + 1 >= kMagic.size();
}

Scan scan(std::span<const std::byte> bytes) {
  CORDIS_ASSERT(is_mcap(bytes));
  return Scanner(bytes).run();
}

}  // namespace cordis::mcap
