// node/dds/secure_datagram.cpp
#include "node/dds/secure_datagram.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

namespace cordis::dds {
namespace {

using Octets = std::span<const std::uint8_t>;
using EntityNumber = std::array<std::uint8_t, 4>;

// [DDSI-RTPS 8.3.3, 9.4.5; DDS-SECURITY 7.3.6.4]
constexpr std::array<std::uint8_t, 4> kRtps{'R', 'T', 'P', 'S'};
constexpr std::size_t kMessageHeader = 20;
constexpr std::size_t kSubmessageHeader = 4;
constexpr std::uint8_t kDataSubmessage = 0x15;
constexpr std::uint8_t kFragmentSubmessage = 0x16;
constexpr std::uint8_t kInfoTime = 0x09;
constexpr std::uint8_t kInfoDestination = 0x0e;
constexpr std::uint8_t kSecureBody = 0x30;  // these three: keys, encrypted for one participant
constexpr std::uint8_t kSecurePrefix = 0x31;
constexpr std::uint8_t kSecurePostfix = 0x32;
constexpr std::uint8_t kSecureMessage = 0x33;  // all that follows is encrypted
constexpr std::uint8_t kFirstOfVendors = 0x80;
constexpr std::uint8_t kIsLittleEndian = 0x01;
constexpr std::size_t kWriterOfData = 12;  // behind flags, an offset and the reader
constexpr EntityNumber kAnnouncer{0x00, 0x01, 0x00, 0xc2};
constexpr EntityNumber kAuthenticator{0x00, 0x02, 0x01, 0xc3};

bool is_of_discovery(Octets submessage) noexcept {
  if (submessage.size() < kWriterOfData + 4) return false;
  const Octets writer = submessage.subspan(kWriterOfData, 4);
  return std::ranges::equal(writer, kAnnouncer) || std::ranges::equal(writer, kAuthenticator);
}

/// @param submessage  with its header
bool is_fit(Octets submessage) noexcept {
  switch (submessage[0]) {
    case kInfoTime:
    case kInfoDestination:
    case kSecureBody:
    case kSecurePrefix:
    case kSecurePostfix:
      return true;
    case kDataSubmessage:
    case kFragmentSubmessage:
      return is_of_discovery(submessage);
    default:
      return submessage[0] >= kFirstOfVendors;
  }
}

}  // namespace

bool is_fit_for_secured(const std::uint8_t* datagram, std::uint32_t size) noexcept {
  const Octets message(datagram, size);
  if (message.size() < kMessageHeader + kSubmessageHeader) return false;
  if (!std::ranges::equal(message.first(kRtps.size()), kRtps)) return false;
  if (message[kMessageHeader] == kSecureMessage) return true;
  for (Octets rest = message.subspan(kMessageHeader); !rest.empty();) {
    if (rest.size() < kSubmessageHeader) return false;
    const bool is_little = (rest[1] & kIsLittleEndian) != 0;
    const std::size_t low = rest[is_little ? 2 : 3];
    const std::size_t high = rest[is_little ? 3 : 2];
    const std::size_t said = kSubmessageHeader + low + 256 * high;
    // A length of 0 stands for all that is left, but for a time stamp that is invalid.
    const bool is_last = low + high == 0 && rest[0] != kInfoTime;
    const std::size_t length = is_last ? rest.size() : said;
    // Fast DDS goes on at the next multiple of 4, so it would read other submessages than these.
    if (length % 4 != 0 && length != rest.size()) return false;
    if (length > rest.size() || !is_fit(rest.first(length))) return false;
    rest = rest.subspan(length);
  }
  return true;
}

}  // namespace cordis::dds
