// sim_node/engine/core/vec.h -- the shapes the engine computes with.
#pragma once

#include <cstddef>

#include <Eigen/Core>

#include "sim_node/engine/core/aligned_vector.h"

namespace cordis::engine {

using Vec3 = Eigen::Vector3d;

/// A view of 4 x N values, column i belonging to MAT i: x, y, z and a pad that stays 0, each column
/// 32-byte aligned. It shows the values of its owner, always the present ones, and owns nothing:
/// copy what must stay as it is.
using Columns = Eigen::Map<const Eigen::Matrix<double, 4, Eigen::Dynamic>, Eigen::Aligned32>;

/// Sums in the order x, y, z, on every machine.
inline double dot(const Vec3& u, const Vec3& v) noexcept {
  return u.x() * v.x() + u.y() * v.y() + u.z() * v.z();
}

/// The vector of a MAT in 4 x N values.
inline Eigen::Map<Vec3> column(AlignedVector<double>& columns, std::size_t mat) noexcept {
  return Eigen::Map<Vec3>(columns.data() + 4 * mat);
}
inline Eigen::Map<const Vec3> column(const AlignedVector<double>& columns,
                                     std::size_t mat) noexcept {
  return Eigen::Map<const Vec3>(columns.data() + 4 * mat);
}

}  // namespace cordis::engine
