// sim_node/engine/pairs/pair_block.cpp
#include "sim_node/engine/pairs/pair_block.h"

#include <algorithm>

namespace cordis::engine {

PairBlock::PairBlock(std::size_t pairs_of_row, std::size_t rows)
    : capacity_(padded(std::min(kEnough, pairs_of_row * rows) + pairs_of_row, kPairBatch) +
                kPairBatch),
      start_(rows + 1, 0),
      column_a_(capacity_, 0U),
      column_b_(capacity_, 0U),
      values_(kArrayCount * capacity_, 0.0) {}

void PairBlock::begin(std::size_t first_row) noexcept {
  first_ = first_row;
  last_ = first_row;
  count_ = 0;
  start_[0] = 0;
}

void PairBlock::end_row_of(std::size_t member, std::size_t pairs) noexcept {
  std::fill_n(column_a_.begin() + static_cast<std::ptrdiff_t>(count_), pairs,
              static_cast<std::uint32_t>(4 * member));
  count_ += pairs;
  ++last_;
  start_[last_ - first_] = count_;
}

std::size_t PairBlock::take_rows(const PairKernel& kernel, const MemberColumns& members,
                                 const NeighbourRows& rows, double range_square) noexcept {
  const std::size_t taken = kernel.gather_rows(
      members, rows, range_square,
      {row_at(0), column_a_.data(), start_.data() + 1, kEnough, start_.size() - 1});
  last_ += taken;
  count_ = start_[taken];
  return taken;
}

void PairBlock::pad(const MemberColumns& members) noexcept {
  const PairRow row = row_at(0);
  for (std::size_t i = count_; i < padded_count(); ++i) {
    row.column[i] = members.padding + 4 * static_cast<std::uint32_t>(i % kPairBatch);
    column_a_[i] = row.column[i];
    for (double* values : {row.x, row.y, row.z, row.square}) values[i] = 0.0;
    rest_length()[i] = 0.0;
  }
}

/// The last row may begin in the middle of a batch: so its last lanes lie beyond the padding. They give zeros, but a
/// zero that is given to a member of another thread can undo what that thread gives to it.
void PairBlock::redirect(const MemberColumns& members) noexcept {
  for (std::size_t i = 0; i < count_ + kPairBatch; ++i) {
    if (i >= count_ || column_b_[i] >= members.end)
      column_b_[i] = members.padding + 4 * static_cast<std::uint32_t>(i % kPairBatch);
  }
}

std::size_t PairBlock::padded_count() const noexcept {
  return padded(count_, kPairBatch);
}

PairRows PairBlock::rows() noexcept {
  return {row_at(0), column_a_.data(),
          count_,    first_,
          last_,     start_.data(),
          {},        {array(kForces), array(kForces + 1), array(kForces + 2), array(kForces + 3)}};
}

PairRow PairBlock::row_at(std::size_t pair) noexcept {
  const auto column_of = [this, pair](Array which) { return array(which) + pair; };
  return {column_b_.data() + pair, column_of(kX),
          column_of(kY),           column_of(kZ),
          column_of(kSquare),      column_of(kLength),
          column_of(kInverse),     column_of(kElongationIncrement)};
}

}  // namespace cordis::engine
