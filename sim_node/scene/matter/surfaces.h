// sim_node/scene/matter/surfaces.h -- fixed bodies that matter touches.
#pragma once

#include "sim_node/scene/matter/placement.h"
#include "sim_node/scene/matter/source.h"

namespace cordis::scene {

/// Each is one fixed MAT with a shape, a polyline one for each of its segments, a hollow box or cylinder one for its
/// outside and one for each inner face. Whatever is wrong is a problem; then the result is not to be used.
GeneratedMatter read_plane_surface(Source& source);
GeneratedMatter read_box(Source& source);
GeneratedMatter read_cylinder(Source& source);
GeneratedMatter read_polyline(Source& source);

/// Turns a surface about its own point. @return false for a box that would not lie along the axes
[[nodiscard]] bool turn_surface(const Placement& placement, int space, engine::Surface& surface);

}  // namespace cordis::scene
