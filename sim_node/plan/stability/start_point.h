// sim_node/plan/stability/start_point.h -- a liaison in the pose of its start, as its laws see it.
#pragma once

#include <cstdint>

#include "sim_node/engine/description/network.h"
#include "sim_node/plan/stability/start_pairs.h"

namespace cordis::plan {

/// How far apart two MATs start [m], signed in 1 dimension.
double distance_at_start(const engine::NetworkDescription& network, std::uint32_t mat_a,
                         std::uint32_t mat_b);

/// A link with states at the start, without speed, with the masses that its expressions know.
engine::LawPoint start_point(const engine::NetworkDescription& network,
                             const engine::StateLink& link);

/// A pair of a set likewise.
engine::LawPoint start_point(const engine::NetworkDescription& network,
                             const engine::SetLiaison& set, const StartPair& pair);

}  // namespace cordis::plan
