// sim_node/engine/pairs/restored_rows.h -- whether restored rows of pairs are in order.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace cordis::engine {

/// Checks that each row holds later members than its own, of the other set where there are two, in
/// their order. The starts of the rows are checked first, then the columns of the pairs, in their order.
class RestoredRows {
 public:
  /// @param starts        takes the start of each row; one past the last row too
  /// @param count         of pairs
  /// @param first_later   the first member that may be the later one of a pair
  RestoredRows(std::vector<std::size_t>& starts, std::size_t count, std::size_t first_later,
               std::size_t member_count)
      : starts_(starts),
        count_(count),
        member_count_(member_count),
        before_first_(static_cast<std::uint32_t>(4 * (std::max<std::size_t>(1, first_later) - 1))),
        previous_(before_first_) {}

  bool takes_start(std::size_t row, std::size_t start) {
    starts_[row] = start;
    return (row == 0 ? start == 0 : start >= starts_[row - 1]) &&
           (row + 1 < starts_.size() || start == count_);
  }

  bool takes_column(std::size_t pair, std::uint32_t column) {
    while (pair >= starts_[row_ + 1]) previous_ = std::max(before_first_, 4 * ++row_);
    const bool follows = column > previous_ && column / 4 < member_count_;
    previous_ = column;
    return follows && column % 4 == 0;
  }

 private:
  std::vector<std::size_t>& starts_;
  std::size_t count_;
  std::size_t member_count_;
  std::uint32_t before_first_;  // column
  std::uint32_t previous_;      // column
  std::uint32_t row_ = 0;
};

}  // namespace cordis::engine
