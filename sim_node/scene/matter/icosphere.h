// sim_node/scene/matter/icosphere.h -- a sphere of triangles as equal as they can be.
#pragma once

#include <vector>

#include "sim_node/scene/matter/source.h"

namespace cordis::scene {

/// The corners of an icosahedron whose triangles have been divided into four, again and again.
struct Icosphere {
  std::vector<engine::Vec3> points;  ///< unit vectors; 10 * 4^subdivisions + 2
  std::vector<Edge> edges;           ///< 30 * 4^subdivisions
  std::vector<Edge> across;          ///< per edge, the far corners of its two triangles
};

/// @param subdivisions  0 for the icosahedron itself
Icosphere icosphere(int subdivisions);

}  // namespace cordis::scene
