// record_node/mcap/writer.cpp
#include "record_node/mcap/writer.h"

#include <cerrno>
#include <exception>
#include <limits>

#include <fcntl.h>
#include <stdio.h>
#include <unistd.h>

#include "record_node/mcap/file_error.h"
#include "record_node/mcap/format.h"

namespace cordis::mcap {
namespace {

/// Upper bound of the end of a file, without what it repeats [bytes].
constexpr std::uint64_t kFixedEnd = 1024;
constexpr std::uint64_t kCountSize = 10;   // of one channel in a map of counts [bytes]
constexpr std::uint64_t kIndexSize = 128;  // of a chunk index without its channels, at least
                                           // [bytes]
constexpr std::size_t kMaxRecords = std::numeric_limits<std::uint16_t>::max();

}  // namespace

std::filesystem::path part_of(const std::filesystem::path& path) {
  return path.string() + ".part";
}

Writer::Writer(const std::filesystem::path& path, const WriterConfig& config)
    : path_(path), part_(part_of(path)), config_(config), chunk_(config.compression) {
  std::error_code ignored;
  if (std::filesystem::exists(path, ignored))
    throw FileError(path.string() + " exists: remove it or take another name");
  if (std::filesystem::exists(part_, ignored))
    throw FileError(part_.string() +
                    " is an unfinished take: keep it with `cordis recover`, or remove it");
  file_.create(part_);
  append_magic(buffer_);
  append_header(buffer_, config.library);
  if (put(config_.reserve_bytes) != WriteStatus::kOk) {
    const std::string why = file_.problem();
    std::filesystem::remove(part_, ignored);
    throw FileError(path.string() + " cannot be written: " + why);
  }
}

Writer::~Writer() {
  static_cast<void>(close());
}

WriteStatus Writer::note(WriteStatus status) noexcept {
  if (status == WriteStatus::kOk || status == WriteStatus::kRefused) return status;
  if (status > status_) {
    status_ = status;
    try {
      problem_ =
          (status == WriteStatus::kFull ? "there is no room for more of " : "cannot write ") +
          path_.string() + ": " + file_.problem();
    } catch (const std::exception&) {  // no memory for words
    }
  }
  return status;
}

template <class Action>
WriteStatus Writer::guarded(Action action) noexcept {
  if (!file_.is_open() || status_ == WriteStatus::kFailed) return WriteStatus::kFailed;
  try {
    return note(action());
  } catch (const std::exception&) {  // no memory
    return note(WriteStatus::kFailed);
  }
}

/// Writes the buffer, if the end of the file and `spare` bytes still fit after it.
WriteStatus Writer::put(std::uint64_t spare) {
  WriteStatus status = file_.reserve(buffer_.size() + end_size() + spare);
  if (status == WriteStatus::kOk) status = file_.append(buffer_);
  buffer_.clear();
  return status;
}

std::uint64_t Writer::end_size() const noexcept {
  return kFixedEnd + repeated_size_ + kCountSize * summary_.channels.size();
}

std::uint16_t Writer::add_schema(const Schema& schema) noexcept {
  std::uint16_t id = 0;
  const WriteStatus status = guarded([&] {
    if (summary_.schemas.size() >= kMaxRecords) return WriteStatus::kRefused;
    Schema own = schema;
    own.id = static_cast<std::uint16_t>(summary_.schemas.size() + 1);
    append(buffer_, own);
    const std::uint64_t size = buffer_.size();
    const WriteStatus result = put(size + config_.reserve_bytes);
    if (result != WriteStatus::kOk) return result;
    repeated_size_ += size;
    id = own.id;
    summary_.schemas.emplace(id, std::move(own));
    return result;
  });
  return status == WriteStatus::kOk ? id : std::uint16_t{0};
}

std::uint16_t Writer::add_channel(const Channel& channel) noexcept {
  std::uint16_t id = 0;
  const WriteStatus status = guarded([&] {
    if (summary_.channels.size() >= kMaxRecords) return WriteStatus::kRefused;
    if (channel.schema_id != 0 && !summary_.schemas.contains(channel.schema_id))
      return WriteStatus::kRefused;
    Channel own = channel;
    own.id = static_cast<std::uint16_t>(summary_.channels.size() + 1);
    append(buffer_, own);
    const std::uint64_t size = buffer_.size();
    const WriteStatus result = put(size + kCountSize + config_.reserve_bytes);
    if (result != WriteStatus::kOk) return result;
    repeated_size_ += size;
    id = own.id;
    summary_.channels.emplace(id, std::move(own));
    return result;
  });
  return status == WriteStatus::kOk ? id : std::uint16_t{0};
}

WriteStatus Writer::add_to_chunk(const Message& message) {
  const auto channel = summary_.channels.find(message.channel_id);
  if (channel == summary_.channels.end()) return WriteStatus::kRefused;
  if (message.data.size() > kMaxChunkSize / 2) return WriteStatus::kRefused;
  if (chunk_.is_empty()) chunk_begin_nsec_ = message.log_time_nsec;
  if (chunked_channels_.insert(message.channel_id).second) {
    const std::uint16_t schema = channel->second.schema_id;
    if (schema != 0 && chunked_schemas_.insert(schema).second)
      chunk_.add(summary_.schemas.at(schema));
    chunk_.add(channel->second);
  }
  chunk_.add(message);
  count(chunk_statistics_, message);
  return chunk_.size() >= config_.chunk_bytes ? close_chunk() : WriteStatus::kOk;
}

WriteStatus Writer::write(const Message& message) noexcept {
  if (status_ == WriteStatus::kFull) return status_;
  return guarded([&] { return add_to_chunk(message); });
}

WriteStatus Writer::close_chunk() {
  if (chunk_.is_empty()) return WriteStatus::kOk;
  ChunkIndex index;
  const bool is_packed = chunk_.finish(buffer_, file_.position(), index);
  const std::uint64_t index_size = kIndexSize + kCountSize * index.message_index_offsets.size();
  const WriteStatus status =
      is_packed ? put(index_size + config_.reserve_bytes) : WriteStatus::kFailed;
  if (status == WriteStatus::kOk) {
    repeated_size_ += index_size;
    summary_.chunks.push_back(std::move(index));
    add_messages(summary_.statistics, chunk_statistics_);
    summary_.count_records();
  } else {
    lost_count_ += chunk_.message_count();
  }
  chunk_.clear();
  chunk_statistics_ = {};
  return status == WriteStatus::kOk && config_.sync ? file_.sync() : status;
}

WriteStatus Writer::flush() noexcept {
  return guarded([&] { return close_chunk(); });
}

WriteStatus Writer::close_chunk_if_older(std::uint64_t now_nsec) noexcept {
  const bool is_old = !chunk_.is_empty() && now_nsec >= chunk_begin_nsec_ &&
                      now_nsec - chunk_begin_nsec_ >= config_.chunk_nsec;
  return is_old ? flush() : status_;
}

WriteStatus Writer::attach(const Attachment& attachment) noexcept {
  return guarded([&] {
    append(buffer_, attachment);
    const std::uint64_t size = buffer_.size();
    const AttachmentIndex index = index_of(attachment, file_.position(), size);
    const std::uint64_t index_size =
        kIndexSize + attachment.name.size() + attachment.media_type.size();
    const WriteStatus status = put(index_size + config_.reserve_bytes);
    if (status != WriteStatus::kOk) return status;
    repeated_size_ += index_size;
    summary_.attachments.push_back(index);
    summary_.count_records();
    return status;
  });
}

WriteStatus Writer::add_metadata(const Metadata& metadata) noexcept {
  return guarded([&] {
    append(buffer_, metadata);
    const MetadataIndex index{file_.position(), buffer_.size(), metadata.name};
    const std::uint64_t index_size = kIndexSize + metadata.name.size();
    const WriteStatus status = put(index_size);  // the last words may use the reserve
    if (status != WriteStatus::kOk) return status;
    repeated_size_ += index_size;
    summary_.metadata.push_back(index);
    summary_.count_records();
    return status;
  });
}

WriteStatus Writer::finish() {
  static_cast<void>(note(close_chunk()));
  if (status_ == WriteStatus::kFailed) return status_;
  append_end(buffer_, summary_, file_.position(), file_.crc());
  WriteStatus status = file_.append(buffer_);
  buffer_.clear();
  if (status == WriteStatus::kOk && config_.sync) status = file_.sync();
  return status;
}

WriteStatus Writer::close() noexcept {
  if (!file_.is_open()) return status_;
  // An end that found no room is a failure: the take is not whole.
  if (guarded([&] {
        return finish() == WriteStatus::kOk ? WriteStatus::kOk : WriteStatus::kFailed;
      }) != WriteStatus::kOk) {
    static_cast<void>(file_.close());
    return status_;
  }
  if (file_.close() != WriteStatus::kOk) return note(WriteStatus::kFailed);
  return rename_part();
}

/// Gives the file its name, and never replaces a file that came there meanwhile.
WriteStatus Writer::rename_part() noexcept {
  if (::renameat2(AT_FDCWD, part_.c_str(), AT_FDCWD, path_.c_str(), RENAME_NOREPLACE) == 0)
    return status_;
  const bool is_unknown = errno == EINVAL || errno == ENOSYS;  // to this file system
  if (is_unknown && ::access(path_.c_str(), F_OK) != 0 &&
      ::rename(part_.c_str(), path_.c_str()) == 0)
    return status_;
  file_.fail(errno);
  return note(WriteStatus::kFailed);
}

}  // namespace cordis::mcap
