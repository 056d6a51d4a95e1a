// tests/engine/rubbing.h -- scenes of contacts that rub.
#pragma once

#include <cmath>
#include <vector>

#include "tests/engine/programs.h"
#include "tests/engine/surfaces.h"

namespace cordis::test {

inline constexpr double kRadius = 0.05;
inline constexpr double kGravity = 9.81;

inline StateMachine rubbing(const LinkState& state, const engine::Friction& friction) {
  StateMachine state_machine = of_one_state(state);
  state_machine.friction = friction;
  return state_machine;
}

/// A ball of 1 kg on the floor y = 0 in 2 dimensions, pressed by a load [N] to where it floats.
inline NetworkDescription pressed_ball(double load, const engine::Friction& friction,
                                       double stiffness, double viscosity, double step) {
  NetworkDescription scene;
  scene.dimension = 2;
  scene.step = step;
  scene.mats = {mass(1.0, Vec3(0.0, kRadius - load / stiffness, 0.0))};
  scene.radius = {kRadius};
  const std::uint32_t floor = add_surface(scene, plane(Vec3::UnitY()), Vec3::Zero());
  touch(scene, 1, rubbing(contact(stiffness, viscosity), friction), kRadius, -1.0, {floor});
  return scene;
}

/// A block on an incline of this angle: the floor, and gravity turned.
inline NetworkDescription block_on_incline(double angle, const engine::Friction& friction,
                                           double step = 1e-4) {
  NetworkDescription scene = pressed_ball(kGravity * std::cos(angle), friction, 1e5, 100.0, step);
  scene.gravity = kGravity * Vec3(std::sin(angle), -std::cos(angle), 0.0);
  return scene;
}

/// Moving balls in a box of planes, all of them rubbing.
inline NetworkDescription rubbing_cloud(int dimension, unsigned seed, bool states = false) {
  constexpr double kSide = 0.6;
  NetworkDescription scene = cloud(40, 0.8 * kSide, 0.5, dimension, seed);
  scene.step = 2e-4;
  for (Mat& mat : scene.mats) mat.mass *= 0.1;
  const engine::Friction friction{0.7, 0.4, 200.0, 0.1};
  StateMachine pair = rubbing(contact(300.0, 0.05), friction);
  if (states) {
    pair.states.push_back(contact(200.0, 0.0));
    engine::Transition exit;
    exit.when = (q(engine::Quantity::kElongation) < Term(-0.01)).program;
    exit.target = 1;
    pair.exits = {exit};
    pair.states[0].last_exit = 1;
    pair.states[1].first_exit = pair.states[1].last_exit = 1;
  }
  SetLiaison set;
  set.state_machine = 0;
  set.range = 0.12;
  set.rest_length = -1.0;
  for (std::uint32_t i = 0; i < 40; ++i) set.set_p.push_back(i);
  scene.state_machines.push_back(pair);
  scene.sets.push_back(set);
  std::vector<std::uint32_t> walls;
  for (int axis = 0; axis < dimension; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      walls.push_back(add_surface(scene, plane(-side * Vec3::Unit(axis)),
                                  0.5 * side * kSide * Vec3::Unit(axis)));
    }
  }
  touch(scene, 40, rubbing(contact(400.0, 0.05), friction), 0.1, -1.0, walls);
  return scene;
}

}  // namespace cordis::test
