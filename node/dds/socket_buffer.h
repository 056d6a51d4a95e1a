// node/dds/socket_buffer.h -- how much a socket of DDS can keep until its process reads it.
#pragma once

#include <cstdint>

namespace cordis::dds {

/// What each socket of a participant asks the kernel for, in either direction. [bytes]
inline constexpr std::uint32_t kSocketBufferBytes = 4u << 20;

enum class SocketBuffer : std::uint8_t { kReceive, kSend };

/// What the kernel grants when it is asked for kSocketBufferBytes. [bytes] It bounds them by
/// net.core.rmem_max and net.core.wmem_max. 0 when it does not say. Opens a socket: not for a step.
std::uint32_t granted_bytes(SocketBuffer buffer) noexcept;

}  // namespace cordis::dds
