// node/dds/payload.h -- messages as the bytes that go over the wire.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace cordis::dds {

/// Reads a message from a serialized payload: CDR behind 4 bytes of encapsulation. Message is a
/// class of cordis::msg. @return false when the bytes are no such message, or scene/inputs of more
/// than 16 MiB: counts in it ask for a multiple of its size in memory
template <class Message>
[[nodiscard]] bool decode(std::span<const std::byte> payload, Message& message) noexcept;

/// The serialized payload of a message. Precondition: scene/inputs say their wire_version, for without it they
/// read as those of before version 10. @throws std::runtime_error when it has none
template <class Message>
std::vector<std::byte> encode(Message& message);

}  // namespace cordis::dds
