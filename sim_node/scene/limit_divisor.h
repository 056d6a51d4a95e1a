// sim_node/scene/limit_divisor.h -- how far the size of a scene is limited.
#pragma once

namespace cordis::scene {

/// The limits of size are divided by this. In the build for fuzzing a scene has a second, so that
/// the largest one there has 250 MATs.
#ifdef CORDIS_FUZZ
inline constexpr long kLimitDivisor = 4000;
#else
inline constexpr long kLimitDivisor = 1;
#endif

}  // namespace cordis::scene
