// node/config/max_axes.h -- the room for axes in a message of the force loop.
#pragma once

namespace cordis::config {

inline constexpr int kMaxAxes = 16;  ///< most axes of a device: MAX_AXES of idl/gesture.idl

}  // namespace cordis::config
