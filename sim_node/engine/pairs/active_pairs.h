// sim_node/engine/pairs/active_pairs.h -- which pairs of a set are computed where others rest.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim_node/engine/matter/mat_roles.h"
#include "sim_node/engine/pairs/neighbour_list.h"
#include "sim_node/engine/pairs/pair_state_machines.h"

namespace cordis::engine {

/// The pairs of a set as its members and its neighbour list have them now.
struct PairsOfSet {
  const std::vector<std::uint32_t>& column;  ///< column of each member's MAT
  const PairStateMachines& state_machines;
  NeighbourRows rows;  ///< all of them
};

/// The members and rows of a set that take part in a step: all at first.
///
/// Every choice is by the roles of the MATs. Pairs are computed where an end has kWholeForce; the
/// others of its row with it where pairs have states, for these are remembered row by row. Real
/// time: everything but the constructor is O(members + entries of the neighbour list) and allocates
/// nothing.
class ActivePairs {
 public:
  /// All forever.
  ActivePairs() = default;
  /// @param capacity  of the neighbour list
  ActivePairs(std::size_t member_count, std::size_t row_count, std::size_t capacity);

  /// Makes room for a longer neighbour list. Allocates. @return false without memory
  [[nodiscard]] bool make_room(std::size_t capacity) noexcept;

  void choose_all() noexcept { all_ = true; }
  /// All, though some rest; their MATs take part.
  void choose_all(const std::vector<std::uint32_t>& column, MatRoles& roles) noexcept;
  /// What the roles ask for; the members of those pairs take part.
  void choose(const PairsOfSet& pairs, MatRoles& roles) noexcept;

  /// Passes on between members that are near each other or bound.
  void pass_on(const PairsOfSet& pairs, const WakePropagation& pass, MatRoles& roles) noexcept;
  /// Passes on as if each were beside all others.
  void pass_to_all(const std::vector<std::uint32_t>& column, const WakePropagation& pass,
                   MatRoles& roles) noexcept;

  bool are_all() const noexcept { return all_; }
  /// Unless are_all(): those whose positions are taken, ascending ...
  const std::vector<std::uint32_t>& members() const noexcept { return members_; }
  /// ... and the rows that have pairs, of row_count() in all.
  const std::vector<NeighbourRows>& rows() const noexcept { return rows_; }
  std::size_t row_count() const noexcept { return start_.size() - 1; }

 private:
  void find_roles(const std::vector<std::uint32_t>& column, const MatRoles& roles) noexcept;
  void give_roles(const std::vector<std::uint32_t>& column, const WakePropagation& pass,
                  MatRoles& roles) const noexcept;
  bool is_row_whole(const PairsOfSet& pairs, std::size_t a) const noexcept;
  void add_row(const PairsOfSet& pairs, std::size_t a) noexcept;

  bool all_ = true;
  std::vector<std::uint8_t> role_;  // of each member, bits of MatRoles
  std::vector<std::uint32_t> members_;
  std::vector<NeighbourRows> rows_;
  std::vector<std::size_t> start_;        // of their pairs: by row; one past the last too
  std::vector<std::uint32_t> neighbour_;  // columns
};

}  // namespace cordis::engine
