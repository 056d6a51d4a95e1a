// node/dds/secure_datagram.cpp
#include "node/dds/secure_datagram.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>

#include "node/dds/discovery_check.h"
#include "node/dds/rtps_submessage.h"

namespace cordis::dds {
namespace {

constexpr std::size_t kWriterOfData = 8;  // behind flags, an offset and the reader

bool finds_or_authenticates(const Submessage& data) noexcept {
  if (data.body.size() < kWriterOfData + 4) return false;
  const std::span<const std::uint8_t> writer = data.body.subspan(kWriterOfData, 4);
  return std::ranges::equal(writer, kAnnouncer) || std::ranges::equal(writer, kAuthenticator);
}

bool is_fit(const Submessage& part) noexcept {
  switch (part.kind) {
    case SubmessageKind::kInfoTime:
    case SubmessageKind::kInfoDestination:
    case SubmessageKind::kSecureBody:
    case SubmessageKind::kSecurePrefix:
    case SubmessageKind::kSecurePostfix:
      return true;
    case SubmessageKind::kData:
    case SubmessageKind::kFragments:
      return finds_or_authenticates(part);
    default:
      return part.kind >= SubmessageKind::kFirstOfVendors;
  }
}

}  // namespace

bool is_fit_for_secured(const std::uint8_t* datagram, std::uint32_t size) noexcept {
  const std::span<const std::uint8_t> message(datagram, size);
  if (!is_rtps(message)) return false;
  std::span<const std::uint8_t> rest = message.subspan(kRtpsHeader);
  std::optional<Submessage> part = first_submessage(rest);
  if (part && part->kind == SubmessageKind::kSecureMessage) return true;
  for (; part && is_fit(*part); part = first_submessage(rest)) {
    rest = rest.subspan(part->size);
    if (rest.empty()) return true;
  }
  return false;
}

}  // namespace cordis::dds
