// sim_node/engine/pairs/pair_block.h -- pairs of several rows, taken together.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim_node/engine/core/aligned_vector.h"
#include "sim_node/engine/pairs/pair_kernel.h"

namespace cordis::engine {

/// Room for the pairs of some consecutive rows of a set, about as many as the caches nearest to the
/// processor hold, and for what is found of them. A ball has few later partners: a batch that ended
/// with its row would be half empty.
class PairBlock {
 public:
  explicit PairBlock(std::size_t member_count) : PairBlock(member_count, member_count) {}
  /// @param pairs_of_row  candidates for a row there may be at most @param rows  likewise
  PairBlock(std::size_t pairs_of_row, std::size_t rows);

  /// Pairs there may be at most.
  std::size_t capacity() const noexcept { return capacity_; }

  /// Empties it; the next row is `first_row`.
  void begin(std::size_t first_row) noexcept;
  /// Where the pairs of the next row go, as many as there are members.
  PairRow next_row() noexcept { return row_at(count_); }
  /// Closes the current row with `pairs` entries.
  void end_row(std::size_t pairs) noexcept { end_row_of(last_, pairs); }
  /// Likewise; the row is that of any member. Then rows are not numbered in order.
  void end_row_of(std::size_t member, std::size_t pairs) noexcept;
  /// Gathers rows from that of begin() on, until there are enough pairs. @return how many rows
  std::size_t take_rows(const PairKernel& kernel, const MemberColumns& members,
                        const NeighbourRows& rows, double range_square) noexcept;
  bool is_full() const noexcept { return count_ >= kEnough || last_ - first_ + 1 == start_.size(); }
  /// Pairs whose columns are `end` or beyond give their force to padding instead.
  void redirect(const MemberColumns& members) noexcept;
  /// Fills the last batch up. To be called after the last row.
  void pad(const MemberColumns& members) noexcept;

  std::size_t count() const noexcept { return count_; }  ///< pairs, without padding
  std::size_t padded_count() const noexcept;
  PairRows rows() noexcept;
  /// Row of the set by number, and where its pairs begin and end.
  std::size_t first() const noexcept { return first_; }
  std::size_t last() const noexcept { return last_; }
  std::size_t begin_of(std::size_t row) const noexcept { return start_[row - first_]; }
  std::size_t end_of(std::size_t row) const noexcept { return start_[row - first_ + 1]; }

  double* rest_length() noexcept { return array(kRestLength); }        ///< [m]
  double* factor() noexcept { return array(kFactor); }                 ///< tension / distance [N/m]
  double* viscous_factor() noexcept { return array(kViscousFactor); }  ///< for what is not stored

 private:
  static constexpr std::size_t kEnough = 1024;
  enum Array : std::size_t {
    kX,
    kY,
    kZ,
    kSquare,
    kLength,
    kInverse,
    kElongationIncrement,
    kRestLength,
    kFactor,
    kViscousFactor,
    kForces,
    kArrayCount = kForces + 4
  };

  double* array(std::size_t which) noexcept { return values_.data() + which * capacity_; }
  PairRow row_at(std::size_t pair) noexcept;

  std::size_t capacity_;
  std::size_t count_ = 0;
  std::size_t first_ = 0;
  std::size_t last_ = 0;
  std::vector<std::size_t> start_;         // by row from the first; one past the last too
  AlignedVector<std::uint32_t> column_a_;  // of each pair
  AlignedVector<std::uint32_t> column_b_;
  AlignedVector<double> values_;
};

}  // namespace cordis::engine
