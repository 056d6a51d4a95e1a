// sim_node/engine/pairs/neighbour_list.h -- which members of a set may be in range of which.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim_node/engine/core/aligned_vector.h"
#include "sim_node/engine/pairs/cell_grid.h"
#include "sim_node/engine/pairs/pair_kernel.h"

namespace cordis::engine {

/// The pairs between members 0..P-1 and members P..P+Q-1, or within 0..P-1 when Q is 0, that may
/// be nearer than the range, each once: row a holds the later members b, in ascending order. That
/// order does not depend on when and with which skin the list was made.
///
/// The list holds all pairs that were nearer than range + skin when it was made, and is made again
/// when a member has moved by more than skin / 2 since. Until then two members have come nearer by
/// at most twice that, the skin: so no pair in range is missing. (Differences of coordinates,
/// squares and sums are each within 2^-53 of exact, and the comparisons leave a margin of 1e-9.)
/// The skin follows the speed of the fastest member, to keep the time of a step short.
///
/// Room is made once, for `capacity` entries. When they do not suffice, the list first does without
/// skin, and then is made part by part in each step, as many rows at a time as there is room for:
/// slow, but with the same pairs in the same order.
class NeighbourList {
 public:
  /// @param range     [m], > 0
  /// @param capacity  entries it has room for; at least as many as one row can have are made
  NeighbourList(std::size_t count_p, std::size_t count_q, int dimension, double range,
                std::size_t capacity, const PairKernel& kernel);

  /// Sets the skin [m] and keeps it, instead of following the speed: for tests.
  void hold_skin(double skin) noexcept;
  /// Forgets where the members were: after positions were set from outside.
  void forget() noexcept { valid_ = false; }

  /// Makes the list fit for the present positions, 4 x (P + Q) values with a multiple of 8 columns.
  /// Real time: O(members) while it still is; O(members + entries) when it is made again; no
  /// allocation. Positions that are not finite are in no pair.
  void refresh(const double* position) noexcept;

  /// The first part of the rows, with `first < last`, or none.
  NeighbourRows first_rows(const double* position) noexcept;
  /// The part after that; none after the last.
  NeighbourRows rows_after(const NeighbourRows& rows, const double* position) noexcept;

  bool is_whole() const noexcept { return whole_; }  ///< one part holds all rows
  double skin() const noexcept { return skin_; }     ///< [m]
  std::size_t build_count() const noexcept { return build_count_; }
  /// How many pairs it found when it was last made, whether or not there was room for them.
  std::size_t entry_count() const noexcept { return start_[count_p_]; }
  /// The number of others that were nearer than range + skin to one member then.
  std::uint32_t pair_count(std::size_t member) const noexcept {
    const std::size_t later = member < count_p_ ? start_[member + 1] - start_[member] : 0;
    return found_count_[member] + static_cast<std::uint32_t>(later);
  }
  std::size_t capacity() const noexcept { return capacity_; }

 private:
  std::size_t member_count() const noexcept { return count_p_ + count_q_; }
  double reach_square() const noexcept;
  void choose_skin() noexcept;
  void build(const double* position) noexcept;
  /// Finds all pairs, keeps them in found_ as far as there is room and counts those of each row.
  /// @return how many
  std::size_t find_all(const double* position) noexcept;
  std::size_t find_all_within(std::size_t total) noexcept;
  std::size_t record_found(std::size_t b, std::size_t count, std::size_t total) noexcept;
  std::size_t find_before(std::size_t b, const double* position, std::size_t first,
                          std::size_t last, std::uint32_t* found) const noexcept;
  void sort_found() noexcept;
  NeighbourRows part_from(std::size_t first, const double* position) noexcept;

  std::size_t count_p_;
  std::size_t count_q_;
  int dimension_;
  double range_;
  std::size_t capacity_;
  const PairKernel* kernel_;
  CellGrid grid_;
  std::vector<std::size_t> start_;          // by row; one past the last too
  std::vector<std::size_t> fill_;           // by row: where its next entry goes
  std::vector<std::uint32_t> found_count_;  // by later member
  std::vector<std::size_t> found_begin_;    // in found_, by later member
  std::vector<std::uint32_t> found_;        // earlier members of each pair, by the later one
  std::vector<std::uint32_t> neighbour_;    // columns
  AlignedVector<double> from_;              // positions when it was made
  double skin_;
  bool holds_skin_ = false;
  bool valid_ = false;
  bool whole_ = true;
  std::size_t age_ = 0;  // refreshes since it was made
  std::size_t build_count_ = 0;
  double last_move_square_ = 0.0;  // largest, when it was found too old [m^2]
};

}  // namespace cordis::engine
