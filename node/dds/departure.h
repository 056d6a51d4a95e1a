// node/dds/departure.h -- the last message of a participant, on behalf of one that cannot send it.
// Included by node/dds and its tests alone.
#pragma once

#include <cstdint>
#include <string>

#include "node/dds/participant.h"

namespace cordis::dds {

/// Informs who listens on address:port that a participant has left, in the words in which it would
/// have done so itself: its announcement, disposed of and unregistered [DDSI 8.5.3, 9.6.3.4].
/// @param address  IPv4, of this host
/// @return whether the datagram was sent
[[nodiscard]] bool send_departure(const ParticipantPrefix& participant, std::uint16_t port,
                                  const std::string& address) noexcept;

}  // namespace cordis::dds
