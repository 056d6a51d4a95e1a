// sim_node/engine/core/hash_version.h -- which bits a world of this version computes.
#pragma once

#include <cstdint>

namespace cordis::engine {

/// Grows by one whenever the hashes of tests/golden change: the same inputs then give other bits.
/// A take names the version that it was recorded with.
inline constexpr std::uint32_t kHashVersion = 2;

}  // namespace cordis::engine
