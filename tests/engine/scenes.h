// tests/engine/scenes.h -- networks that several tests are made of.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include "sim_node/engine/description/network.h"
#include "sim_node/engine/world.h"

namespace cordis::test {

using engine::Link;
using engine::Mat;
using engine::MatKind;
using engine::NetworkDescription;
using engine::Vec3;
using engine::VectorWidth;
using engine::World;

inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

inline World make_world(NetworkDescription description,
                        VectorWidth width = engine::best_vector_width()) {
  return World(std::make_shared<const engine::Network>(std::move(description)), width);
}

inline void run(World& world, int step_count) {
  for (int n = 0; n < step_count; ++n) world.step();
}

inline Mat mass(double mass_kg, const Vec3& position, const Vec3& velocity = Vec3::Zero()) {
  return {MatKind::kMass, mass_kg, position, velocity};
}

inline Mat fixed(const Vec3& position) {
  return {MatKind::kFixed, 0.0, position, Vec3::Zero()};
}

inline Mat port(const Vec3& position) {
  return {MatKind::kPort, 0.0, position, Vec3::Zero()};
}

/// The largest coordinate [m] that a MAT has had in so many steps; when it is beyond 1e100, that.
inline double largest_excursion(NetworkDescription scene, int steps = 5000) {
  World world = make_world(std::move(scene));
  double largest = 0.0;
  for (int n = 0; n < steps && largest < 1e100; ++n) {
    world.step();
    largest = std::max(largest, world.positions().cwiseAbs().maxCoeff());
  }
  return largest;
}

/// MAT 0 fixed at 0, MAT 1 a mass at x0 with the speed v0, one spring-damper of rest length 0; 1
/// dimension.
inline NetworkDescription oscillator(double mass_kg, double stiffness, double viscosity, double x0,
                                     double v0, double step) {
  NetworkDescription scene;
  scene.dimension = 1;
  scene.step = step;
  scene.mats = {fixed(Vec3::Zero()), mass(mass_kg, Vec3(x0, 0, 0), Vec3(v0, 0, 0))};
  scene.links = {{0, 1, stiffness, viscosity, 0.0}};
  return scene;
}

/// A string along x in 3 dimensions: `count` masses 1 cm apart between two fixed ends, pulled to
/// twice their rest length, plucked sideways along y to a triangle with its apex at a third.
inline NetworkDescription string_in_space(std::uint32_t count, double viscosity, double step) {
  NetworkDescription scene;
  scene.dimension = 3;
  scene.step = step;
  const std::uint32_t apex = (count + 1) / 3;
  for (std::uint32_t i = 0; i < count + 2; ++i) {
    const double rise = i <= apex ? static_cast<double>(i) / apex
                                  : static_cast<double>(count + 1 - i) / (count + 1 - apex);
    const Vec3 position(0.01 * i, 0.02 * rise, 0.0);
    scene.mats.push_back(i == 0 || i == count + 1 ? fixed(position) : mass(0.001, position));
  }
  for (std::uint32_t i = 0; i <= count; ++i) {
    scene.links.push_back({i, i + 1, 400.0, viscosity, 0.005});
  }
  return scene;
}

/// `count` masses in a cube of 1 m, free, moving, each joined to some others by spring-dampers.
inline NetworkDescription free_cluster(std::uint32_t count, std::uint32_t link_count,
                                       double viscosity, int dimension = 3) {
  NetworkDescription scene;
  scene.dimension = dimension;
  scene.step = 1e-3;
  std::mt19937 random(7);
  const auto uniform = [&random](double low, double high) {
    return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
  };
  const auto within = [&](double low, double high) {
    Vec3 vector = Vec3::Zero();
    for (int axis = 0; axis < dimension; ++axis) vector[axis] = uniform(low, high);
    return vector;
  };
  for (std::uint32_t i = 0; i < count; ++i) {
    const Vec3 velocity = within(-1.0, 1.0);  // in an order that no compiler chooses
    const Vec3 position = within(0.0, 1.0);
    scene.mats.push_back(mass(uniform(0.05, 0.2), position, velocity));
  }
  while (scene.links.size() < link_count) {
    const auto a = static_cast<std::uint32_t>(random() % count);
    const auto b = static_cast<std::uint32_t>(random() % count);
    if (a != b) scene.links.push_back({a, b, uniform(10.0, 100.0), viscosity, uniform(0.1, 0.5)});
  }
  return scene;
}

/// A MAT of the scene follows a function from its place.
inline void drive_mat(NetworkDescription& scene, std::uint32_t mat, engine::TimeFunction function) {
  engine::Drive drive;
  drive.mat = mat;
  drive.function = static_cast<std::uint32_t>(scene.time_functions.size());
  drive.origin = scene.mats[mat].position;
  scene.time_functions.push_back(std::move(function));
  scene.drives.push_back(drive);
  scene.mats[mat].kind = MatKind::kPort;
  scene.mats[mat].position = start_of(scene, drive);
}

/// 30 masses in a medium on heavy dampers alone, and one damper to `end`, MAT 30: no work of springs can be wrong.
inline NetworkDescription cluster_on_dampers(const Mat& end) {
  NetworkDescription scene = free_cluster(30, 90, 500.0);
  for (Link& link : scene.links) link.stiffness = 0.0;
  scene.integrator = engine::IntegratorKind::kLeapfrog;
  scene.medium_viscosity = 1.0;
  scene.mats.push_back(end);
  scene.links.push_back({3, 30, 0.0, 200.0, 0.0});
  return scene;
}

}  // namespace cordis::test
