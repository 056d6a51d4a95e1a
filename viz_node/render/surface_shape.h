// viz_node/render/surface_shape.h -- surfaces of a scene as faces and edges, as in the page
#pragma once

#include <cstddef>
#include <vector>

#include "idl/scene.h"
#include "viz_node/render/view_camera.h"

namespace cordis::viz {

/// A flat convex face. Its corners [m] go counterclockwise for a viewer on its outer side.
struct SurfaceFace {
  std::vector<Point> corners;
  Point normal;  ///< unit vector, outwards
};

/// A line of a surface [m].
struct SurfaceEdge {
  Point from;
  Point to;
  std::size_t face = 0;  ///< the two faces that it joins; both 0 in a backdrop
  std::size_t other_face = 0;
  bool is_sharp = true;  ///< false: seen as an outline alone
};

struct SurfaceShape {
  /// A plane, the inner sides of a hollow body, or a section of a flat scene: it stands behind all matter.
  bool is_backdrop = true;
  std::vector<SurfaceFace> faces;
  std::vector<SurfaceEdge> edges;
};

/// The shapes of the surfaces around a scene in `home`. A plane is a grid as large as the scene, cut
/// off where another plane is. What has no bound in a direction reaches past the scene. A scene of one
/// or two dimensions has sections: lines with their inner side hatched, and filled outlines. A hollow body shows
/// its inner sides, in a flat scene its outline; what stands for an inner face by itself is empty.
/// @param space  dimensions of the scene, 1 to 3
std::vector<SurfaceShape> shapes_of(const std::vector<msg::SurfaceDescription>& surfaces,
                                    const Box& home, std::uint32_t space);

/// The box around `matter` and the surfaces. What is unbounded counts by its nearest place, and only
/// up to ten times the size of the matter away.
Box bounds_with(const std::vector<msg::SurfaceDescription>& surfaces, const Box& matter,
                std::uint32_t space);

/// Share of its colour that a face with this normal shows, 0.6 to 1: lit from above the left shoulder.
double light_on_surface(const Point& normal) noexcept;

}  // namespace cordis::viz
