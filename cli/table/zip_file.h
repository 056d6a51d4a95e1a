// cli/table/zip_file.h -- a ZIP archive whose files are stored as they are.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "cli/table/output_file.h"

namespace cordis::cli {

/// Writes file after file, uncompressed. The same files give the same bytes: all have the date of
/// 1980-01-01. Source: PKWARE APPNOTE 6.3.
class ZipFile {
 public:
  /// The largest archive [bytes]: it has no ZIP64 records.
  static constexpr std::uint64_t kMaxSize = 0xFFFFFFFF;

  /// @throws UsageError when the file cannot be made.
  explicit ZipFile(const std::string& path);

  /// Begins the next file of the archive; the one before, if any, is complete.
  void begin(const std::string& name);
  /// Adds to the present file. @throws std::runtime_error when the disk or the archive is full.
  void add(std::string_view bytes);
  /// Completes the archive.
  void finish();

 private:
  struct Entry {
    std::string name;
    std::uint64_t offset = 0;
    std::uint32_t size = 0;
    std::uint32_t crc = 0;
  };
  void end_entry();

  OutputFile file_;
  std::vector<Entry> entries_;
  bool is_open_ = false;
};

}  // namespace cordis::cli
