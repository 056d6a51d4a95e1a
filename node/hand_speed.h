// node/hand_speed.h -- how fast a hand can be.
#pragma once

namespace cordis {

inline constexpr double kFastestHand = 10.0;  ///< no hand moves a handle faster [m/s]

}  // namespace cordis
