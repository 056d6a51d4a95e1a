// record_node/mcap/output_file.h -- a file that only grows, with room kept for its end.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace cordis::mcap {

/// What became of bytes that were to be written.
enum class WriteStatus : std::uint8_t {
  kOk,
  kFull,     ///< no room for them, on the disk or in a limit of this process; nothing was written
  kRefused,  ///< they cannot be part of a take: a channel that is not known, too many bytes
  kFailed    ///< the file does not work any more
};

/// Appends to a file. It keeps the CRC of all that it wrote, and the lock of the file.
class OutputFile {
 public:
  OutputFile() = default;
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Makes a new file. @throws FileError when it exists or cannot be made
  void create(const std::filesystem::path& path);
  /// Opens a file that exists. @throws FileError when another process writes it
  void open(const std::filesystem::path& path);
  /// Replaces bytes that are there.
  WriteStatus overwrite(std::uint64_t offset, std::span<const std::byte> bytes) noexcept;
  /// Cuts the file, and appends from there on. `crc` is of what is before.
  WriteStatus go_on_at(std::uint64_t position, std::uint32_t crc) noexcept;

  /// Makes sure that `size` bytes from here on have their room on the disk.
  WriteStatus reserve(std::uint64_t size) noexcept;
  /// Appends the bytes, or nothing at all.
  WriteStatus append(std::span<const std::byte> bytes) noexcept;
  /// Waits until all is on the disk.
  WriteStatus sync() noexcept;
  /// Gives back room that was not used, and closes the file.
  WriteStatus close() noexcept;

  bool is_open() const noexcept { return descriptor_ >= 0; }
  std::uint64_t position() const noexcept { return position_; }
  std::uint32_t crc() const noexcept { return crc_; }
  /// Keeps an error of the system that another call for this file got.
  void fail(int error) noexcept { error_ = error; }
  /// The error of the system in the last failure.
  std::string problem() const;

 private:
  bool has_room_for(std::uint64_t end) const noexcept;
  int allocate(std::uint64_t size) const noexcept;

  int descriptor_ = -1;
  int error_ = 0;
  std::uint64_t position_ = 0;
  std::uint64_t reserved_end_ = 0;
  std::uint32_t crc_ = 0;
};

}  // namespace cordis::mcap
