// sim_node/engine/vec.h -- the shapes the engine computes with.
#pragma once

#include <Eigen/Core>

namespace cordis::engine {

using Vec3 = Eigen::Vector3d;

/// 4 x N, column i belonging to MAT i: x, y, z and a pad that stays 0, each column 32-byte aligned.
using Columns = Eigen::Matrix<double, 4, Eigen::Dynamic>;

}  // namespace cordis::engine
