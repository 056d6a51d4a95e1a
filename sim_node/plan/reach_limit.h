// sim_node/plan/reach_limit.h -- the energy and speed up to which a step is certified.
#pragma once

#include <limits>

#include "sim_node/engine/description/network.h"

namespace cordis::plan {

/// Up to which the step of a network is certified where laws have no largest slope.
struct ReachLimit {
  /// The speed of a port [m/s].
  double speed = std::numeric_limits<double>::infinity();
  /// The kinetic and the stored energy of the whole scene [J], of the two MATs of a pair alone where
  /// every law without a largest slope belongs to a set.
  double energy = std::numeric_limits<double>::infinity();
  bool of_pairs = false;  ///< the energy is that of a pair

  bool is_infinite() const noexcept { return energy == std::numeric_limits<double>::infinity(); }
};

/// The Reach of the start, its energies raised by up to a million as long as the step is certified.
/// Infinite where every law has a largest slope, and where the step is not certified. O(liaisons).
ReachLimit reach_limit(const engine::NetworkDescription& network);

}  // namespace cordis::plan
