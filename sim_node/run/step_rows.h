// sim_node/run/step_rows.h -- the signals of the steps of one turn of the loop.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "node/assert.h"

namespace cordis::sim {

/// One row per step, with the signals that are taken after each of them. Real time: everything but
/// the constructor allocates nothing and does not throw.
class StepRows {
 public:
  StepRows() = default;
  /// @param rows  the most steps of a turn
  StepRows(std::size_t columns, std::size_t rows) : columns_(columns), values_(columns * rows) {}

  std::size_t columns() const noexcept { return columns_; }
  std::size_t count() const noexcept { return count_; }
  std::uint64_t first_step() const noexcept { return first_step_; }  ///< step of the first row
  const double* row(std::size_t index) const noexcept { return values_.data() + index * columns_; }

  void clear() noexcept { count_ = 0; }
  /// Room for the next row. Precondition: there is room. @param step  of the first one
  double* next(std::uint64_t step) noexcept {
    CORDIS_ASSERT((count_ + 1) * columns_ <= values_.size());
    if (count_ == 0) first_step_ = step;
    return values_.data() + columns_ * count_++;
  }

 private:
  std::size_t columns_ = 0;
  std::size_t count_ = 0;
  std::uint64_t first_step_ = 0;
  std::vector<double> values_;
};

}  // namespace cordis::sim
