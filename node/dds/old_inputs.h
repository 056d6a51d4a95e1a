// node/dds/old_inputs.h -- scene/inputs of takes of before version 10 of the wire.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "idl/inputs.h"

namespace cordis::dds {

/// True for a serialized payload of SceneInputs of version 9 of the wire or an older one.
bool is_old_inputs(std::span<const std::byte> payload) noexcept;

/// Reads it as a message of today, with wire_version 9. Cost: that of reading a message.
/// Precondition: is_old_inputs(payload)
/// @return false when the bytes are no such message
/// @throws std::bad_alloc and what Fast CDR throws, when counts ask for more than there is
[[nodiscard]] bool read_old_inputs(std::span<const std::byte> payload, msg::SceneInputs& message);

/// The payload of a message in the layout of those versions.
/// @throws std::runtime_error when it has none
std::vector<std::byte> encode_old_inputs(const msg::SceneInputs& message);

}  // namespace cordis::dds
