// node/dds/discovery_check.cpp
#include "node/dds/discovery_check.h"

#include <algorithm>
#include <cstddef>

namespace cordis::dds {
namespace {

using Octets = std::span<const std::uint8_t>;

/// Goes through what was encoded, as far as it is whole.
class Cursor {
 public:
  Cursor(Octets rest, bool is_little) : rest_(rest), is_little_(is_little) {}

  bool is_at_end() const noexcept { return rest_.empty(); }

  bool skip(std::size_t count) noexcept {
    if (count > rest_.size()) return false;
    rest_ = rest_.subspan(count);
    return true;
  }
  bool read16(std::uint16_t& value) noexcept {
    if (rest_.size() < 2) return false;
    value = static_cast<std::uint16_t>(is_little_ ? rest_[0] + 256 * rest_[1]
                                                  : 256 * rest_[0] + rest_[1]);
    return skip(2);
  }
  bool read32(std::uint32_t& value) noexcept {
    std::uint16_t first = 0;
    std::uint16_t second = 0;
    if (!read16(first) || !read16(second)) return false;
    value = is_little_ ? first + 65536U * second : 65536U * first + second;
    return true;
  }
  bool take(std::size_t count, Octets& part) noexcept {
    if (count > rest_.size()) return false;
    part = rest_.first(count);
    return skip(count);
  }

  /// A text, or octets: their number, then they, then up to 3 more.
  bool skip_octets() noexcept {
    std::uint32_t count = 0;
    return read32(count) && count <= rest_.size() &&
           skip(std::min<std::size_t>((std::size_t{count} + 3) / 4 * 4, rest_.size()));
  }
  /// Names, each with a text or octets.
  bool skip_properties() noexcept {
    std::uint32_t count = 0;
    if (!read32(count) || count > rest_.size() / 8) return false;
    for (; count > 0; --count) {
      if (!skip_octets() || !skip_octets()) return false;
    }
    return true;
  }
  bool skip_holder() noexcept { return skip_octets() && skip_properties() && skip_properties(); }

 private:
  Octets rest_;
  bool is_little_;
};

constexpr std::uint16_t kLast = 0x0001;
constexpr std::uint16_t kProperties = 0x0059;
constexpr std::uint16_t kIdentity = 0x1001;
constexpr std::uint16_t kPermissions = 0x1002;

bool is_sound(std::uint16_t parameter, Cursor value) noexcept {
  if (parameter == kProperties) return value.skip_properties();
  if (parameter == kIdentity || parameter == kPermissions) return value.skip_holder();
  return true;
}

}  // namespace

bool is_sound_announcement(Octets parameters, bool is_little) noexcept {
  Cursor all(parameters, is_little);
  while (!all.is_at_end()) {
    std::uint16_t parameter = 0;
    std::uint16_t length = 0;
    if (!all.read16(parameter) || !all.read16(length)) return false;
    if (parameter == kLast) return true;
    Octets value;
    if (length % 4 != 0 || !all.take(length, value)) return false;
    if (!is_sound(parameter, Cursor(value, is_little))) return false;
  }
  return false;
}

bool is_sound_handshake(Octets message, bool is_little) noexcept {
  constexpr std::size_t kGuid = 16;
  constexpr std::size_t kIdentityOfMessage = kGuid + 8;
  Cursor cursor(message, is_little);
  std::uint32_t holders = 0;
  if (!cursor.skip(2 * kIdentityOfMessage + 3 * kGuid) || !cursor.skip_octets()) return false;
  if (!cursor.read32(holders) || holders > message.size() / 12) return false;
  for (; holders > 0; --holders) {
    if (!cursor.skip_holder()) return false;
  }
  return true;
}

}  // namespace cordis::dds
