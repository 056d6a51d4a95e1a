// sim_node/plan/stability/scene_box.cpp
#include "sim_node/plan/stability/scene_box.h"

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "node/assert.h"
#include "sim_node/engine/description/surface.h"
#include "sim_node/plan/stability/link_ends.h"

namespace cordis::plan {
namespace {

/// How far a surface reaches from its centre along each axis, where it has an end [m].
engine::Vec3 extent_of(const engine::Surface& surface) {
  const auto if_finite = [](double extent) { return std::isfinite(extent) ? extent : 0.0; };
  const engine::Vec3& half = surface.half_size;
  switch (surface.kind) {
    case engine::SurfaceKind::kBox:
    case engine::SurfaceKind::kBoxFace:
      return half.unaryExpr(if_finite);
    case engine::SurfaceKind::kCylinder:
    case engine::SurfaceKind::kCylinderWall:
    case engine::SurfaceKind::kCylinderEnd: {
      const engine::Vec3 across =
          (1.0 - surface.axis.array().square()).max(0.0).sqrt().matrix() * if_finite(half[0]);
      return across + surface.axis.cwiseAbs() * if_finite(half[1]);
    }
    case engine::SurfaceKind::kSegment:
      return surface.axis.cwiseAbs() * if_finite(half[0]);
    case engine::SurfaceKind::kPlane:
      break;
  }
  return engine::Vec3::Zero();
}

/// The box about all MATs and surfaces at the start.
struct Box {
  engine::Vec3 lowest;
  engine::Vec3 highest;
};

Box box_of(const engine::NetworkDescription& network) {
  CORDIS_ASSERT(!network.mats.empty());
  Box box{network.mats.front().position, network.mats.front().position};
  const auto take = [&](const engine::Vec3& place, const engine::Vec3& extent) {
    box.lowest = box.lowest.cwiseMin(place - extent);
    box.highest = box.highest.cwiseMax(place + extent);
  };
  for (const engine::Mat& mat : network.mats) take(mat.position, engine::Vec3::Zero());
  for (const engine::Surface& surface : network.surfaces)
    take(network.mats[surface.mat].position, extent_of(surface));
  return box;
}

}  // namespace

double diagonal_of(const engine::NetworkDescription& network) {
  const Box box = box_of(network);
  return (box.highest - box.lowest).norm();
}

std::vector<double> falls_of(const engine::NetworkDescription& network) {
  const Box box = box_of(network);
  const double diagonal = (box.highest - box.lowest).norm();
  std::vector<bool> is_held(network.mats.size(), false);
  visit_links(network, [&](std::uint32_t a, std::uint32_t b) { is_held[a] = is_held[b] = true; });
  std::vector<double> falls(network.mats.size(), 0.0);
  for (std::size_t i = 0; i < falls.size(); ++i) {
    const engine::Mat& mat = network.mats[i];
    if (mat.kind != engine::MatKind::kMass) continue;
    const engine::Vec3 gravity = network.gravity_on(mat);
    const double at_the_bottom =
        gravity.cwiseProduct(box.lowest).cwiseMax(gravity.cwiseProduct(box.highest)).sum();
    falls[i] = mat.mass *
               (is_held[i] ? gravity.norm() * diagonal : at_the_bottom - gravity.dot(mat.position));
  }
  return falls;
}

}  // namespace cordis::plan
