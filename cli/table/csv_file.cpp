// cli/table/csv_file.cpp
#include "cli/table/csv_file.h"

#include <array>
#include <charconv>
#include <cmath>

namespace cordis::cli {

void append_number(std::string& text, double value) {
  if (std::isnan(value)) value = std::abs(value);  // else some are "-nan"
  std::array<char, 32> digits;
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  text.append(digits.data(), end.ptr);
}

void append_text(std::string& text, const std::string& value) {
  if (value.find_first_of(",\"\n\r") == std::string::npos) {
    text += value;
    return;
  }
  text += '"';
  for (const char letter : value) {
    if (letter == '"') text += '"';
    text += letter;
  }
  text += '"';
}

CsvFile::CsvFile(const std::string& path, const std::vector<Column>& columns) : file_(path) {
  for (const Column& column : columns) {
    if (!line_.empty()) line_ += ',';
    append_text(line_, header_of(column));
  }
  line_ += '\n';
  file_.write(line_);
}

void CsvFile::write(std::span<const double> row) {
  line_.clear();
  for (std::size_t i = 0; i < row.size(); ++i) {
    if (i > 0) line_ += ',';
    append_number(line_, row[i]);
  }
  line_ += '\n';
  file_.write(line_);
}

void CsvFile::finish() {
  file_.flush();
}

}  // namespace cordis::cli
