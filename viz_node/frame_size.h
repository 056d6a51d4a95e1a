// viz_node/frame_size.h -- how large the frames of a scene can be.
#pragma once

#include <cstddef>

#include "idl/scene.h"

namespace cordis::viz {

/// Bytes of the largest frame that a scene can have on the wire, without headers of packets.
std::size_t largest_frame_bytes(const msg::SceneDescription& description) noexcept;

/// True if frames of this size arrive whole on their own: a socket keeps two of them until it is
/// read, so no part has to be sent again.
/// @param socket_bytes  what the socket that receives them keeps
bool arrives_whole(std::size_t frame_bytes, std::size_t socket_bytes) noexcept;

}  // namespace cordis::viz
