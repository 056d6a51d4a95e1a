// sim_node/run/frame_message.h -- a frame as it is published.
#pragma once

#include "idl/scene.h"
#include "sim_node/run/frame_store.h"

namespace cordis::sim {

/// Puts what a buffer holds of the scene itself into a message: positions, states of links,
/// bonds, forces on ports, step, times and hash. Its epoch and number stay.
void put_frame(const FrameShape& shape, const FrameBuffer& buffer, msg::SceneFrame& frame);

}  // namespace cordis::sim
