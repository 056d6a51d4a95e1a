// tests/support/datagrams.h -- datagrams as any program of this host takes and sends them.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace cordis::test {

using Datagram = std::vector<std::uint8_t>;

/// What a participant of own_domain() sends to find others; nothing when none does.
std::optional<Datagram> an_announcement();

/// Sends a datagram to every port that a participant of own_domain() may have on 127.0.0.1.
void send_to_all(const Datagram& datagram);

}  // namespace cordis::test
