// sim_node/run/thread_count.h -- how many threads a step is worth.
#pragma once

#include <cstddef>

#include "sim_node/engine/world.h"

namespace cordis::sim {

/// How many threads step a world fastest: 1, 2, 4 and so on up to `most`, measured on a second world of its
/// network. More threads count only where they save a tenth of the time. Takes about 50 ms for each count;
/// nothing where the steps cannot be shared. Results do not depend on it.
/// @throws what World throws
std::size_t fastest_thread_count(const engine::World& world, std::size_t most);

}  // namespace cordis::sim
