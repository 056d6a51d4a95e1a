// tests/engine/random_runs.h -- random networks in runs, and a scalar loop over their links.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "sim_node/engine/links/link_runs.h"
#include "tests/engine/scenes.h"

namespace cordis::test {

/// Random networks of runs, broken runs and single links.
class RandomRuns {
 public:
  explicit RandomRuns(std::uint32_t seed) : random_(seed) {}

  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(random_()) / 4294967296.0);
  }
  std::uint32_t below(std::uint32_t count) { return static_cast<std::uint32_t>(random_() % count); }
  bool once_in(std::uint32_t count) { return below(count) == 0; }

  std::vector<Link> links(std::uint32_t mat_count) {
    std::vector<Link> links;
    const std::uint32_t run_count = 2 + below(6);
    for (std::uint32_t run = 0; run < run_count; ++run) {
      if (once_in(3)) {
        add_single(links, mat_count);
      } else {
        add_run(links, mat_count);
      }
    }
    return links;
  }

  /// @param mat_count  over 71
  NetworkDescription network(int dimension, std::uint32_t mat_count = 97) {
    NetworkDescription scene;
    scene.dimension = dimension;
    scene.step = 1e-3;
    if (once_in(2)) scene.medium_viscosity = 0.01;
    if (once_in(2)) scene.gravity.x() = 2.0;
    for (std::uint32_t i = 0; i < mat_count; ++i) {
      const Vec3 place = within(dimension, 0.0, 1.0);
      scene.mats.push_back(once_in(9) ? fixed(place)
                           : once_in(15)
                               ? port(place)
                               : mass(uniform(0.05, 0.2), place, within(dimension, -1.0, 1.0)));
    }
    scene.mats[4] = scene.mats[3];  // a link between them has no direction
    scene.links = links(mat_count);
    is_viscous_ = !once_in(4);
    same_ = once_in(2);
    for (Link& link : scene.links) choose_parameters(link);
    keep_off(scene);
    return scene;
  }

 private:
  Vec3 within(int dimension, double low, double high) {
    Vec3 vector = Vec3::Zero();
    for (int axis = 0; axis < dimension; ++axis) vector[axis] = uniform(low, high);
    return vector;
  }
  void add_single(std::vector<Link>& links, std::uint32_t mat_count) {
    const std::uint32_t a = below(mat_count);
    const std::uint32_t b = below(mat_count);
    if (a != b) links.push_back({a, b});
  }
  /// Adds 1 to 70 pairs (a + i, b + i), b above or below a; a fifth of them may be absent.
  void add_run(std::vector<Link>& links, std::uint32_t mat_count) {
    const std::uint32_t length = 1 + below(70);
    const std::uint32_t room = mat_count - length;
    std::uint32_t a = below(room);
    std::uint32_t b = once_in(2) ? a + 1 : below(room);
    if (a == b) ++b;
    if (once_in(6)) std::swap(a, b);
    const bool is_broken = once_in(3);
    const bool descends = once_in(8);
    for (std::uint32_t i = 0; i < length; ++i) {
      const std::uint32_t step = descends ? length - 1 - i : i;
      if (!is_broken || !once_in(5)) links.push_back({a + step, b + step});
    }
  }
  void choose_parameters(Link& link) {
    link.stiffness = same_ ? 40.0 : uniform(10.0, 100.0);
    link.viscosity = !is_viscous_ ? 0.0 : same_ ? 0.1 : uniform(0.0, 0.2);
    link.rest_length = same_ ? 0.3 : uniform(0.1, 0.5);
  }
  /// MATs that no link joins are where the square of a distance overflows.
  static void keep_off(NetworkDescription& scene) {
    std::vector<bool> is_joined(scene.mats.size(), false);
    for (const Link& link : scene.links) is_joined[link.mat_a] = is_joined[link.mat_b] = true;
    for (std::size_t i = 0; i < scene.mats.size(); ++i) {
      if (!is_joined[i]) scene.mats[i] = fixed(Vec3(i % 2 == 0 ? 1e200 : -1e300, 0, 0));
    }
  }

  std::mt19937 random_;
  bool is_viscous_ = true;
  bool same_ = true;
};

/// The scene with its links in the order in which a step takes them.
inline NetworkDescription in_order_of_step(NetworkDescription scene) {
  if (!engine::layout_of(scene).is_by_axis()) return scene;
  const std::vector<Link> links = scene.links;
  scene.links.clear();
  for (const std::uint32_t link : engine::order_in_runs(links).links)
    scene.links.push_back(links[link]);
  return scene;
}

/// The forces of linear links, one link after the other, in the order of the scene.
inline std::vector<Vec3> scalar_forces(const NetworkDescription& scene,
                                       const std::vector<Vec3>& position,
                                       const std::vector<Vec3>& delayed) {
  std::vector<Vec3> forces(scene.mats.size(), Vec3::Zero());
  for (const Link& link : scene.links) {
    const Vec3 along = position[link.mat_b] - position[link.mat_a];
    const Vec3 moved = along - (delayed[link.mat_b] - delayed[link.mat_a]);
    const double viscosity_over_dt = link.viscosity / scene.step;
    Vec3 force = Vec3::Zero();
    if (scene.dimension == 1) {
      force.x() = link.stiffness * (along.x() - link.rest_length) + viscosity_over_dt * moved.x();
    } else {
      const double square = along.x() * along.x() + along.y() * along.y() + along.z() * along.z();
      const double length = std::sqrt(square);
      const double inverse = square == 0.0 ? 0.0 : 1.0 / length;
      const double along_moved =
          along.x() * moved.x() + along.y() * moved.y() + along.z() * moved.z();
      const double elastic = link.stiffness * (length - link.rest_length) * inverse;
      const double viscous = viscosity_over_dt * (along_moved * inverse) * inverse;
      const double factor = elastic + viscous;
      force = Vec3(along.x() * factor, along.y() * factor, along.z() * factor);
    }
    forces[link.mat_a] += force;
    forces[link.mat_b] -= force;
  }
  return forces;
}

/// Adds a link with states between two more fixed points. The MATs are then stored by MAT, and all
/// links are gathered, in the order in which a step of the scene takes them.
inline NetworkDescription gathered(NetworkDescription scene) {
  scene = in_order_of_step(std::move(scene));
  const auto first = static_cast<std::uint32_t>(scene.mats.size());
  scene.mats.push_back(fixed(Vec3::Zero()));
  scene.mats.push_back(fixed(Vec3(1, 0, 0)));
  scene.state_machines.emplace_back();
  scene.state_machines[0].states.emplace_back();
  scene.state_links.push_back({first, first + 1, 0, 0.0});
  return scene;
}

inline void move_ports(const NetworkDescription& scene, World& world, int step) {
  for (std::uint32_t i = 0; i < scene.mats.size(); ++i) {
    if (scene.mats[i].kind != MatKind::kPort) continue;
    Vec3 moved = scene.mats[i].position;
    moved.x() += 1e-3 * (step % 40);
    world.impose_position(i, moved);
  }
}

inline std::vector<Vec3> positions_of(const World& world) {
  std::vector<Vec3> positions;
  for (std::uint32_t i = 0; i < world.network().mat_count(); ++i) {
    positions.push_back(world.position(i));
  }
  return positions;
}

}  // namespace cordis::test
