// record_node/mcap/byte_writer.h -- values as the bytes of a file: little endian, length first.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace cordis::mcap {

static_assert(std::endian::native == std::endian::little, "values are copied as they are");

using Bytes = std::vector<std::byte>;

/// Appends values to a buffer.
class ByteWriter {
 public:
  explicit ByteWriter(Bytes& out) : out_(out) {}

  template <class T>
  void number(T value) {
    raw({reinterpret_cast<const std::byte*>(&value), sizeof value});
  }
  void raw(std::span<const std::byte> bytes) {
    const std::size_t begin = out_.size();
    out_.resize(begin + bytes.size());
    if (!bytes.empty()) std::memcpy(out_.data() + begin, bytes.data(), bytes.size());
  }
  void text(std::string_view value) {
    number(static_cast<std::uint32_t>(value.size()));
    raw({reinterpret_cast<const std::byte*>(value.data()), value.size()});
  }
  void text_map(const std::map<std::string, std::string>& values) {
    const std::size_t begin = begin_length<std::uint32_t>();
    for (const auto& [key, value] : values) {
      text(key);
      text(value);
    }
    end_length<std::uint32_t>(begin);
  }
  void count_map(const std::map<std::uint16_t, std::uint64_t>& values) {
    const std::size_t begin = begin_length<std::uint32_t>();
    for (const auto& [key, value] : values) {
      number(key);
      number(value);
    }
    end_length<std::uint32_t>(begin);
  }

  /// Leaves room for the length of what follows. @return the place for end_length()
  template <class T>
  std::size_t begin_length() {
    number(T{0});
    return out_.size();
  }
  /// Writes the number of bytes since begin_length().
  template <class T>
  void end_length(std::size_t begin) {
    const T length = static_cast<T>(out_.size() - begin);
    std::memcpy(out_.data() + begin - sizeof length, &length, sizeof length);
  }

  std::size_t size() const noexcept { return out_.size(); }

 private:
  Bytes& out_;
};

}  // namespace cordis::mcap
