// tests/plan/shapes.h -- surfaces at places, and how many of them a place may have in reach.
#pragma once

#include <vector>

#include "sim_node/plan/stability/surface_bound.h"
#include "tests/engine/surfaces.h"

namespace cordis::test {

inline constexpr double kReachOfShapes = 0.05;  // of the force [m]

/// Some surfaces and their centres.
struct Shapes {
  std::vector<Surface> surfaces;
  std::vector<Vec3> centres;

  Shapes& add(const Surface& surface, const Vec3& centre = Vec3::Zero()) {
    surfaces.push_back(surface);
    centres.push_back(centre);
    return *this;
  }
  Shapes& add_hollow(const Surface& body, const Vec3& centre = Vec3::Zero()) {
    for (const Surface& surface : engine::hollow_surfaces(body)) add(surface, centre);
    return *this;
  }
  double most(double reach = kReachOfShapes, int dimension = 3) const {
    return plan::max_surfaces_in_reach(surfaces, centres, reach, dimension);
  }
};

}  // namespace cordis::test
