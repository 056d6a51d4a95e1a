// cli/table/npz_file.h -- a table as NumPy reads it.
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "cli/table/column.h"
#include "cli/table/table_file.h"
#include "cli/table/zip_file.h"

namespace cordis::cli {

/// A ZIP archive with one array of float64 per column, by its name, and the arrays of text
/// `_columns` and `_units`. Rows wait in a temporary file beside it, without a name, until finish()
/// writes the columns: what is not finished has no rows.
/// Source: numpy.lib.format, version 1.0.
class NpzFile final : public TableFile {
 public:
  /// @throws UsageError when the file cannot be made.
  NpzFile(const std::string& path, std::vector<Column> columns);
  ~NpzFile() override;

  void write(std::span<const double> row) override;
  void finish() override;

 private:
  void add_text(const std::string& name, const std::vector<std::string>& texts);
  void add_columns(std::size_t first, std::size_t count);

  std::vector<Column> columns_;
  ZipFile zip_;
  std::FILE* rows_;
  std::size_t row_count_ = 0;
};

}  // namespace cordis::cli
