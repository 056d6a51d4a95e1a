// sim_node/engine/core/vec.h -- the shapes the engine computes with.
#pragma once

#include <Eigen/Core>

namespace cordis::engine {

using Vec3 = Eigen::Vector3d;

/// A view of 4 x N values, column i belonging to MAT i: x, y, z and a pad that stays 0, each column
/// 32-byte aligned. It shows the values of its owner, always the present ones, and owns nothing:
/// copy what must stay as it is.
using Columns = Eigen::Map<const Eigen::Matrix<double, 4, Eigen::Dynamic>, Eigen::Aligned32>;

}  // namespace cordis::engine
