// sim_node/engine/matter/mat_layout.h -- where the arrays of a world store the values of a MAT.
#pragma once

#include <cstddef>
#include <cstdint>

#include "sim_node/engine/core/aligned_vector.h"
#include "sim_node/engine/core/vec.h"

namespace cordis::engine {

/// Component `axis` of MAT i is stored at i * mat_stride + axis * axis_stride.
///
/// By MAT, the default, the arrays are 4 x N: column i belongs to MAT i, 32-byte aligned, its fourth
/// value 0. Any two MATs are two columns away from each other, which suits links between any of them.
/// By axis a row holds all x, the next all y, the next all z. Neighbouring MATs then fill a vector
/// register without a transpose. Behind each row there is room for a batch that begins at the last
/// MAT; the values there are 0.
struct MatLayout {
  std::size_t mat_stride = 4;
  std::size_t axis_stride = 1;

  static MatLayout by_axis(std::size_t mat_count) noexcept {
    std::size_t stride = padded(mat_count + kBatchRows, kBatchRows);
    // Rows a multiple of 4 KiB apart would share the same sets of the cache.
    constexpr std::size_t kContended = 4096 / sizeof(double);
    constexpr std::size_t kApart = 8 * kBatchRows;
    if (stride % kContended < kApart) stride += kApart;
    return {1, stride};
  }

  bool is_by_axis() const noexcept { return mat_stride == 1; }
  std::size_t value_count(std::size_t mat_count) const noexcept {
    return is_by_axis() ? 3 * axis_stride : mat_stride * mat_count;
  }

  std::size_t offset(std::size_t mat, std::size_t axis = 0) const noexcept {
    return mat * mat_stride + axis * axis_stride;
  }
  std::uint32_t mat_of(std::size_t offset) const noexcept {
    return static_cast<std::uint32_t>(is_by_axis() ? offset % axis_stride : offset / mat_stride);
  }
  std::uint32_t axis_of(std::size_t offset) const noexcept {
    return static_cast<std::uint32_t>(is_by_axis() ? offset / axis_stride : offset % mat_stride);
  }

  Vec3 vector(const double* values, std::size_t mat) const noexcept {
    const double* x = values + mat * mat_stride;
    return {x[0], x[axis_stride], x[2 * axis_stride]};
  }
  void set_vector(double* values, std::size_t mat, const Vec3& vector) const noexcept {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      values[offset(mat, axis)] = vector[static_cast<Eigen::Index>(axis)];
    }
  }
};

}  // namespace cordis::engine
