// sim_node/plan/stability/touch_sum.h -- what may touch one mass at once, added up.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "sim_node/engine/description/network.h"
#include "sim_node/plan/stability/liaison_graph.h"

namespace cordis::plan {

/// The liaisons that may take hold of one mass in the same step.
struct TouchSum {
  LiaisonId liaison;        ///< the one of them that counts the most
  double stiffness = 0.0;   ///< K' of all: dt^2 (sum of K / m + the largest K / m of an other end)
  bool is_several = false;  ///< it is not the only liaison of them
  double alone = 0.0;       ///< K' of that one
};

/// How balls that a ball meets between count: as those of one side, or as one of them.
enum class Packs : std::uint8_t { kAsOneSide, kAsOneBall };

/// By member of a side of a set: how many of its neighbours do not touch it from one side.
std::vector<double> apart_of(const engine::NetworkDescription& network,
                             const engine::SetLiaison& set, const ContactBound& side);

/// The mass whose touches come to the most. Linear links are none.
///
/// - Links with states add up at a mass; in 1 dimension those that push it, or pull it, the same way.
/// - Pairs of a set add up by the number of partners of the graph. Balls that lie around a ball as equal hard ones do
///   meet it from all sides: of N in d dimensions N / 2 d meet it from one. So do fixed points that are as far from each
///   other as they reach. More than such balls, and nearer points, may all be on one side.
/// - Surfaces add up by their normals: at most the largest sum of the cosines between one and those of its side.
///
/// O(liaisons + members). @param counts  true for a liaison that comes and goes
std::optional<TouchSum> largest_touch(const engine::NetworkDescription& network,
                                      const LiaisonGraph& graph,
                                      const std::function<bool(LiaisonId)>& counts,
                                      Packs packs = Packs::kAsOneSide);

}  // namespace cordis::plan
