// sim_node/scene/matter/placement.h -- where a part of a scene is put.
#pragma once

#include "node/config/mapping_reader.h"
#include "sim_node/engine/core/vec.h"
#include "sim_node/scene/scene.h"

namespace cordis::scene {

/// A turn about the origin, then a shift; in 1-D a shift, and another of what is drawn.
struct Placement {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  engine::Vec3 shift = engine::Vec3::Zero();  ///< [m]
  LayoutPoint layout_shift;                   ///< [m]

  engine::Vec3 operator()(const engine::Vec3& point) const { return turn * point + shift; }

  /// What is placed by `inner`, placed by this.
  Placement operator*(const Placement& inner) const;
};

/// `translate_m` and, in 2-D, `rotate_deg`, in 3-D, `rotate: {axis, deg}`, in 1-D,
/// `layout_translate_m`. A quarter turn is exact.
Placement read_placement(config::MappingReader& reader, int space, config::Problems& problems);

}  // namespace cordis::scene
