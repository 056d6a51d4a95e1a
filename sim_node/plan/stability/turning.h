// sim_node/plan/stability/turning.h -- links that energy may press so short that they turn about.
#pragma once

#include <limits>
#include <optional>

#include "sim_node/engine/core/liaison_id.h"
#include "sim_node/engine/description/network.h"
#include "sim_node/plan/stability/reach.h"

namespace cordis::plan {

/// A spring with a rest length in 2 or 3 dimensions that is pressed by more than a quarter of it turns
/// about so fast that undamped motion may gain energy, though each of its tangents is stable.
struct Turning {
  /// Pressing the weakest link so far takes this [J]; infinite where no link turns.
  double energy = std::numeric_limits<double>::infinity();
  /// A link that the energy of the reach may press so far, the one with the most to spare; none: there
  /// is none.
  std::optional<engine::LiaisonId> liaison;
};

/// Links with a stiffness, with states or without, of which one end moves. O(links).
Turning turning_of(const engine::NetworkDescription& network, const Reach& reach);

}  // namespace cordis::plan
