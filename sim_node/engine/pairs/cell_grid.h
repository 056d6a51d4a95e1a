// sim_node/engine/pairs/cell_grid.h -- points sorted into cells, to find those near another.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "sim_node/engine/core/aligned_vector.h"
#include "sim_node/engine/pairs/pair_kernel.h"

namespace cordis::engine {

/// True if x, y and z are finite.
bool is_finite_point(const double* point) noexcept;

/// Sorts points of unbounded space into cells.
///
/// Cells are cubes a little longer than the reach, numbered by the whole number of cell lengths
/// along each axis, and kept in a table of few by few by few cells that repeats itself through
/// space: a cell far away shares its entry with a near one. So whatever is within reach of a point
/// stands in the 3 cells around it along each axis, each in an entry of its own, and what else
/// stands there is distinguished by its distance. A point that flies away costs nothing, a point that
/// is not finite is left out.
///
/// Proof of "within reach": let |x - x'| <= reach along an axis. A cell is (1 + 2^-8) reach long
/// and coordinates beyond 2^40 cells count as 2^40; so the cell coordinates, computed with a
/// relative error below 2^-51 each, differ by less than (1 + 2^-8)^-1 + 2^-10 < 1, and their whole
/// parts by at most 1.
class CellGrid {
 public:
  /// A row of neighbouring cells.
  struct Run {
    std::size_t begin = 0;
    std::size_t end = 0;
  };
  /// Members of the cells around a point: 9 rows, each in 2 parts where the table repeats itself.
  struct NeighbourCells {
    std::array<Run, 18> runs;
    std::size_t count = 0;
  };

  /// @param capacity   the most points it will be given
  /// @param dimension  axes in use
  CellGrid(std::size_t capacity, int dimension);

  /// Sorts the points, 4 x count values. Real time: O(count), no allocation.
  void fill(const double* position, std::size_t count, double reach) noexcept;

  /// Where everything within reach of a point is, as far as its number is below `last`; much that
  /// is not may be there too. Precondition: the point is finite.
  NeighbourCells around(const double* point, std::size_t last) const noexcept;
  /// Members of the cells around any point of a cell.
  NeighbourCells around_cell(std::size_t cell, std::size_t last) const noexcept;

  /// Cells are numbered from 0; in each the points stand by their numbers, ascending.
  std::size_t cell_count() const noexcept { return extent_[0] * extent_[1] * extent_[2]; }
  std::size_t begin_of(std::size_t cell) const noexcept { return begin_[cell]; }
  std::size_t end_of(std::size_t cell) const noexcept { return begin_[cell + 1]; }
  /// The cell that holds a place, 0 for one past the last. Real time: O(log cells).
  std::size_t cell_of_place(std::size_t place) const noexcept;
  CellTable table() const noexcept;

 private:
  static constexpr int kAxes = 3;

  void choose_extent(const double* position, std::size_t count) noexcept;
  std::int64_t cell_along(double coordinate) const noexcept;
  std::size_t cell_of(const double* point) const noexcept;
  void add_run(NeighbourCells& found, std::size_t first, std::size_t end,
               double last) const noexcept;

  int dimension_;
  double cells_per_metre_ = 0.0;
  std::array<std::size_t, kAxes> extent_{1, 1, 1};  // of the table, powers of two
  std::size_t max_cells_;
  std::vector<std::size_t> begin_;   // by cell of the table; one past the last too
  std::vector<std::uint32_t> cell_;  // by point; kNoCell when it is not finite
  AlignedVector<double> x_;
  AlignedVector<double> y_;
  AlignedVector<double> z_;
  AlignedVector<double> number_;
  AlignedVector<std::uint32_t> member_;
};

}  // namespace cordis::engine
