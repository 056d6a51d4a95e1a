// record_node/mcap/crc32.h -- the checksum of MCAP files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace cordis::mcap {

/// The CRC-32 of zlib. @param before  that of the bytes before these; 0 when there are none
std::uint32_t crc32(std::span<const std::byte> bytes, std::uint32_t before = 0) noexcept;

}  // namespace cordis::mcap
