// tests/engine/balls.h -- sets of balls, and the sum over all pairs they are held against.
#pragma once

#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "tests/engine/scenes.h"

namespace cordis::test {

using engine::Law;
using engine::LinkState;
using engine::SetLiaison;
using engine::StateMachine;

/// `count` free balls of radius 5 cm in a box of the given side along each axis, moving.
inline NetworkDescription cloud(std::uint32_t count, double side, double speed, int dimension,
                                std::uint32_t seed = 11) {
  NetworkDescription scene;
  scene.dimension = dimension;
  scene.step = 1e-3;
  std::mt19937 random(seed);
  const auto uniform = [&random](double low, double high) {
    return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
  };
  for (std::uint32_t i = 0; i < count; ++i) {
    Mat ball = mass(uniform(0.5, 2.0), Vec3::Zero());
    for (int axis = 0; axis < dimension; ++axis) {
      ball.position[axis] = uniform(-0.5 * side, 0.5 * side);
      ball.velocity[axis] = uniform(-speed, speed);
    }
    scene.mats.push_back(ball);
    scene.radius.push_back(uniform(0.03, 0.05));
  }
  return scene;
}

inline LinkState contact(double stiffness, double viscosity) {
  LinkState state;
  state.name = "contact";
  state.stiffness = stiffness;
  state.viscosity = viscosity;
  state.pulls = false;
  return state;
}

inline LinkState lennard_jones(double well_depth, double diameter, double cutoff) {
  LinkState state;
  state.elasticity = engine::LennardJones{well_depth, diameter, cutoff};
  return state;
}

/// Adds a set liaison without states; P is the MATs [0, split), Q those from there on, none:
/// within.
inline void add_set(NetworkDescription& scene, const LinkState& state, double range,
                    double rest_length, std::uint32_t split) {
  SetLiaison set;
  set.state_machine = static_cast<std::uint32_t>(scene.state_machines.size());
  set.range = range;
  set.rest_length = rest_length;
  for (std::uint32_t i = 0; i < scene.mats.size(); ++i) {
    (i < split ? set.set_p : set.set_q).push_back(i);
  }
  StateMachine state_machine;
  state_machine.name = "pair";
  state_machine.states = {state};
  scene.state_machines.push_back(state_machine);
  scene.sets.push_back(set);
}

}  // namespace cordis::test
