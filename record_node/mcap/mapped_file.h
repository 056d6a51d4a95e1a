// record_node/mcap/mapped_file.h -- a file as bytes in memory, read only.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

namespace cordis::mcap {

/// Maps a file; its pages come from the disk when they are read.
class MappedFile {
 public:
  /// @throws FileError when it is no file or cannot be read
  explicit MappedFile(const std::filesystem::path& path);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  std::span<const std::byte> bytes() const noexcept { return bytes_; }

 private:
  std::span<const std::byte> bytes_;
};

}  // namespace cordis::mcap
