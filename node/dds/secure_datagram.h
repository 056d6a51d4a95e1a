// node/dds/secure_datagram.h -- what a secured participant takes from the network.
// Included by node/dds and its tests alone.
#pragma once

#include <cstdint>

namespace cordis::dds {

/// True for an RTPS message that is encrypted as a whole, and for one in the clear that only finds or
/// authenticates participants. Fast DDS 2.9 decrypts what is encrypted, but takes every message in the
/// clear as well, with the GUIDs of its readers and writers alone. Real time; reads `size` bytes.
bool is_fit_for_secured(const std::uint8_t* datagram, std::uint32_t size) noexcept;

}  // namespace cordis::dds
