// tests/support/surfaces.h -- fixed surfaces: a floor, a wall, three steps and a post.
#pragma once

#include <string>
#include <vector>

#include "idl/scene.h"

namespace cordis::test {

inline msg::SurfaceDescription surface(const std::string& name, msg::SurfaceKind kind,
                                       std::vector<double> centre_m, std::vector<double> axis,
                                       std::vector<double> size_m) {
  msg::SurfaceDescription surface;
  surface.name(name);
  surface.kind(kind);
  surface.centre_m(std::move(centre_m));
  surface.axis(std::move(axis));
  surface.size_m(std::move(size_m));
  return surface;
}

/// Around 0.4 m of matter at the origin. A flat scene sees the floor, the wall and the steps from the
/// front, and the section of the post.
inline std::vector<msg::SurfaceDescription> steps_and_post() {
  return {surface("floor", msg::SURFACE_PLANE, {0.0, -0.15, 0.0}, {0.0, 1.0, 0.0}, {}),
          surface("wall", msg::SURFACE_PLANE, {-0.4, 0.0, 0.0}, {1.0, 0.0, 0.0}, {}),
          surface("step[0]", msg::SURFACE_BOX, {0.27, -0.125, 0.0}, {}, {0.06, 0.05, 0.2}),
          surface("step[1]", msg::SURFACE_BOX, {0.33, -0.1, 0.0}, {}, {0.06, 0.1, 0.2}),
          surface("step[2]", msg::SURFACE_BOX, {0.39, -0.075, 0.0}, {}, {0.06, 0.15, 0.2}),
          surface("post", msg::SURFACE_CYLINDER, {0.0, -0.05, 0.27}, {0.0, 1.0, 0.0}, {0.03, 0.2})};
}

}  // namespace cordis::test
