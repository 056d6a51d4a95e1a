// cli/table/csv_file.h -- a table as comma-separated values.
#pragma once

#include <string>
#include <vector>

#include "cli/table/column.h"
#include "cli/table/output_file.h"
#include "cli/table/table_file.h"

namespace cordis::cli {

/// A header with the units, then one line per row. A number is the shortest decimal that reads back
/// as the same double; what is no number is `nan`, `inf` or `-inf`.
class CsvFile final : public TableFile {
 public:
  /// @throws UsageError when the file cannot be made.
  CsvFile(const std::string& path, const std::vector<Column>& columns);

  void write(std::span<const double> row) override;
  void finish() override;

 private:
  OutputFile file_;
  std::string line_;
};

/// Adds a number as it stands in a CSV file.
void append_number(std::string& text, double value);
/// Adds a text, in quotes where it needs them.
void append_text(std::string& text, const std::string& value);

}  // namespace cordis::cli
