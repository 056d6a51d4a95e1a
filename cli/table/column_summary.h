// cli/table/column_summary.h -- the least a person wants to know of a column.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include <nlohmann/json.hpp>

#include "node/assert.h"

namespace cordis::cli {

/// Least, largest, mean and root mean square of the finite values of a column, and the last value.
class ColumnSummary {
 public:
  void add(double value) noexcept {
    last_ = value;
    if (!std::isfinite(value)) return;
    ++count_;
    min_ = value < min_ ? value : min_;
    max_ = value > max_ ? value : max_;
    sum_ += value;
    sum_of_squares_ += value * value;
  }

  std::uint64_t count() const noexcept { return count_; }  ///< number of finite values
  double min() const noexcept { return min_; }
  double max() const noexcept { return max_; }
  double last() const noexcept { return last_; }
  double mean() const noexcept { return sum_ / static_cast<double>(count_); }
  double root_mean_square() const noexcept {
    return std::sqrt(sum_of_squares_ / static_cast<double>(count_));
  }

  /// Precondition: count() > 0.
  nlohmann::ordered_json json(const std::string& unit) const {
    CORDIS_ASSERT(count_ > 0);
    return {{"unit", unit},
            {"least", min()},
            {"largest", max()},
            {"mean", mean()},
            {"root_mean_square", root_mean_square()},
            {"last", last()}};
  }

 private:
  std::uint64_t count_ = 0;
  double min_ = std::numeric_limits<double>::infinity();
  double max_ = -std::numeric_limits<double>::infinity();
  double last_ = 0.0;
  double sum_ = 0.0;
  double sum_of_squares_ = 0.0;
};

}  // namespace cordis::cli
