// device_node/end_effector_map.cpp
#include "device_node/end_effector_map.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace cordis::device {
namespace {

constexpr double kSmallestPivot = 1e-9;  // relative to the largest entry

/// Solves (A A^T) y = A column by column, in place, by elimination with pivots.
void solve(std::vector<std::vector<double>>& gram, std::vector<std::vector<double>>& right) {
  const std::size_t n = gram.size();
  double largest = 0.0;
  for (const auto& row : gram) {
    for (const double entry : row) largest = std::max(largest, std::abs(entry));
  }
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    for (std::size_t r = k + 1; r < n; ++r) {
      if (std::abs(gram[r][k]) > std::abs(gram[pivot][k])) pivot = r;
    }
    if (!(std::abs(gram[pivot][k]) > kSmallestPivot * largest)) {
      throw std::invalid_argument("the coordinates of the end-effector map depend on each other");
    }
    std::swap(gram[k], gram[pivot]);
    std::swap(right[k], right[pivot]);
    for (std::size_t r = 0; r < n; ++r) {
      if (r == k) continue;
      const double factor = gram[r][k] / gram[k][k];
      for (std::size_t c = k; c < n; ++c) gram[r][c] -= factor * gram[k][c];
      for (std::size_t c = 0; c < right[r].size(); ++c) right[r][c] -= factor * right[k][c];
    }
  }
  for (std::size_t k = 0; k < n; ++k) {
    for (double& entry : right[k]) entry /= gram[k][k];
  }
}

}  // namespace

EndEffectorMap::EndEffectorMap(int axis_count)
    : coordinate_count_(axis_count), axis_count_(axis_count) {
  for (std::size_t a = 0; a < static_cast<std::size_t>(axis_count); ++a) {
    map_[a][a] = 1.0;
    inverse_[a][a] = 1.0;
  }
}

EndEffectorMap::EndEffectorMap(const std::vector<std::vector<double>>& map, int axis_count)
    : coordinate_count_(static_cast<int>(map.size())), axis_count_(axis_count), identity_(false) {
  const auto axes = static_cast<std::size_t>(axis_count);
  if (map.empty() || map.size() > kMaxCoordinates || map.size() > axes) {
    throw std::invalid_argument(
        "an end-effector map has 1 to 12 coordinates, and no more than axes");
  }
  std::vector<std::vector<double>> gram(map.size(), std::vector<double>(map.size(), 0.0));
  for (std::size_t r = 0; r < map.size(); ++r) {
    if (map[r].size() != axes) {
      throw std::invalid_argument(
          "each coordinate of an end-effector map needs one number per axis");
    }
    for (std::size_t c = 0; c < map.size(); ++c) {
      for (std::size_t a = 0; a < axes && map[c].size() == axes; ++a) {
        gram[r][c] += map[r][a] * map[c][a];
      }
    }
    std::copy(map[r].begin(), map[r].end(), map_[r].begin());
  }
  std::vector<std::vector<double>> inverse = map;
  solve(gram, inverse);
  for (std::size_t r = 0; r < map.size(); ++r) {
    std::copy(inverse[r].begin(), inverse[r].end(), inverse_[r].begin());
  }
}

namespace {

template <class Matrix>
AxisValues times(const Matrix& matrix, const AxisValues& axes, int rows) noexcept {
  AxisValues result{};
  for (std::size_t r = 0; r < static_cast<std::size_t>(rows); ++r) {
    for (std::size_t a = 0; a < axes.size(); ++a) result[r] += matrix[r][a] * axes[a];
  }
  return result;
}

template <class Matrix>
AxisValues transposed_times(const Matrix& matrix, const AxisValues& coordinates,
                            int rows) noexcept {
  AxisValues result{};
  for (std::size_t r = 0; r < static_cast<std::size_t>(rows); ++r) {
    for (std::size_t a = 0; a < result.size(); ++a) result[a] += matrix[r][a] * coordinates[r];
  }
  return result;
}

}  // namespace

AxisValues EndEffectorMap::coordinates_of(const AxisValues& axis_m) const noexcept {
  return identity_ ? axis_m : times(map_, axis_m, coordinate_count_);
}

AxisValues EndEffectorMap::axis_forces_of(const AxisValues& coordinate_n) const noexcept {
  return identity_ ? coordinate_n : transposed_times(map_, coordinate_n, coordinate_count_);
}

AxisValues EndEffectorMap::axes_of(const AxisValues& coordinate_m) const noexcept {
  return identity_ ? coordinate_m : transposed_times(inverse_, coordinate_m, coordinate_count_);
}

AxisValues EndEffectorMap::coordinate_forces_of(const AxisValues& axis_n) const noexcept {
  return identity_ ? axis_n : times(inverse_, axis_n, coordinate_count_);
}

}  // namespace cordis::device
