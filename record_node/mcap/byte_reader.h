// record_node/mcap/byte_reader.h -- values out of the bytes of a file, never beyond their end.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <span>
#include <string>

namespace cordis::mcap {

/// Takes values from the front of bytes. Past the end it gives zeros and remembers that it failed.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::byte> bytes) : rest_(bytes) {}

  template <class T>
  T number() {
    T value{};
    const std::span<const std::byte> bytes = raw(sizeof value);
    if (!bytes.empty()) std::memcpy(&value, bytes.data(), sizeof value);
    return value;
  }
  /// The next bytes; none when there are fewer.
  std::span<const std::byte> raw(std::uint64_t count) {
    if (count > rest_.size()) {
      failed_ = true;
      rest_ = {};
      return {};
    }
    const auto bytes = rest_.first(count);
    rest_ = rest_.subspan(count);
    return bytes;
  }
  std::string text() {
    const auto bytes = raw(number<std::uint32_t>());
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }
  std::map<std::string, std::string> text_map() {
    ByteReader pairs(raw(number<std::uint32_t>()));
    std::map<std::string, std::string> values;
    while (!pairs.rest_.empty()) {
      std::string key = pairs.text();
      values[std::move(key)] = pairs.text();
    }
    failed_ = failed_ || pairs.failed_;
    return values;
  }
  std::map<std::uint16_t, std::uint64_t> count_map() {
    ByteReader pairs(raw(number<std::uint32_t>()));
    std::map<std::uint16_t, std::uint64_t> values;
    while (!pairs.rest_.empty()) {
      const auto key = pairs.number<std::uint16_t>();
      values[key] = pairs.number<std::uint64_t>();
    }
    failed_ = failed_ || pairs.failed_;
    return values;
  }

  std::span<const std::byte> rest() const noexcept { return rest_; }
  bool failed() const noexcept { return failed_; }
  /// True if nothing was missing and nothing is left.
  bool is_exact() const noexcept { return !failed_ && rest_.empty(); }

 private:
  std::span<const std::byte> rest_;
  bool failed_ = false;
};

}  // namespace cordis::mcap
