// sim_node/engine/connected_components.h -- how many connected components the balls of a set form.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "node/assert.h"
#include "node/disjoint_sets.h"
#include "sim_node/engine/core/aligned_vector.h"
#include "sim_node/engine/description/network.h"
#include "sim_node/engine/pairs/cell_grid.h"
#include "sim_node/engine/pairs/neighbour_list.h"
#include "sim_node/engine/pairs/pair_kernel.h"
#include "sim_node/engine/world.h"

namespace cordis::engine {

/// Counts connected components: two members of a set belong to one component when their pair is near, or
/// bound, or when a chain of such pairs leads from one to the other. A pair is one of the set
/// liaison: across its two sets, or within its one; of members that no liaison joins it is any two.
/// [Luc90 IX Experimentation] speaks of matter that shatters and regroups: this number
/// measures it.
class ConnectedComponents {
 public:
  /// @param set  index in NetworkDescription::sets
  /// @throws std::invalid_argument when the network has no such set.
  ConnectedComponents(const Network& network, std::size_t set);
  ConnectedComponents(const NetworkDescription& network, std::size_t set);
  /// Takes MATs that no set liaison need join: all pairs within `mats` count.
  /// @throws std::invalid_argument when the network has no such MAT, or one stands there twice.
  ConnectedComponents(const NetworkDescription& network, const std::vector<std::uint32_t>& mats);

  /// Keeps the pairs that are about so near [m], > 0, from one find_near() to the next while no
  /// member goes far: for who asks for the same distance again and again. Allocates.
  void keep_near(double distance);

  /// Finds the components of members nearer than a distance [m], > 0. A member that is not finite is a
  /// component of its own. Real time: O(members + pairs), no allocation. @return how many
  std::size_t find_near(const Columns& positions, double distance) noexcept;

  /// Finds the components of members in bound pairs, such as World::bound_pairs. Real time: O(members +
  /// pairs), no allocation. @return how many
  std::size_t find_bound(std::span<const BoundPair> pairs) noexcept;
  /// Finds the components by the bound pairs of a set of a world. Precondition: the set exists.
  std::size_t find_bound(const World& world, std::size_t set) noexcept;

  /// Finds the components of members joined by bound pairs of these sets, and by those of these links with
  /// states that are not idle in their present state. Real time: O(members + pairs + links), no
  /// allocation. Precondition: sets and links exist. @return how many
  std::size_t find_joined(const World& world, std::span<const std::uint32_t> sets,
                          std::span<const std::uint32_t> state_links) noexcept;

  /// Number of the component of a member as last found, from 0 in the order of their first members.
  std::uint32_t component_of(std::size_t member) const noexcept {
    CORDIS_ASSERT(member < component_.size());
    return component_[member];
  }
  /// MATs of the set, P and then Q.
  std::span<const std::uint32_t> members() const noexcept { return mat_; }

 private:
  ConnectedComponents(const NetworkDescription& network, const std::vector<std::uint32_t>& set_p,
                      const std::vector<std::uint32_t>& set_q);
  void join_kept(double distance) noexcept;
  void join_found(double distance) noexcept;
  void join_bound(const World& world, std::size_t set) noexcept;
  void join(const BoundPair& pair) noexcept;
  std::size_t number_components() noexcept;

  std::size_t count_p_;
  bool across_;  // two sets
  int dimension_;
  const PairKernel* kernel_;
  CellGrid grid_;
  std::vector<std::uint32_t> mat_;     // of each member
  std::vector<std::uint32_t> member_;  // of each MAT of the set
  node::DisjointSets joined_;          // of members
  std::vector<std::uint32_t> component_;
  std::vector<std::uint32_t> found_;
  AlignedVector<double> position_;  // 4 x members, padded to whole batches
  std::optional<NeighbourList> kept_;
  double kept_distance_ = 0.0;  // [m]
};

}  // namespace cordis::engine
