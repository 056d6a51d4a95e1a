// tests/integration/scenes.h -- small scenes with exact answers, and devices for them.
#pragma once

#include <string>

#include "tests/support/filled.h"

namespace cordis::test {

/// A key of role mass that a spring holds at its rest: force = -stiffness x position.
inline std::string wall_scene(double stiffness_n_per_m) {
  return R"(cordis: 1
name: wall
space: 1
step: {rate_hz: 4000, gesture_rate_hz: 1000, integrator: cordis}
liaisons:
  wall: {kind: spring, stiffness_n_per_m: )" +
         std::to_string(stiffness_n_per_m) +
         R"(}
matter:
  ground: {kind: fixed, at_m: [0]}
  bob: {kind: mass, mass_kg: 1, at_m: [0.1]}
ports:
  key: {device: keyboard, axes: [0], role: mass, coupling: direct, at_m: [0]}
links:
  - {liaison: wall, between: [key, ground]}
)";
}

/// A mass of 0.1 kg on a damped spring of 100 N/m, pushed by a key of role liaison: at rest
/// position = force / 100.
inline std::string pushed_mass_scene() {
  return R"(cordis: 1
name: pushed
space: 1
step: {rate_hz: 4000, gesture_rate_hz: 1000, integrator: cordis}
liaisons:
  holder: {kind: spring_damper, stiffness_n_per_m: 100, viscosity_n_s_per_m: 4}
matter:
  ground: {kind: fixed, at_m: [0]}
ports:
  key: {device: keyboard, axes: [0], role: liaison, mass_kg: 0.1, at_m: [0]}
links:
  - {liaison: holder, between: [key, ground]}
)";
}

/// A key of role mass on a corner of a net of 19,800 links, whose steps threads can share; 4 steps a tick.
inline std::string large_net_scene() {
  return R"(cordis: 1
name: large_net
space: 1
step: {rate_hz: 4000, gesture_rate_hz: 1000, integrator: cordis}
liaisons:
  thread: {kind: spring_damper, stiffness_n_per_m: 1000, viscosity_n_s_per_m: 0.05}
matter:
  net: {kind: grid, rows: 100, columns: 100, mass_kg: 0.01, stiffness_n_per_m: 1000, viscosity_n_s_per_m: 0.05}
ports:
  key: {device: keyboard, axes: [0], role: mass, coupling: direct, at_m: 0}
links:
  - {liaison: thread, between: [key, "net[0]"]}
)";
}

/// A scripted key, up to its positions.
inline const char* const kScriptedKey = R"(cordis: 1
axes: 1
travel_m: 0.04
rest: top
rate_hz: 1000
driver: script
script:
  interpolation: linear
  positions:
)";

/// A scripted key that moves to a position, or pushes with a force, and stays.
inline std::string steady_key(double position_m, double force_n) {
  return std::string(kScriptedKey) +
         filled(R"(    - {at_s: 0, m: 0}
    - {at_s: 0.2, m: <position_m>}
  forces:
    - {at_s: 0, n: 0}
    - {at_s: 0.2, n: <force_n>}
)",
                {{"position_m", std::to_string(position_m)}, {"force_n", std::to_string(force_n)}});
}

inline const char* const kSimAndKey =
    R"(  sim: {node: sim_node, scene: scene.yaml}
  keyboard: {node: device_node, device: key.yaml}
)";

}  // namespace cordis::test
