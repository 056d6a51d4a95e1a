// node/dds/discovery_check.cpp
#include "node/dds/discovery_check.h"

#include <algorithm>
#include <cstddef>
#include <optional>

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
  /// A number of texts.
  bool skip_texts() noexcept {
    std::uint32_t count = 0;
    if (!read32(count) || count > rest_.size() / 4) return false;
    for (; count > 0; --count) {
      if (!skip_octets()) return false;
    }
    return true;
  }
  /// A number of values of this size.
  bool skip_values(std::size_t bytes) noexcept {
    std::uint32_t count = 0;
    return read32(count) && count <= rest_.size() / bytes;
  }
  /// A text that ends with a 0.
  bool skip_name() noexcept {
    std::uint32_t count = 0;
    return read32(count) && count >= 1 && count <= rest_.size() && rest_[count - 1] == 0;
  }
  /// A GUID of somebody. @param entity  of a participant, or of any
  bool skip_guid(std::optional<std::uint32_t> entity) noexcept {
    Octets prefix;
    Octets number;
    if (!take(12, prefix) || !take(4, number)) return false;
    std::uint32_t found = 0;
    for (const std::uint8_t octet : number) found = 256 * found + octet;
    return is_prefix(prefix) && (entity ? found == *entity : found != 0);
  }
  bool skip_holder() noexcept { return skip_octets() && skip_properties() && skip_properties(); }

 private:
  Octets rest_;
  bool is_little_;
};

constexpr std::uint16_t kLast = 0x0001;

bool is_sound_of_participant(std::uint16_t parameter, Cursor value) noexcept {
  constexpr std::uint32_t kParticipant = 0x000001c1;
  std::uint32_t seconds = 0;
  switch (parameter) {
    case 0x0002:  // how long it is taken to live
      return value.read32(seconds) && seconds >= 1 && seconds <= 0x7fff'ffff;
    case 0x0050:
      return value.skip_guid(kParticipant);
    case 0x0059:
      return value.skip_properties();
    case 0x1001:  // tokens of its identity and permissions
    case 0x1002:
      return value.skip_holder();
    default:
      return true;
  }
}

bool is_sound_of_endpoint(std::uint16_t parameter, Cursor value) noexcept {
  std::uint32_t number = 0;
  switch (parameter) {
    case 0x0005:  // names of its topic and type
    case 0x0007:
      return value.skip_name();
    case 0x0006:  // strength
      return value.read32(number) && number <= 0x7fff'ffff;
    case 0x0029:  // partitions
      return value.skip_texts();
    case 0x002c:  // data of users
    case 0x002d:
    case 0x002e:
      return value.skip_octets();
    case 0x0035:  // a filter: its name, topic, class and expression, and what that takes
      return value.skip_octets() && value.skip_octets() && value.skip_octets() &&
             value.skip_octets() && value.skip_texts();
    case 0x0059:
      return value.skip_properties();
    case 0x005a:
      return value.skip_guid({});
    case 0x0069:  // descriptions of its type
    case 0x0072:
      return false;
    case 0x0073:  // encodings
      return value.skip_values(2);
    case 0x8006:  // domains of shared memory
      return value.skip_values(8);
    default:
      return true;
  }
}

/// True if all parameters of a list are whole, and each of them is sound.
template <class IsSound>
bool are_sound(Octets parameters, bool is_little, IsSound is_sound) noexcept {
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

}  // namespace

bool is_sound_announcement(Octets parameters, bool is_little) noexcept {
  return are_sound(parameters, is_little, is_sound_of_participant);
}

bool is_sound_endpoint(Octets parameters, bool is_little) noexcept {
  return are_sound(parameters, is_little, is_sound_of_endpoint);
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
