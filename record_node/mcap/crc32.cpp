// record_node/mcap/crc32.cpp
#include "record_node/mcap/crc32.h"

#include <zlib.h>

namespace cordis::mcap {

std::uint32_t crc32(std::span<const std::byte> bytes, std::uint32_t before) noexcept {
  if (bytes.empty()) return before;  // zlib begins again at a null pointer
  return static_cast<std::uint32_t>(
      ::crc32_z(before, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

}  // namespace cordis::mcap
