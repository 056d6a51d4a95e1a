// node/dds/datagram_filter.h -- what of a datagram Fast DDS may read.
// Included by node/dds and its tests alone.
#pragma once

#include <cstdint>

namespace cordis::dds {

/// How many bytes of a datagram Fast DDS 2.9 may read; 0 when it must read none.
///
/// Any process that reaches a port can send anything. Fast DDS aborts on one byte behind its statistics, trusts
/// lengths and numbers of fragments, and counts through a gap number by number. So a datagram passes when each
/// submessage is whole and has the fields of its kind within it, with values that Fast DDS can follow.
/// Statistics, which no part of Cordis reads, are cut off. Of a secured participant is_fit_for_secured() holds as well.
/// What finds and authenticates others is looked into (discovery_check.h). Other samples are not. Real time; reads `size` bytes.
/// Source: [DDSI-RTPS 8.3.7, 9.4.5].
std::uint32_t bytes_to_read(const std::uint8_t* datagram, std::uint32_t size,
                            bool is_secured) noexcept;

/// True if a datagram that passed has fragments of a sample. Fast DDS takes their length from the first
/// that came, so it may read up to kBehindFragments bytes behind the last one.
bool has_fragments(const std::uint8_t* datagram, std::uint32_t size) noexcept;

/// The fragments that one submessage may have: CycloneDDS sends 10.
inline constexpr std::uint32_t kMaxFragmentsAtOnce = 16;
inline constexpr std::uint32_t kBehindFragments = kMaxFragmentsAtOnce * 65'536;

}  // namespace cordis::dds
