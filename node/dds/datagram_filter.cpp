// node/dds/datagram_filter.cpp
#include "node/dds/datagram_filter.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "node/dds/discovery_check.h"
#include "node/dds/rtps_submessage.h"
#include "node/dds/secure_datagram.h"

namespace cordis::dds {
namespace {

using Octets = std::span<const std::uint8_t>;

constexpr std::size_t kReaderAndWriter = 8;
constexpr std::int64_t kLongestGap = 65'536;        // of all gaps of a datagram together
constexpr std::uint32_t kLargestSample = 1U << 30;  // [bytes]

/// The bytes of a set of numbers of samples or fragments behind its base: how many, and one bit for each.
/// Nothing when it is not whole.
std::optional<std::size_t> bytes_of_set(const Submessage& part, std::size_t offset) noexcept {
  constexpr std::uint32_t kMaxBits = 256;
  if (part.body.size() < offset + 4) return std::nullopt;
  const std::uint32_t bits = part.number32(offset);
  if (bits > kMaxBits) return std::nullopt;
  const std::size_t bytes = 4 + std::size_t{4} * ((bits + 31) / 32);
  if (part.body.size() < offset + bytes) return std::nullopt;
  return bytes;
}

bool is_acknowledgement(const Submessage& part) noexcept {
  constexpr std::size_t kSet = kReaderAndWriter + 8;
  const std::optional<std::size_t> bytes = bytes_of_set(part, kSet);
  return bytes && part.body.size() >= kSet + *bytes + 4 && part.sequence(kReaderAndWriter) >= 0;
}

bool is_gap(const Submessage& part) noexcept {
  constexpr std::size_t kBase = kReaderAndWriter + 8;
  if (!bytes_of_set(part, kBase + 8)) return false;
  const std::int64_t start = part.sequence(kReaderAndWriter);
  const std::int64_t base = part.sequence(kBase);
  return start >= 1 && base >= start;
}

/// The numbers through which Fast DDS counts at a gap.
std::int64_t length_of_gap(const Submessage& gap) noexcept {
  return gap.sequence(kReaderAndWriter + 8) - gap.sequence(kReaderAndWriter);
}

bool is_heartbeat(const Submessage& part) noexcept {
  if (part.body.size() < kReaderAndWriter + 20) return false;
  const std::int64_t first = part.sequence(kReaderAndWriter);
  return first >= 1 && part.sequence(kReaderAndWriter + 8) >= first - 1;
}

bool is_request_of_fragments(const Submessage& part) noexcept {
  constexpr std::size_t kBase = kReaderAndWriter + 8;
  const std::optional<std::size_t> bytes = bytes_of_set(part, kBase + 4);
  constexpr std::uint32_t kLargestBase = 0xffff'ffff - 256;
  return bytes && part.body.size() >= kBase + 4 + *bytes + 4 && part.number32(kBase) >= 1 &&
         part.number32(kBase) <= kLargestBase && part.sequence(kReaderAndWriter) >= 1;
}

/// True if a writer of samples takes a key back and stays. Fast DDS aborts where it had left before. The writers of
/// Cordis, and those of others by default, leave with it.
bool takes_back_alone(const Submessage& data, Octets status) noexcept {
  constexpr std::uint8_t kOfDiscovery = 0xc0;
  const bool is_of_samples = (data.body[11] & kOfDiscovery) != kOfDiscovery;
  return is_of_samples && status[3] == 1;
}

/// Where what follows the parameters of a sample begins; nothing when they do not end. They stand where the offset
/// of the submessage says, which is at least that of the standard.
std::optional<std::size_t> behind_parameters(const Submessage& part, std::size_t least) noexcept {
  constexpr std::size_t kOffset = 2;  // of itself
  constexpr std::uint16_t kLast = 1;
  constexpr std::uint16_t kStatus = 0x0071;
  if (part.body.size() < least) return std::nullopt;
  std::size_t offset = kOffset + 2 + part.number16(kOffset);
  if (offset < least || offset > part.body.size()) return std::nullopt;
  if (!part.has(0x02)) return offset;
  while (offset + 4 <= part.body.size()) {
    const std::uint16_t kind = part.number16(offset);
    const std::size_t length = part.number16(offset + 2);
    offset += 4;
    if (kind == kLast) return offset;
    if (length % 4 != 0 || length > part.body.size() - offset) return std::nullopt;
    if (kind == kStatus && length == 4 && takes_back_alone(part, part.body.subspan(offset, length)))
      return std::nullopt;
    offset += length;
  }
  return std::nullopt;
}

constexpr std::size_t kSmallestPayload = 4;  // its encoding

bool is_of_discovery(const Submessage& data) noexcept {
  return std::ranges::any_of(std::array{kAnnouncer, kAuthenticator, kOfferer, kAsker},
                             [&](const EntityNumber& writer) { return is_of(data, writer); });
}

/// True for what finds or authenticates others where Fast DDS can follow it, and for all else.
bool is_sound_of_discovery(const Submessage& data, Octets payload) noexcept {
  const bool is_little = payload[1] % 2 == 1;
  const Octets message = payload.subspan(kSmallestPayload);
  if (is_of(data, kAnnouncer)) return is_sound_announcement(message, is_little);
  if (is_of(data, kOfferer) || is_of(data, kAsker)) return is_sound_endpoint(message, is_little);
  return !is_of(data, kAuthenticator) || is_sound_handshake(message, is_little);
}

/// True if a sample has a writer. Fast DDS takes those of none without a match.
bool has_writer(const Submessage& data) noexcept {
  return data.number32(8) != 0;
}

bool is_data(const Submessage& part) noexcept {
  constexpr std::size_t kFields = 20;
  const std::optional<std::size_t> payload = behind_parameters(part, kFields);
  if (!payload || part.sequence(12) < 1 || !has_writer(part)) return false;
  const bool has_data = part.has(0x04);
  const bool has_key = part.has(0x08);
  if (!has_data && !has_key) return true;
  if (has_data == has_key || part.body.size() - *payload < kSmallestPayload) return false;
  return !has_data || is_sound_of_discovery(part, part.body.subspan(*payload));
}

/// Fast DDS keeps a list of missing fragments in the memory of the sample: 4 bytes at the beginning of each.
bool has_room_for_list(std::uint64_t whole, std::uint64_t length) noexcept {
  constexpr std::uint64_t kMaxFragments = 1 << 17;
  constexpr std::uint64_t kShortest = 8;  // [bytes]
  if (length < kShortest || (whole + length - 1) / length > kMaxFragments) return false;
  return ((whole - 1) / length * length + 3) / 4 * 4 + 4 <= whole;
}

bool is_fragment(const Submessage& part) noexcept {
  constexpr std::size_t kFields = 32;
  const std::optional<std::size_t> payload = behind_parameters(part, kFields);
  if (!payload || part.sequence(12) < 1 || !has_writer(part)) return false;
  if (is_of_discovery(part)) return false;  // what it sends is short
  if (part.has(0x04)) return false;         // a key alone: Fast DDS copies it from nowhere
  const std::uint64_t number = part.number32(20);
  const std::uint64_t count = part.number16(24);
  const std::uint64_t length = part.number16(26);
  const std::uint64_t whole = part.number32(28);
  if (number < 1 || count < 1 || count > kMaxFragmentsAtOnce) return false;
  if (whole < 1 || whole > kLargestSample || !has_room_for_list(whole, length)) return false;
  if (number - 1 + count > (whole + length - 1) / length) return false;
  return part.body.size() - *payload >= std::min(count * length, whole - (number - 1) * length);
}

/// True if what is encrypted ends within its submessage: its length stands before it, high bytes first.
bool is_secure_body(const Submessage& part) noexcept {
  if (part.body.size() < 4) return false;
  std::uint32_t said = 0;
  for (const std::uint8_t octet : part.body.first(4)) said = 256 * said + octet;
  return said <= part.body.size() - 4;
}

/// True if Fast DDS can follow this submessage. It skips those of other kinds.
bool is_sound(const Submessage& part) noexcept {
  switch (part.kind) {
    case SubmessageKind::kAckNack:
      return is_acknowledgement(part);
    case SubmessageKind::kHeartbeat:
      return is_heartbeat(part);
    case SubmessageKind::kGap:
      return is_gap(part);
    case SubmessageKind::kInfoTime:
      return part.has(0x02) || part.body.size() >= 8;
    case SubmessageKind::kInfoSource:
      return part.body.size() >= 20 && is_prefix(part.body.subspan(8, 12));
    case SubmessageKind::kInfoDestination:
      return part.body.size() >= 12;
    case SubmessageKind::kNackFragments:
      return is_request_of_fragments(part);
    case SubmessageKind::kHeartbeatFragments:
      return part.body.size() >= kReaderAndWriter + 16;
    case SubmessageKind::kSecureBody:
      return is_secure_body(part);
    case SubmessageKind::kData:
      return is_data(part);
    case SubmessageKind::kFragments:
      return is_fragment(part);
    default:
      return true;
  }
}

/// True for what Fast DDS appends to each datagram: when it left, and how much was sent before. Fast DDS
/// takes it for such by the vendor of the message.
bool is_statistics(Octets message, const Submessage& part) noexcept {
  constexpr std::array<std::uint8_t, 2> kFastDds{0x01, 0x0f};
  return part.kind == SubmessageKind::kFirstOfVendors &&
         std::ranges::equal(message.subspan(6, 2), kFastDds);
}

}  // namespace

std::uint32_t bytes_to_read(const std::uint8_t* datagram, std::uint32_t size,
                            bool is_secured) noexcept {
  const Octets message(datagram, size);
  if (!is_rtps(message) || !is_prefix(message.subspan(8, 12))) return 0;
  std::size_t end = kRtpsHeader;
  std::int64_t gaps = 0;
  while (end < message.size()) {
    const std::optional<Submessage> part = first_submessage(message.subspan(end));
    if (!part || !is_sound(*part)) return 0;
    if (part->kind == SubmessageKind::kGap) {
      const std::int64_t length = length_of_gap(*part);
      if (length > kLongestGap || (gaps += length) > kLongestGap) return 0;
    }
    if (is_statistics(message, *part)) {
      if (end + part->size != message.size()) return 0;
      break;
    }
    end += part->size;
  }
  const auto bytes = static_cast<std::uint32_t>(end);
  if (end == kRtpsHeader || (is_secured && !is_fit_for_secured(datagram, bytes))) return 0;
  return bytes;
}

bool has_fragments(const std::uint8_t* datagram, std::uint32_t size) noexcept {
  Octets rest = Octets(datagram, size).subspan(kRtpsHeader);
  while (const std::optional<Submessage> part = first_submessage(rest)) {
    if (part->kind == SubmessageKind::kFragments) return true;
    rest = rest.subspan(part->size);
  }
  return false;
}

}  // namespace cordis::dds
