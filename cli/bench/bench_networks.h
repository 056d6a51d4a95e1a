// cli/bench/bench_networks.h -- the networks that are measured, in any size.
#pragma once

#include <cstdint>

#include "sim_node/engine/description/network.h"

namespace cordis::cli {

/// A square net of free masses, each linked to its neighbours by spring-dampers, its links in runs
/// as a scene's generator makes them.
/// @param dimension  1, 2 or 3
/// @param side       masses of an edge, >= 2
engine::NetworkDescription square_net(int dimension, std::uint32_t side);

/// Strings of 200 masses in 3-D between fixed points, side by side, each plucked in its middle.
/// @param masses  of all strings, a multiple of 200 is taken, >= 200
engine::NetworkDescription strings(std::uint32_t masses);

/// A slab of balls in 2-D that cohere as those of the gallery's plasticine do: a hard core, and a pull
/// of the nearest.
/// @param balls  >= 4; whole rows are taken
engine::NetworkDescription agglomerate(std::uint32_t balls);

}  // namespace cordis::cli
