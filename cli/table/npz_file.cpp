// cli/table/npz_file.cpp
#include "cli/table/npz_file.h"

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <string_view>
#include <utility>

#include <unistd.h>

#include "cli/command_line.h"

namespace cordis::cli {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::size_t kMaxRoom = std::size_t{64} << 20;  // of columns at a time [bytes]
constexpr std::size_t kMaxTable = ZipFile::kMaxSize - (std::size_t{64} << 20);  // [bytes]

/// A file without a name on the disk of `path`; the system removes it when it is closed.
std::FILE* temporary_beside(const std::string& path) {
  std::filesystem::path folder = std::filesystem::path(path).parent_path();
  if (folder.empty()) folder = ".";
  std::string name = (folder / ".rows-XXXXXX").string();
  const int file = mkstemp(name.data());
  if (file < 0) throw UsageError("cannot write beside '" + path + "': " + std::strerror(errno));
  unlink(name.c_str());
  return fdopen(file, "w+b");
}

std::string npy_header(const std::string& type, std::size_t count) {
  constexpr std::size_t kAlignment = 64;
  constexpr std::size_t kBeforeText = 10;
  std::string text = "{'descr': '" + type + "', 'fortran_order': False, 'shape': (" +
                     std::to_string(count) + ",), }";
  while ((kBeforeText + text.size() + 1) % kAlignment != 0) text += ' ';
  text += '\n';
  std::string header = "\x93NUMPY";
  header += '\x01';
  header += '\0';
  header += static_cast<char>(text.size() & 0xFF);
  header += static_cast<char>(text.size() >> 8);
  return header + text;
}

std::string_view bytes_of(const double* values, std::size_t count) {
  return {reinterpret_cast<const char*>(values), count * sizeof(double)};
}

}  // namespace

NpzFile::NpzFile(const std::string& path, std::vector<Column> columns)
    : columns_(std::move(columns)), zip_(path), rows_(temporary_beside(path)) {}

NpzFile::~NpzFile() {
  std::fclose(rows_);
}

void NpzFile::write(std::span<const double> row) {
  if ((row_count_ + 1) * row.size() * sizeof(double) > kMaxTable)
    throw std::runtime_error("the table is larger than 4 GB, which an NPZ file does not hold");
  if (std::fwrite(row.data(), sizeof(double), row.size(), rows_) != row.size())
    throw std::runtime_error(std::string("cannot keep a row for the NPZ file: ") +
                             std::strerror(errno));
  ++row_count_;
}

void NpzFile::add_text(const std::string& name, const std::vector<std::string>& texts) {
  std::size_t longest = 1;
  for (const std::string& text : texts) longest = std::max(longest, text.size());
  zip_.begin(name + ".npy");
  zip_.add(npy_header("<U" + std::to_string(longest), texts.size()));
  std::string bytes;
  for (const std::string& text : texts) {  // all are ASCII
    for (std::size_t i = 0; i < longest; ++i) {
      bytes += i < text.size() ? text[i] : '\0';
      bytes.append(3, '\0');
    }
  }
  zip_.add(bytes);
}

void NpzFile::add_columns(std::size_t first, std::size_t count) {
  std::vector<double> values(count * row_count_);
  std::vector<double> row(columns_.size());
  std::rewind(rows_);
  for (std::size_t r = 0; r < row_count_; ++r) {
    if (std::fread(row.data(), sizeof(double), row.size(), rows_) != row.size())
      throw std::runtime_error("cannot read back the rows for the NPZ file");
    for (std::size_t c = 0; c < count; ++c) values[c * row_count_ + r] = row[first + c];
  }
  for (std::size_t c = 0; c < count; ++c) {
    zip_.begin(columns_[first + c].name + ".npy");
    zip_.add(npy_header("<f8", row_count_));
    zip_.add(bytes_of(values.data() + c * row_count_, row_count_));
  }
}

void NpzFile::finish() {
  const std::size_t column_bytes = std::max<std::size_t>(1, row_count_ * sizeof(double));
  const std::size_t at_once = std::max<std::size_t>(1, kMaxRoom / column_bytes);
  for (std::size_t first = 0; first < columns_.size(); first += at_once)
    add_columns(first, std::min(at_once, columns_.size() - first));
  std::vector<std::string> names;
  std::vector<std::string> units;
  for (const Column& column : columns_) {
    names.push_back(column.name);
    units.push_back(column.unit);
  }
  add_text("_columns", names);
  add_text("_units", units);
  zip_.finish();
}

}  // namespace cordis::cli
