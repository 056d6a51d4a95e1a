// tests/plan/networks.h -- networks whose limits are looked for.
#pragma once

#include <random>

#include "tests/engine/scenes.h"

namespace cordis::test {

/// A random network in 1 dimension, connected, stiffness and viscosity over decades of their own
/// (no proportional damping), one MAT fixed, some medium.
inline NetworkDescription random_network(unsigned seed) {
  std::mt19937 random(seed);
  const auto uniform = [&random] { return static_cast<double>(random()) / 4294967296.0; };
  const auto decades = [&](double lowest, double count) {
    return lowest * std::pow(10.0, count * uniform());
  };
  NetworkDescription scene;
  scene.dimension = 1;
  scene.step = 1e-3;
  scene.medium_viscosity = 0.01 * uniform();
  const auto count = static_cast<std::uint32_t>(6 + random() % 25);
  scene.mats.push_back(fixed(Vec3::Zero()));
  for (std::uint32_t i = 1; i < count; ++i) {
    scene.mats.push_back(mass(decades(0.01, 1.5), Vec3(uniform(), 0, 0)));
  }
  const auto join = [&](std::uint32_t a, std::uint32_t b) {
    scene.links.push_back({a, b, decades(1.0, 4.0), decades(1e-4, 4.0), 0.0});
  };
  for (std::uint32_t i = 1; i < count; ++i) join(static_cast<std::uint32_t>(random() % i), i);
  for (std::uint32_t extra = 0; extra < count; ++extra) {
    const auto a = static_cast<std::uint32_t>(random() % count);
    const auto b = static_cast<std::uint32_t>(random() % count);
    if (a != b) join(a, b);
  }
  return scene;
}

/// A state machine of one state: a spring and a law.
inline engine::StateMachine state_machine(double stiffness, engine::Law elasticity = {}) {
  engine::StateMachine machine;
  machine.states.emplace_back();
  machine.states[0].stiffness = stiffness;
  machine.states[0].elasticity = std::move(elasticity);
  return machine;
}

/// A spring that never pulls.
inline engine::StateMachine contact(double stiffness) {
  engine::StateMachine machine = state_machine(stiffness);
  machine.states[0].pulls = false;
  return machine;
}

}  // namespace cordis::test
