// sim_node/engine/pairs/start_pair_count.h -- how many pairs of a set there are at the start.
#pragma once

#include <cstddef>

#include "sim_node/engine/description/network.h"

namespace cordis::engine {

/// The pairs of a set at the start, and what it takes to find them.
struct StartPairCount {
  std::size_t in_range = 0;
  /// Members in the cells around each other, with the largest skin of a neighbour list: about 44
  /// per pair in range where members are spread evenly in space.
  std::size_t examined = 0;
};

/// Counts until one of the limits is passed.
StartPairCount count_start_pairs(const NetworkDescription& network, const SetLiaison& set,
                                 const StartPairCount& limits);

}  // namespace cordis::engine
