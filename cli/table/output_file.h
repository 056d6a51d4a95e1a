// cli/table/output_file.h -- a file that is written, and says so when it cannot be.
#pragma once

#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>

namespace cordis::cli {

/// The file of a path, or stdout for `-`.
class OutputFile {
 public:
  /// Makes the file where there is none. What an existing one holds stays until the first byte is
  /// written. @throws UsageError when that is not possible, or would replace a YAML file or a take.
  explicit OutputFile(std::string path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  const std::string& path() const noexcept { return path_; }

  /// @throws std::runtime_error when the file does not take it, as when the disk is full.
  void write(std::string_view bytes);
  /// Overwrites bytes that were written before, and goes on at the end. Precondition: not stdout.
  void overwrite(std::uint64_t offset, std::string_view bytes);
  /// Hands everything to the system. @throws likewise.
  void flush();

  std::uint64_t size() const noexcept { return size_; }  ///< bytes written

 private:
  [[noreturn]] void fail() const;
  /// Empties a file that was there before.
  void begin();

  std::string path_;
  std::FILE* file_ = nullptr;
  std::uint64_t size_ = 0;
  bool is_begun_ = false;
};

}  // namespace cordis::cli
