// node/dds/discovery_check.h -- lengths and counts in what finds and authenticates others.
// Included by node/dds and its tests alone.
#pragma once

#include <cstdint>
#include <span>

#include "node/dds/rtps_submessage.h"

namespace cordis::dds {

inline constexpr EntityNumber kAnnouncer{0x00, 0x01, 0x00, 0xc2};
inline constexpr EntityNumber kAuthenticator{0x00, 0x02, 0x01, 0xc3};
inline constexpr EntityNumber kOfferer{0x00, 0x00, 0x03, 0xc2};  ///< says what its writers are
inline constexpr EntityNumber kAsker{0x00, 0x00, 0x04, 0xc2};    ///< and its readers

/// True if Fast DDS can follow an announcement of a participant, without its encoding mark of 4 bytes. Fast DDS 2.9
/// reads a text of 4 GB in a token, and makes room for as many properties as a count says. Real time.
/// Source: [DDSI-RTPS 9.6.2, DDS-SECURITY 7.2].
bool is_sound_announcement(std::span<const std::uint8_t> parameters, bool is_little) noexcept;

/// Likewise what a participant says of a writer or reader. A description of its type is refused: Fast DDS 2.9 follows
/// it beyond its end, and Cordis sends none. Source: [DDSI-RTPS 9.6.2].
bool is_sound_endpoint(std::span<const std::uint8_t> parameters, bool is_little) noexcept;

/// Likewise a message by which participants authenticate each other. Source: [DDS-SECURITY 7.4.3].
bool is_sound_handshake(std::span<const std::uint8_t> message, bool is_little) noexcept;

}  // namespace cordis::dds
