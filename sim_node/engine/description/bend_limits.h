// sim_node/engine/description/bend_limits.h -- bounds of the numbers of a bend.
#pragma once

namespace cordis::engine {

inline constexpr double kMaxRestAngle = 3.2;  ///< either way [rad]

}  // namespace cordis::engine
