// sim_node/engine/simd/simd_lanes.h -- what a type of lanes offers to the loops over them.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>

#include "sim_node/engine/core/vector_width.h"

namespace cordis::engine {

/// The registers of one vector width. A type of lanes stands in an unnamed namespace, so that every
/// function made of it belongs to the file that does so, and is never shared between widths.
///
/// Row: one value of each of kWidth links, aligned in memory; Mask: one bit of each. Row3: their
/// vectors x, y, z. Column: the 4 values of one MAT. Each + - * is rounded by itself: no operation
/// may be contracted or reordered.
template <class Lanes>
concept SimdLanes = requires(double value, double* out, const double* in,
                             const std::uint32_t* offset, std::uint32_t bits,
                             typename Lanes::Row row, typename Lanes::Mask mask,
                             typename Lanes::Row3 vectors, typename Lanes::Column column) {
  requires kBatchRows % Lanes::kWidth == 0;
  requires sizeof(row) == Lanes::kWidth * sizeof(double);
  row = row + row - row * row;
  { Lanes::zero() } -> std::same_as<typename Lanes::Row>;
  { Lanes::load(in) } -> std::same_as<typename Lanes::Row>;
  { Lanes::every(value) } -> std::same_as<typename Lanes::Row>;
  { Lanes::sqrt(row) } -> std::same_as<typename Lanes::Row>;
  { Lanes::minimum(row, row) } -> std::same_as<typename Lanes::Row>;
  { Lanes::maximum(row, row) } -> std::same_as<typename Lanes::Row>;
  { Lanes::magnitude(row) } -> std::same_as<typename Lanes::Row>;
  Lanes::store(out, row);
  // values that need not be aligned
  { Lanes::load_any(in) } -> std::same_as<typename Lanes::Row>;
  Lanes::store_any(out, row);
  // all lanes moved up by one, the last lane of the row before as the first
  { Lanes::shifted(row, row) } -> std::same_as<typename Lanes::Row>;
  // comparisons as IEEE 754 asks, and what is made of them
  { Lanes::less(row, row) } -> std::same_as<typename Lanes::Mask>;
  { Lanes::less_or_equal(row, row) } -> std::same_as<typename Lanes::Mask>;
  { Lanes::equal(row, row) } -> std::same_as<typename Lanes::Mask>;
  { Lanes::not_equal(row, row) } -> std::same_as<typename Lanes::Mask>;
  { Lanes::both(mask, mask) } -> std::same_as<typename Lanes::Mask>;
  { Lanes::either(mask, mask) } -> std::same_as<typename Lanes::Mask>;
  { Lanes::mask(bits) } -> std::same_as<typename Lanes::Mask>;
  { Lanes::bits(mask) } -> std::same_as<std::uint32_t>;
  { Lanes::select(mask, row, row) } -> std::same_as<typename Lanes::Row>;
  // 1 / length, but 0 where the square is 0
  { Lanes::inverse_or_zero(row, row) } -> std::same_as<typename Lanes::Row>;
  // vectors from the columns at a to those at b: of one set of columns, of two, and their first
  // components
  { Lanes::difference(in, offset, offset) } -> std::same_as<typename Lanes::Row3>;
  Lanes::differences(in, in, offset, offset, vectors, vectors);
  { Lanes::difference_1d(in, offset, offset) } -> std::same_as<typename Lanes::Row>;
  // one link after the other: += at a, -= at b
  Lanes::add_pairs(out, offset, offset, vectors);
  Lanes::add_pairs_1d(out, offset, offset, row);
  column = column + column - column * column;
  { Lanes::load_column(in) } -> std::same_as<typename Lanes::Column>;
  { Lanes::broadcast(value) } -> std::same_as<typename Lanes::Column>;
  { Lanes::unite(column, column) } -> std::same_as<typename Lanes::Column>;  // or, bit by bit
  { Lanes::is_zero(column) } -> std::same_as<bool>;
  { Lanes::sum_column(column) } -> std::same_as<double>;
  Lanes::store_column(out, column);
};

/// Lanes for the pairs of a set.
template <class Lanes>
concept SimdPairLanes = SimdLanes<Lanes> &&
    requires(double* out, std::uint32_t* places, const double* in, const std::uint32_t* offset,
             unsigned chosen, typename Lanes::Row row, typename Lanes::Row3 vectors) {
  // columns that begin at `at`, or follow one another, as x, y, z
  { Lanes::vectors(in, offset) } -> std::same_as<typename Lanes::Row3>;
  { Lanes::neighbours(in) } -> std::same_as<typename Lanes::Row3>;
  // subtracts vectors and their fourth values from the columns at `at`, one after the other
  Lanes::subtract(out, offset, vectors, row);
  // subtracts vectors from columns that follow one another; copies such columns
  Lanes::subtract_from_neighbours(out, vectors);
  Lanes::copy_neighbours(out, in);
  // writes vectors and their fourth values as columns that follow one another
  Lanes::store_columns(out, vectors, row);
  // the sums of the 8 places of a batch of x, y, z and w: ((0 + 4) + (2 + 6)) + ((1 + 5) + (3 + 7))
  { Lanes::sum_batch(&row, &row, &row, &row) } -> std::same_as<typename Lanes::Column>;
  // writes the chosen lanes one after the other, kWidth values in all
  Lanes::pack(out, row, chosen);
  Lanes::pack(places, offset, chosen);
};

}  // namespace cordis::engine
