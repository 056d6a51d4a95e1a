// node/dds/secure_datagram.cpp
#include "node/dds/secure_datagram.h"

#include <optional>
#include <span>

#include "node/dds/discovery_check.h"
#include "node/dds/rtps_submessage.h"

namespace cordis::dds {
namespace {

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
      return is_of(part, kAnnouncer) || is_of(part, kAuthenticator);
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
