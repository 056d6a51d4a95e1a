// node/config/name_hash.h -- the number that stands for a name on the wire.
#pragma once

#include <cstdint>
#include <string_view>

namespace cordis::config {

/// FNV-1a of 32 bits: the device_id of a device's name and the node_id of a node's.
constexpr std::uint32_t name_hash(std::string_view name) noexcept {
  std::uint32_t hash = 2166136261u;
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 16777619u;
  return hash;
}

}  // namespace cordis::config
