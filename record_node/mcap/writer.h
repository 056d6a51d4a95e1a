// record_node/mcap/writer.h -- writes a take that a crash or a full disk leaves readable.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <string>

#include "record_node/mcap/chunk_builder.h"
#include "record_node/mcap/output_file.h"
#include "record_node/mcap/records.h"
#include "record_node/mcap/summary.h"

namespace cordis::mcap {

struct WriterConfig {
  Compression compression = Compression::kZstd;
  std::uint64_t chunk_bytes = std::uint64_t{1} << 20;     ///< a chunk is closed when it has as many
  std::uint64_t chunk_nsec = 250'000'000;                 ///< or when its first message is as old
  bool sync = false;                                      ///< wait for the disk after each chunk
  std::uint64_t reserve_bytes = std::uint64_t{64} << 10;  ///< kept free beside what the end needs
  std::string library = "cordis";                         ///< the program that writes
};

/// The file that is written until it is closed: `take.mcap.part` for `take.mcap`.
std::filesystem::path part_of(const std::filesystem::path& path);

/// Writes one take, from one thread. Messages go into chunks. Each chunk and its indexes reach the
/// file in one write(2), so a process that dies loses at most the open chunk. Room for the end of
/// the file is reserved before each chunk: on a full disk close() still makes a whole take.
///
/// After the constructor nothing throws; a status says what became of each call.
class Writer {
 public:
  /// Makes `path`.part. @throws FileError when either file exists, or cannot be made
  explicit Writer(const std::filesystem::path& path, const WriterConfig& config = {});
  /// Closes the file.
  ~Writer();
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  /// Writes the schema under a number of its own. @return the number; 0 when it failed: status()
  [[nodiscard]] std::uint16_t add_schema(const Schema& schema) noexcept;
  /// Writes the channel, whose schema is known or 0, under a number of its own.
  /// @return the number, from 1; 0 when it failed: status()
  [[nodiscard]] std::uint16_t add_channel(const Channel& channel) noexcept;

  /// Adds the message to the open chunk, and closes the chunk when it has enough bytes.
  [[nodiscard]] WriteStatus write(const Message& message) noexcept;
  [[nodiscard]] WriteStatus attach(const Attachment& attachment) noexcept;
  [[nodiscard]] WriteStatus add_metadata(const Metadata& metadata) noexcept;

  /// Closes the open chunk when `now` is chunk_nsec or more past its first message. Both times come
  /// from the clock of the log times.
  [[nodiscard]] WriteStatus close_chunk_if_older(std::uint64_t now_nsec) noexcept;
  /// Closes the open chunk.
  [[nodiscard]] WriteStatus flush() noexcept;
  /// Writes the end of the file and gives it its name. Further calls do nothing.
  /// @return kOk: the take is whole. kFull: the take is whole, but lacks what found no room.
  /// kFailed: `path`.part stays, for `cordis recover`
  [[nodiscard]] WriteStatus close() noexcept;

  /// The worst that a call has returned; refused messages aside.
  WriteStatus status() const noexcept { return status_; }
  /// One sentence about it; empty when nothing is wrong.
  const std::string& problem() const noexcept { return problem_; }
  const std::filesystem::path& path() const noexcept { return path_; }
  /// Counts of what is in the file, without the open chunk.
  const Statistics& statistics() const noexcept { return summary_.statistics; }
  /// Messages that were taken and then found no room.
  std::uint64_t lost_count() const noexcept { return lost_count_; }
  /// Size of the file as it is [bytes].
  std::uint64_t size() const noexcept { return file_.position(); }

 private:
  template <class Action>
  WriteStatus guarded(Action action) noexcept;
  WriteStatus put(std::uint64_t spare);
  WriteStatus close_chunk();
  WriteStatus add_to_chunk(const Message& message);
  WriteStatus finish();
  WriteStatus rename_part() noexcept;
  std::uint64_t end_size() const noexcept;
  WriteStatus note(WriteStatus status) noexcept;

  std::filesystem::path path_;
  std::filesystem::path part_;
  WriterConfig config_;
  OutputFile file_;
  Summary summary_;
  ChunkBuilder chunk_;
  Statistics chunk_statistics_;              // of the open chunk
  std::set<std::uint16_t> chunked_schemas_;  // that a chunk repeats
  std::set<std::uint16_t> chunked_channels_;
  Bytes buffer_;                        // what is written next
  std::uint64_t chunk_begin_nsec_ = 0;  // log time of its first message
  std::uint64_t repeated_size_ = 0;     // what the end repeats of schemas, channels and indexes
                                        // [bytes]
  std::uint64_t lost_count_ = 0;
  WriteStatus status_ = WriteStatus::kOk;
  std::string problem_;
};

}  // namespace cordis::mcap
