// sim_node/plan/reach_limit.h -- the energy and speed up to which a step is certified.
#pragma once

#include <algorithm>
#include <limits>

#include "sim_node/engine/description/network.h"
#include "sim_node/engine/world.h"

namespace cordis::plan {

/// Up to which the step of a network is certified where laws have no largest slope.
struct ReachLimit {
  /// The speed of a port [m/s].
  double speed = std::numeric_limits<double>::infinity();
  /// The kinetic and the stored energy of the whole scene [J]; infinite where every such law belongs
  /// to a set.
  double energy = std::numeric_limits<double>::infinity();
  /// The kinetic energy of the two MATs of a pair of a set [J]; infinite where no set has such a law.
  double pair_energy = std::numeric_limits<double>::infinity();

  bool is_infinite() const noexcept {
    return std::min(energy, pair_energy) == std::numeric_limits<double>::infinity();
  }
};

/// The Reach of the start, its energies raised by up to a million as long as the step is certified.
/// Infinite where every law has a largest slope, and where the step is not certified. O(liaisons).
ReachLimit reach_limit(const engine::NetworkDescription& network);

/// True if a port moves faster, or the scene has more energy, than the step is certified for. Of a
/// pair of a set, the two MATs of most kinetic energy count; its stored energy does not, and shows
/// when the pair parts. Real time: O(MATs), no allocation.
/// @param energy  of the world now
bool is_beyond(const ReachLimit& limit, const engine::World& world,
               const engine::Energy& energy) noexcept;

}  // namespace cordis::plan
