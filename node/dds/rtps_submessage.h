// node/dds/rtps_submessage.h -- the parts of a datagram of RTPS, as they come.
// Included by node/dds and its tests alone.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace cordis::dds {

/// [DDSI-RTPS 9.4.4]
inline constexpr std::size_t kRtpsHeader = 20;

/// Kinds of submessages [DDSI-RTPS 9.4.5, DDS-SECURITY 7.3.6.4].
enum class SubmessageKind : std::uint8_t {
  kPad = 0x01,
  kAckNack = 0x06,
  kHeartbeat = 0x07,
  kGap = 0x08,
  kInfoTime = 0x09,
  kInfoSource = 0x0c,
  kInfoDestination = 0x0e,
  kNackFragments = 0x12,
  kHeartbeatFragments = 0x13,
  kData = 0x15,
  kFragments = 0x16,
  kSecureBody = 0x30,  // these three: keys, encrypted for one participant
  kSecurePrefix = 0x31,
  kSecurePostfix = 0x32,
  kSecureMessage = 0x33,  // all that follows is encrypted
  kFirstOfVendors = 0x80
};

/// One submessage. A value is read where the body has room for it.
struct Submessage {
  SubmessageKind kind{};
  std::uint8_t flags = 0;
  std::span<const std::uint8_t> body;  // without its header
  std::size_t size = 0;                // with it

  bool has(unsigned flag) const noexcept { return (flags & flag) != 0; }
  bool is_little() const noexcept { return has(0x01); }

  std::uint16_t number16(std::size_t offset) const noexcept {
    const unsigned first = body[offset];
    const unsigned second = body[offset + 1];
    return static_cast<std::uint16_t>(is_little() ? first + 256 * second : 256 * first + second);
  }
  std::uint32_t number32(std::size_t offset) const noexcept {
    const std::uint32_t first = number16(offset);
    const std::uint32_t second = number16(offset + 2);
    return is_little() ? first + 65536 * second : 65536 * first + second;
  }
  /// The number of a sample: its high half comes first, whatever the order of bytes.
  std::int64_t sequence(std::size_t offset) const noexcept {
    const auto high = static_cast<std::int32_t>(number32(offset));
    return static_cast<std::int64_t>(high) * 4294967296 + number32(offset + 4);
  }
};

/// The number of a writer or reader within its participant.
using EntityNumber = std::array<std::uint8_t, 4>;

/// True if a sample, or a fragment of one, is of this writer.
inline bool is_of(const Submessage& data, const EntityNumber& writer) noexcept {
  constexpr std::size_t kWriter = 8;  // behind flags, an offset and the reader
  return data.body.size() >= kWriter + writer.size() &&
         std::ranges::equal(data.body.subspan(kWriter, writer.size()), writer);
}

/// True if these octets, what a GUID begins with, are those of a participant: not all are 0.
inline bool is_prefix(std::span<const std::uint8_t> octets) noexcept {
  return std::ranges::any_of(octets, [](std::uint8_t octet) { return octet != 0; });
}

/// True if a datagram begins as one of RTPS.
inline bool is_rtps(std::span<const std::uint8_t> datagram) noexcept {
  constexpr std::array<std::uint8_t, 4> kMagic{'R', 'T', 'P', 'S'};
  return datagram.size() >= kRtpsHeader &&
         std::ranges::equal(datagram.first(kMagic.size()), kMagic);
}

/// The submessage with which these bytes begin; nothing when they end within it. A length that is no multiple of
/// 4 is that of the last alone: Fast DDS goes on at the next multiple.
inline std::optional<Submessage> first_submessage(std::span<const std::uint8_t> rest) noexcept {
  constexpr std::size_t kHeader = 4;
  if (rest.size() < kHeader) return std::nullopt;
  Submessage found{static_cast<SubmessageKind>(rest[0]), rest[1], rest.first(kHeader), 0};
  const std::size_t length = found.number16(2);
  // A length of 0 stands for all that is left, but for what may have no body.
  const bool is_last =
      length == 0 && found.kind != SubmessageKind::kInfoTime && found.kind != SubmessageKind::kPad;
  found.size = is_last ? rest.size() : kHeader + length;
  if (found.size > rest.size()) return std::nullopt;
  if (found.size % 4 != 0 && found.size != rest.size()) return std::nullopt;
  found.body = rest.first(found.size).subspan(kHeader);
  return found;
}

}  // namespace cordis::dds
