// sim_node/scene/matter/icosphere.cpp
#include "sim_node/scene/matter/icosphere.h"

#include <array>
#include <cmath>
#include <map>

namespace cordis::scene {

namespace {

using engine::Vec3;
using Triangle = std::array<std::uint32_t, 3>;

constexpr std::array<Triangle, 20> kIcosahedron{
    {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
     {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
     {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};

std::vector<Vec3> corners_of_icosahedron() {
  const double golden = 0.5 * (1.0 + std::sqrt(5.0));
  std::vector<Vec3> corners;
  for (int axis = 0; axis < 3; ++axis) {  // three golden rectangles, one in each plane
    for (const double y : {golden, -golden}) {
      for (const double x : {-1.0, 1.0}) {
        Vec3 corner = Vec3::Zero();
        corner[axis] = x;
        corner[(axis + 1) % 3] = y;
        corners.push_back(corner / std::sqrt(1.0 + golden * golden));
      }
    }
  }
  return corners;
}

Edge in_order(std::uint32_t a, std::uint32_t b) {
  return a < b ? Edge{a, b} : Edge{b, a};
}

/// Divides every triangle into four.
std::vector<Triangle> divide(const std::vector<Triangle>& triangles, std::vector<Vec3>& points) {
  std::map<Edge, std::uint32_t> middles;
  const auto middle = [&](std::uint32_t a, std::uint32_t b) {
    const auto next = static_cast<std::uint32_t>(points.size());
    const auto [known, is_new] = middles.emplace(in_order(a, b), next);
    if (is_new) points.push_back((points[a] + points[b]).normalized());
    return known->second;
  };
  std::vector<Triangle> divided;
  for (const Triangle& t : triangles) {
    const std::uint32_t ab = middle(t[0], t[1]);
    const std::uint32_t bc = middle(t[1], t[2]);
    const std::uint32_t ca = middle(t[2], t[0]);
    for (const Triangle& part : {Triangle{t[0], ab, ca}, Triangle{t[1], bc, ab},
                                 Triangle{t[2], ca, bc}, Triangle{ab, bc, ca}})
      divided.push_back(part);
  }
  return divided;
}

}  // namespace

Icosphere icosphere(int subdivisions) {
  Icosphere sphere;
  sphere.points = corners_of_icosahedron();
  std::vector<Triangle> triangles(kIcosahedron.begin(), kIcosahedron.end());
  for (int i = 0; i < subdivisions; ++i) triangles = divide(triangles, sphere.points);

  std::map<Edge, std::uint32_t> far_corner_of_first;  // of the first triangle at each edge
  for (const Triangle& t : triangles) {
    for (std::size_t side = 0; side < 3; ++side) {
      const Edge edge = in_order(t[side], t[(side + 1) % 3]);
      const std::uint32_t far = t[(side + 2) % 3];
      const auto [known, is_new] = far_corner_of_first.emplace(edge, far);
      if (is_new) continue;
      sphere.edges.push_back(edge);
      sphere.across.emplace_back(known->second, far);
    }
  }
  return sphere;
}

}  // namespace cordis::scene
