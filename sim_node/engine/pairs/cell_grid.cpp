// sim_node/engine/pairs/cell_grid.cpp
#include "sim_node/engine/pairs/cell_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "node/assert.h"

namespace cordis::engine {
namespace {

constexpr std::uint32_t kNoCell = std::numeric_limits<std::uint32_t>::max();
constexpr double kFarthestCell = 1099511627776.0;  // 2^40
constexpr double kCellMargin = 1.0 + 1.0 / 256.0;
constexpr std::size_t kMinExtent = 4;  // so that 3 cells in a row have 3 places
constexpr std::size_t kSample = 256;
constexpr double kMaxCellsPerMetre = 1e300;  // so that 0 is in cell 0

std::size_t power_of_two_above(std::size_t value) noexcept {
  std::size_t power = 1;
  while (power < value) power *= 2;
  return power;
}

}  // namespace

bool is_finite_point(const double* point) noexcept {
  return std::isfinite(point[0]) && std::isfinite(point[1]) && std::isfinite(point[2]);
}

CellGrid::CellGrid(std::size_t capacity, int dimension)
    : dimension_(dimension),
      max_cells_(std::max<std::size_t>(64, power_of_two_above(2 * capacity))),
      begin_(max_cells_ + 1, 0),
      cell_(capacity, kNoCell),
      x_(capacity + kPairBatch, 0.0),
      y_(x_.size(), 0.0),
      z_(x_.size(), 0.0),
      number_(x_.size(), 0.0),
      member_(x_.size(), 0U) {}

void CellGrid::fill(const double* position, std::size_t count, double reach) noexcept {
  cells_per_metre_ = std::min(1.0 / (reach * kCellMargin), kMaxCellsPerMetre);
  choose_extent(position, count);
  const std::size_t cells = extent_[0] * extent_[1] * extent_[2];

  std::fill_n(begin_.begin(), cells + 1, std::size_t{0});
  for (std::size_t i = 0; i < count; ++i) {
    const double* point = position + 4 * i;
    cell_[i] = is_finite_point(point) ? static_cast<std::uint32_t>(cell_of(point)) : kNoCell;
    if (cell_[i] != kNoCell) ++begin_[cell_[i] + 1];
  }
  for (std::size_t c = 0; c < cells; ++c) begin_[c + 1] += begin_[c];

  // begin_[c] runs to the end of cell c and so becomes the beginning of cell c + 1 ...
  for (std::size_t i = 0; i < count; ++i) {
    if (cell_[i] == kNoCell) continue;
    const std::size_t slot = begin_[cell_[i]]++;
    x_[slot] = position[4 * i];
    y_[slot] = position[4 * i + 1];
    z_[slot] = position[4 * i + 2];
    number_[slot] = static_cast<double>(i);
    member_[slot] = static_cast<std::uint32_t>(i);
  }
  // ... so that all move up by one
  std::copy_backward(begin_.begin(), begin_.begin() + static_cast<std::ptrdiff_t>(cells),
                     begin_.begin() + static_cast<std::ptrdiff_t>(cells) + 1);
  begin_[0] = 0;
}

/// The table is as long along each axis as the bulk of the points takes cells, within its size: it
/// decides the time of a search alone, never its result.
void CellGrid::choose_extent(const double* position, std::size_t count) noexcept {
  std::array<double, kAxes> wanted{1.0, 1.0, 1.0};
  const std::size_t stride = std::max<std::size_t>(1, count / kSample);
  for (int axis = 0; axis < dimension_; ++axis) {
    std::array<double, 2 * kSample> sample;
    std::size_t size = 0;
    for (std::size_t i = 0; i < count && size < sample.size(); i += stride) {
      const double value = position[4 * i + static_cast<std::size_t>(axis)];
      if (std::isfinite(value)) sample[size++] = value;
    }
    if (size == 0) continue;
    const auto smallest = [&sample, size](std::size_t n) {  // the n-th, from 0
      const auto nth = sample.begin() + static_cast<std::ptrdiff_t>(n);
      std::nth_element(sample.begin(), nth, sample.begin() + static_cast<std::ptrdiff_t>(size));
      return *nth;
    };
    const double bulk = smallest(size - 1 - size / 32) - smallest(size / 32);
    wanted[static_cast<std::size_t>(axis)] = bulk * cells_per_metre_ + 2.0;
  }

  for (int axis = 0; axis < kAxes; ++axis) {
    extent_[static_cast<std::size_t>(axis)] = axis < dimension_ ? kMinExtent : 1;
  }
  while (2 * extent_[0] * extent_[1] * extent_[2] <= max_cells_) {
    std::size_t shortest = 0;
    double shortage = 1.0;
    for (std::size_t axis = 0; axis < kAxes; ++axis) {
      const double here = wanted[axis] / static_cast<double>(extent_[axis]);
      if (here > shortage) {
        shortage = here;
        shortest = axis;
      }
    }
    if (shortage <= 1.0) return;
    extent_[shortest] *= 2;
  }
}

std::int64_t CellGrid::cell_along(double coordinate) const noexcept {
  const double cell = std::clamp(coordinate * cells_per_metre_, -kFarthestCell, kFarthestCell);
  const auto whole = static_cast<std::int64_t>(cell);
  return whole - (static_cast<double>(whole) > cell ? 1 : 0);
}

std::size_t CellGrid::cell_of(const double* point) const noexcept {
  std::size_t cell = 0;
  for (std::size_t axis = kAxes; axis-- > 0;) {
    const auto along = static_cast<std::size_t>(cell_along(point[axis]));
    cell = cell * extent_[axis] + (along & (extent_[axis] - 1));
  }
  return cell;
}

/// Leaves out cells at both ends of the row in which all numbers are too large: in each cell they
/// ascend.
void CellGrid::add_run(NeighbourCells& found, std::size_t first, std::size_t end,
                       double last) const noexcept {
  const auto is_of_no_use = [this, last](std::size_t cell) {
    return begin_[cell] == begin_[cell + 1] || !(number_[begin_[cell]] < last);
  };
  while (first < end && is_of_no_use(first)) ++first;
  while (first < end && is_of_no_use(end - 1)) --end;
  if (first < end) found.runs[found.count++] = {begin_[first], begin_[end]};
}

CellGrid::NeighbourCells CellGrid::around(const double* point, std::size_t last) const noexcept {
  CORDIS_ASSERT(std::isfinite(point[0]) && std::isfinite(point[1]) && std::isfinite(point[2]));
  return around_cell(cell_of(point), last);
}

CellGrid::NeighbourCells CellGrid::around_cell(std::size_t cell, std::size_t last) const noexcept {
  CORDIS_ASSERT(cell + 1 < begin_.size());
  NeighbourCells found;
  const auto bound = static_cast<double>(last);
  const std::array<std::size_t, kAxes> index{cell % extent_[0], cell / extent_[0] % extent_[1],
                                             cell / extent_[0] / extent_[1]};
  const std::size_t wide_y = dimension_ > 1 ? 1 : 0;
  const std::size_t wide_z = dimension_ > 2 ? 1 : 0;
  const std::size_t x_first = (index[0] - 1) & (extent_[0] - 1);
  const std::size_t x_parts_end = std::min(x_first + 3, extent_[0]);
  for (std::size_t dz = 0; dz <= 2 * wide_z; ++dz) {
    const std::size_t z = (index[2] + dz - wide_z) & (extent_[2] - 1);
    for (std::size_t dy = 0; dy <= 2 * wide_y; ++dy) {
      const std::size_t y = (index[1] + dy - wide_y) & (extent_[1] - 1);
      const std::size_t row = (z * extent_[1] + y) * extent_[0];
      add_run(found, row + x_first, row + x_parts_end, bound);
      if (x_parts_end < x_first + 3) add_run(found, row, row + x_first + 3 - extent_[0], bound);
    }
  }
  return found;
}

std::size_t CellGrid::cell_of_place(std::size_t place) const noexcept {
  const auto first_end = begin_.begin() + 1;
  const auto last_end = first_end + static_cast<std::ptrdiff_t>(cell_count());
  const auto found = std::upper_bound(first_end, last_end, place);
  return found == last_end ? 0 : static_cast<std::size_t>(found - first_end);
}

CellTable CellGrid::table() const noexcept {
  return {x_.data(), y_.data(), z_.data(), number_.data(), member_.data()};
}

}  // namespace cordis::engine
