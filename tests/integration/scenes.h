// tests/integration/scenes.h -- small scenes with exact answers, and devices for them.
#pragma once

#include <string>

namespace cordis::test {

/// A key of role mass that a spring ties to its rest: force = -stiffness x position.
inline std::string wall_scene(double stiffness_n_per_m) {
  return "cordis: 1\nname: wall\nspace: 1\n"
         "step: {rate_hz: 4000, gesture_rate_hz: 1000, integrator: cordis}\n"
         "liaisons:\n  wall: {kind: spring, stiffness_n_per_m: " +
         std::to_string(stiffness_n_per_m) +
         "}\n"
         "matter:\n  ground: {kind: fixed, at_m: [0]}\n"
         "  bob: {kind: mass, mass_kg: 1, at_m: [0.1]}\n"
         "ports:\n  key: {device: keyboard, axes: [0], role: mass, coupling: direct, at_m: [0]}\n"
         "links:\n  - {liaison: wall, between: [key, ground]}\n";
}

/// A mass of 0.1 kg on a damped spring of 100 N/m, pushed by a key of role liaison: at rest
/// position = force / 100.
inline std::string pushed_mass_scene() {
  return "cordis: 1\nname: pushed\nspace: 1\n"
         "step: {rate_hz: 4000, gesture_rate_hz: 1000, integrator: cordis}\n"
         "liaisons:\n  holder: {kind: spring_damper, stiffness_n_per_m: 100, viscosity_n_s_per_m: "
         "4}\n"
         "matter:\n  ground: {kind: fixed, at_m: [0]}\n"
         "ports:\n  key: {device: keyboard, axes: [0], role: liaison, mass_kg: 0.1, at_m: [0]}\n"
         "links:\n  - {liaison: holder, between: [key, ground]}\n";
}

/// A scripted key that moves to a position, or pushes with a force, and stays.
inline std::string steady_key(double position_m, double force_n) {
  return "cordis: 1\naxes: 1\ntravel_m: 0.04\nrest: top\nrate_hz: 1000\ndriver: script\n"
         "script:\n  interpolation: linear\n  positions:\n    - {at_s: 0, m: 0}\n    - {at_s: 0.2, "
         "m: " +
         std::to_string(position_m) +
         "}\n  forces:\n    - {at_s: 0, n: 0}\n    - {at_s: 0.2, n: " + std::to_string(force_n) +
         "}\n";
}

inline const char* const kSimAndKey =
    "  sim: {node: sim_node, scene: scene.yaml}\n"
    "  keyboard: {node: device_node, device: key.yaml}\n";

}  // namespace cordis::test
