// tests/engine/struck_chain.h -- a chain that rests until it is struck, and how it is frozen.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "tests/engine/scenes.h"

namespace cordis::test {

inline constexpr double kPeak = 0.01;  ///< height of the stroke below [m]

/// A chain of masses of 1 g along x, 1 cm apart, on soft springs to fixed points beside it, between
/// a fixed point and a port, which is the last MAT.
inline NetworkDescription bedded_chain(std::uint32_t count, int dimension = 1) {
  NetworkDescription scene;
  scene.dimension = dimension;
  scene.step = 1e-3;
  scene.medium_viscosity = 0.01;
  scene.mats.push_back(fixed(Vec3::Zero()));
  for (std::uint32_t i = 1; i <= count; ++i) scene.mats.push_back(mass(1e-3, {0.01 * i, 0, 0}));
  scene.mats.push_back(port({0.01 * (count + 1), 0, 0}));
  for (std::uint32_t i = 0; i <= count; ++i) {
    scene.links.push_back({i, i + 1, 500.0, 0.01, 0.01});
  }
  for (std::uint32_t i = 1; i <= count; ++i) {
    const auto ground = static_cast<std::uint32_t>(scene.mats.size());
    scene.mats.push_back(fixed({0.01 * i - 0.02, 0, 0}));
    scene.links.push_back({ground, i, 3.0, 0.0, 0.02});
  }
  return scene;
}

/// One push of the port and back, in 60 steps.
inline void strike(World& world, std::uint32_t mat, const Vec3& rest) {
  const auto n = static_cast<double>(std::min<std::uint64_t>(world.step_count() + 1, 60));
  const double way = 0.5 * kPeak * (1.0 - std::cos(2.0 * 3.14159265358979323846 * n / 60.0));
  world.impose_position(mat, rest - Vec3(way, 0, 0));
}

inline NetworkDescription frozen(NetworkDescription scene, double tolerance) {
  scene.freeze_tolerance = tolerance;
  return scene;
}

}  // namespace cordis::test
