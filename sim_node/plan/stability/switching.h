// sim_node/plan/stability/switching.h -- the energy that changes of state bring into a scene.
#pragma once

#include <optional>
#include <vector>

#include "sim_node/engine/core/liaison_id.h"
#include "sim_node/engine/description/network.h"
#include "sim_node/plan/stability/reach.h"

namespace cordis::plan {

/// What the changes of state of links, of bends and of pairs of sets bring in, all together.
struct Switching {
  double all = 0.0;             ///< [J]
  std::vector<double> at_mats;  ///< the parts of it, each at one MAT of its liaison [J]
  /// A liaison of which nothing bounds what its changes bring in; that is not in `all`.
  std::optional<engine::LiaisonId> endless = {};
};

/// The energy that they bring in drives them, too. One liaison alone finds what it brought in itself, and each of several
/// what all bring in.
/// O(kinds of links, of bends and sets), each some thousand enclosures for each exit.
/// @param reach  of the network, without what changes of state bring in
Switching switching_of(const engine::NetworkDescription& network, const Reach& reach);

}  // namespace cordis::plan
