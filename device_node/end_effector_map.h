// device_node/end_effector_map.h -- linear map from the axes to the coordinates of a handle.
#pragma once

#include <array>
#include <vector>

#include "device_node/axis.h"

namespace cordis::device {

inline constexpr int kMaxCoordinates = 12;  ///< most that an end-effector map may have

/// The morphology of a device as a linear map: coordinates of the handle q = A x, with x the
/// positions of the axes. Forces go the other way, f = A^T F, so that the power F dq = f dx is the
/// same on both sides. Where the handle is carried, x = A+ q with the pseudo-inverse
/// A+ = A^T (A A^T)^-1, and its forces are F = (A+)^T f.
///
/// The coordinates are the axes when there is no map. Source: [Luc90 V.1 Force feedback gestual
/// transducers], the end-effector maps fixed on the slices of the keyboard.
class EndEffectorMap {
 public:
  /// The axes themselves.
  explicit EndEffectorMap(int axis_count = 1);

  /// @param map  one row per coordinate, at most 12, each with one entry per axis; rows that do not
  ///             depend on each other
  /// @throws std::invalid_argument otherwise.
  EndEffectorMap(const std::vector<std::vector<double>>& map, int axis_count);

  int coordinate_count() const noexcept { return coordinate_count_; }
  int axis_count() const noexcept { return axis_count_; }

  // Entries beyond the counts are 0. Real time: O(axes x coordinates), no allocation.
  AxisValues coordinates_of(const AxisValues& axis_m) const noexcept;        ///< q = A x
  AxisValues axis_forces_of(const AxisValues& coordinate_n) const noexcept;  ///< f = A^T F
  AxisValues axes_of(const AxisValues& coordinate_m) const noexcept;         ///< x = A+ q
  AxisValues coordinate_forces_of(const AxisValues& axis_n) const noexcept;  ///< F = (A+)^T f

  /// True if the coordinates are the axes.
  bool is_identity() const noexcept { return identity_; }

  double entry(int coordinate, int axis) const noexcept {
    return map_[static_cast<std::size_t>(coordinate)][static_cast<std::size_t>(axis)];
  }

 private:
  using Matrix = std::array<AxisValues, kMaxAxes>;  // rows: coordinates

  int coordinate_count_;
  int axis_count_;
  bool identity_ = true;
  Matrix map_{};      // A
  Matrix inverse_{};  // (A+)^T
};

}  // namespace cordis::device
