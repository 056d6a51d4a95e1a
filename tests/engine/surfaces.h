// tests/engine/surfaces.h -- surfaces of a network, and matter that they stop.
#pragma once

#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "tests/engine/balls.h"

namespace cordis::test {

using engine::Surface;
using engine::SurfaceKind;

inline constexpr double kNoEnd = std::numeric_limits<double>::infinity();

/// Adds a fixed MAT with this shape. @return its number
inline std::uint32_t add_surface(NetworkDescription& scene, Surface surface, const Vec3& centre) {
  surface.mat = static_cast<std::uint32_t>(scene.mats.size());
  scene.mats.push_back(fixed(centre));
  if (!scene.radius.empty()) scene.radius.push_back(0.0);
  scene.surfaces.push_back(surface);
  return surface.mat;
}

inline Surface plane(const Vec3& normal, bool both_sides = false) {
  return {SurfaceKind::kPlane, 0, normal, Vec3::Zero(), both_sides};
}

inline Surface box(const Vec3& half_size) {
  return {SurfaceKind::kBox, 0, Vec3::UnitY(), half_size};
}

inline Surface cylinder(const Vec3& axis, double radius, double half_length = kNoEnd) {
  return {SurfaceKind::kCylinder, 0, axis, Vec3(radius, half_length, 0.0)};
}

/// Adds a hollow box or cylinder. @return the numbers of its outside and its inner faces
inline std::vector<std::uint32_t> add_hollow(NetworkDescription& scene, const Surface& body,
                                             const Vec3& centre) {
  std::vector<std::uint32_t> numbers;
  for (const Surface& surface : engine::hollow_surfaces(body))
    numbers.push_back(add_surface(scene, surface, centre));
  return numbers;
}

inline Surface segment(const Vec3& axis, double half_length) {
  return {SurfaceKind::kSegment, 0, axis, Vec3(half_length, 0.0, 0.0)};
}

/// Random numbers, places and shapes.
struct Chance {
  explicit Chance(unsigned seed) : random(seed) {}
  double operator()(double low, double high) {
    return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
  }
  Vec3 place(double reach, int dimension = 3) {
    Vec3 place = Vec3::Zero();
    for (int axis = 0; axis < dimension; ++axis) place[axis] = (*this)(-reach, reach);
    return place;
  }
  Surface shape(int dimension) {
    const auto kind = random() % (dimension == 1 ? 2 : dimension == 2 ? 4 : 3);
    if (kind == 3) return segment(place(1.0, 2).normalized(), (*this)(0.05, 0.4));
    if (kind == 0) return plane(place(1.0, dimension).normalized(), random() % 2 == 0);
    if (kind == 1) {
      Vec3 half = Vec3::Constant(kNoEnd);
      for (int axis = 0; axis < dimension; ++axis) half[axis] = (*this)(0.05, 0.4);
      return box(half);
    }
    if (dimension == 2) return cylinder(Vec3::UnitZ(), (*this)(0.05, 0.4));
    return cylinder(place(1.0).normalized(), (*this)(0.05, 0.4),
                    random() % 2 == 0 ? kNoEnd : (*this)(0.05, 0.4));
  }

  std::mt19937 random;
};

/// Adds the segments between these corners, of which no two turn by more than a right angle. @return their numbers
inline std::vector<std::uint32_t> add_polyline(NetworkDescription& scene,
                                               const std::vector<Vec3>& corners) {
  const bool is_closed = corners.front() == corners.back();
  std::vector<std::uint32_t> numbers;
  const std::size_t count = corners.size() - 1;
  const auto axis_of = [&](std::size_t i) {
    return Vec3((corners[i + 1] - corners[i]).normalized());
  };
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 side = corners[i + 1] - corners[i];
    Surface line = segment(side.normalized(), 0.5 * side.norm());
    if (is_closed || i > 0) line.comes_from = axis_of((i + count - 1) % count);
    if (is_closed || i + 1 < count) line.leads_to = axis_of((i + 1) % count);
    numbers.push_back(add_surface(scene, line, corners[i] + 0.5 * side));
  }
  return numbers;
}

/// Adds a set liaison of these surfaces with the MATs [0, balls).
inline void touch(NetworkDescription& scene, std::uint32_t balls, StateMachine state_machine,
                  double range, double rest_length, const std::vector<std::uint32_t>& surfaces) {
  SetLiaison set;
  set.state_machine = static_cast<std::uint32_t>(scene.state_machines.size());
  set.range = range;
  set.rest_length = rest_length;
  set.set_p = surfaces;
  for (std::uint32_t i = 0; i < balls; ++i) set.set_q.push_back(i);
  scene.state_machines.push_back(std::move(state_machine));
  scene.sets.push_back(set);
}

inline StateMachine of_one_state(const LinkState& state) {
  StateMachine state_machine;
  state_machine.name = "touching";
  state_machine.states = {state};
  return state_machine;
}

}  // namespace cordis::test
