// sim_node/engine/description/fingerprint.h -- one number that two equal networks share.
#pragma once

#include <cstdint>

#include "sim_node/engine/description/network.h"

namespace cordis::engine {

/// See Network::fingerprint.
std::uint64_t fingerprint_of(const NetworkDescription& description);

}  // namespace cordis::engine
