// tests/engine/led_link.h -- a link of states between a fixed point and a port that leads it.
#pragma once

#include <utility>

#include "tests/engine/programs.h"
#include "tests/engine/scenes.h"

namespace cordis::test {

/// A port at x, joined to a fixed point at 0 by one link of a state machine; 1 dimension, dt = 0.01 s.
inline NetworkDescription led_link(StateMachine state_machine, double x, double rest_length,
                                   int dimension = 1) {
  NetworkDescription scene;
  scene.dimension = dimension;
  scene.step = 0.01;
  scene.mats = {fixed(Vec3::Zero()), port(Vec3(x, 0, 0))};
  scene.state_machines = {std::move(state_machine)};
  scene.state_links = {{0, 1, 0, rest_length}};
  return scene;
}

inline void lead(World& world, double x) {
  world.impose_position(1, Vec3(x, 0, 0));
  world.step();
}

}  // namespace cordis::test
