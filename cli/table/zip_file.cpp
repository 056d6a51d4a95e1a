// cli/table/zip_file.cpp
#include "cli/table/zip_file.h"

#include <limits>
#include <stdexcept>

#include <zlib.h>

namespace cordis::cli {
namespace {

constexpr std::uint32_t kLocalHeader = 0x04034b50;
constexpr std::uint32_t kCentralHeader = 0x02014b50;
constexpr std::uint32_t kEndRecord = 0x06054b50;
constexpr std::uint16_t kVersion = 20;
constexpr std::uint16_t kUtf8Name = 0x0800;
constexpr std::uint16_t kStored = 0;
constexpr std::uint16_t kMidnight = 0;
constexpr std::uint16_t kFirstDay = 0x0021;  // 1980-01-01
constexpr std::uint64_t kCrcInHeader = 14;   // bytes before it

template <class Number>
void put(std::string& bytes, Number number) {
  for (std::size_t i = 0; i < sizeof number; ++i)
    bytes += static_cast<char>((number >> (8 * i)) & 0xFF);
}

}  // namespace

ZipFile::ZipFile(const std::string& path) : file_(path) {}

void ZipFile::begin(const std::string& name) {
  end_entry();
  entries_.push_back({name, file_.size(), 0, static_cast<std::uint32_t>(crc32(0, nullptr, 0))});
  is_open_ = true;
  std::string header;
  put(header, kLocalHeader);
  put(header, kVersion);
  put(header, kUtf8Name);
  put(header, kStored);
  put(header, kMidnight);
  put(header, kFirstDay);
  header.append(12, '\0');  // CRC and both sizes: end_entry()
  put(header, static_cast<std::uint16_t>(name.size()));
  put(header, std::uint16_t{0});  // no extra field
  file_.write(header + name);
}

void ZipFile::add(std::string_view bytes) {
  Entry& entry = entries_.back();
  constexpr std::uint64_t kDirectoryRoom = 1U << 24;
  if (file_.size() + bytes.size() > kMaxSize - kDirectoryRoom)
    throw std::runtime_error("'" + file_.path() +
                             "' would be larger than 4 GB, where a ZIP archive ends");
  entry.crc = static_cast<std::uint32_t>(
      crc32_z(entry.crc, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
  entry.size += static_cast<std::uint32_t>(bytes.size());
  file_.write(bytes);
}

void ZipFile::end_entry() {
  if (!is_open_) return;
  is_open_ = false;
  const Entry& entry = entries_.back();
  std::string sizes;
  put(sizes, entry.crc);
  put(sizes, entry.size);
  put(sizes, entry.size);
  file_.overwrite(entry.offset + kCrcInHeader, sizes);
}

void ZipFile::finish() {
  end_entry();
  if (entries_.size() > std::numeric_limits<std::uint16_t>::max())
    throw std::runtime_error("'" + file_.path() + "' would have more than 65535 columns");
  const std::uint64_t directory_at = file_.size();
  for (const Entry& entry : entries_) {
    std::string header;
    put(header, kCentralHeader);
    put(header, kVersion);
    put(header, kVersion);
    put(header, kUtf8Name);
    put(header, kStored);
    put(header, kMidnight);
    put(header, kFirstDay);
    put(header, entry.crc);
    put(header, entry.size);
    put(header, entry.size);
    put(header, static_cast<std::uint16_t>(entry.name.size()));
    header.append(12, '\0');  // no extra field, no comment, first disk, no attributes
    put(header, static_cast<std::uint32_t>(entry.offset));
    file_.write(header + entry.name);
  }
  std::string end;
  put(end, kEndRecord);
  end.append(4, '\0');  // the first disk of one
  put(end, static_cast<std::uint16_t>(entries_.size()));
  put(end, static_cast<std::uint16_t>(entries_.size()));
  put(end, static_cast<std::uint32_t>(file_.size() - directory_at));
  put(end, static_cast<std::uint32_t>(directory_at));
  put(end, std::uint16_t{0});  // no comment
  file_.write(end);
  file_.flush();
}

}  // namespace cordis::cli
