// cli/table/table_file.h -- a file that takes rows of numbers, wherever they come from.
#pragma once

#include <span>

namespace cordis::cli {

/// A table on its way to a file. What has been written stays when the program ends early, as far as
/// the format allows.
class TableFile {
 public:
  TableFile() = default;
  virtual ~TableFile() = default;
  TableFile(const TableFile&) = delete;
  TableFile& operator=(const TableFile&) = delete;

  /// One value per column. @throws std::runtime_error when the file takes no more.
  virtual void write(std::span<const double> row) = 0;

  /// Completes the file; to be called once, after the last row.
  /// @throws std::runtime_error when the file does not take it.
  virtual void finish() = 0;
};

}  // namespace cordis::cli
