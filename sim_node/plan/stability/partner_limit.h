// sim_node/plan/stability/partner_limit.h -- how many others a member of a set may touch before the
// certificate of a step ends.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "sim_node/engine/description/network.h"
#include "sim_node/plan/stability/liaison_graph.h"

namespace cordis::plan {

/// The numbers of partners of one set, at the step of its network.
struct PartnerLimit {
  std::uint32_t set = 0;       ///< index in NetworkDescription::sets
  std::uint32_t at_start = 0;  ///< the most partners of any mass at the start
  /// Partners of each member, those of the first set first: stable in every pose and state in which
  /// no member has more at once.
  std::vector<std::uint32_t> certified;
  /// By member: no pose whatever has more, or it is no mass.
  std::vector<std::uint8_t> guaranteed;
  /// The least and the most of what is certified, of those that are not guaranteed; 0 without such.
  std::uint32_t least = 0;
  std::uint32_t most = 0;

  /// True if no pose whatever has more partners.
  bool is_guaranteed() const noexcept {
    return std::find(guaranteed.begin(), guaranteed.end(), 0) == guaranteed.end();
  }
};

/// The limits of all sets: the numbers that the graph has times the largest factors, to 1 %, with which a row
/// bound of the step stays below 4. All sets are raised together by half, then one after the other; so
/// many large sets that this takes minutes are raised together alone.
/// Not below the numbers of the graph where `holds`, for then these are certified. O(liaisons).
/// @param graph  without weights, of this network
/// @param holds  the certified step of the graph is above that of the network
std::vector<PartnerLimit> partner_limits(const engine::NetworkDescription& network,
                                         const LiaisonGraph& graph, bool holds);

/// The graph with the certified numbers of partners in the place of those needed.
LiaisonGraph with_certified_partners(LiaisonGraph graph, const std::vector<PartnerLimit>& limits);

}  // namespace cordis::plan
