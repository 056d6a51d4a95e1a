// tests/sim/loaded_scenes.h -- small scenes, loaded, to play.
#pragma once

#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "node/config/name_hash.h"
#include "sim_node/run/loaded_scene.h"
#include "sim_node/scene/sections/scene_reader.h"

namespace cordis::sim {

inline constexpr std::uint64_t kEpochOfSim = 77;

/// A mass that swings between two walls, and a key pressed against it; 4 steps per tick.
inline std::string swing_text(const std::string& name = "swing", double gesture_rate_hz = 1000.0) {
  return "cordis: 1\nname: " + name +
         R"(
space: 1
step: {rate_hz: 4000, gesture_rate_hz: )" +
         std::to_string(gesture_rate_hz) +
         R"(}
liaisons: {spring: {kind: spring_damper, stiffness_n_per_m: 100, viscosity_n_s_per_m: 0.1}}
matter:
  wall: {kind: fixed, at_m: 0}
  bob: {kind: mass, mass_kg: 0.1, at_m: 0.01}
ports:
  key: {device: keyboard, axes: [0], role: mass, coupling: direct, at_m: 0}
links:
  - {liaison: spring, between: [wall, bob], rest_m: 0}
  - {liaison: spring, between: [key, bob], rest_m: 0}
signals:
  height: {of: bob, quantity: position}
)";
}

inline std::shared_ptr<const scene::Scene> scene_of(const std::string& text) {
  config::Problems problems;
  auto scene = std::make_shared<scene::Scene>(scene::load_scene_text(text, "t", problems));
  EXPECT_EQ(problems.text(), "");
  return scene;
}

inline std::unique_ptr<LoadedScene> loaded_scene_of(const std::string& text,
                                                    std::uint64_t version = 1) {
  return std::make_unique<LoadedScene>(scene_of(text), kEpochOfSim, version);
}

/// What the keyboard sends.
inline msg::GesturePositions key_sample(std::uint64_t number, double position_m) {
  msg::GesturePositions sample;
  sample.device_id(config::name_hash("keyboard"));
  sample.epoch(5);
  sample.sample(number);
  sample.axis_count(1);
  sample.position_m().fill(0.0);
  sample.position_m()[0] = position_m;
  return sample;
}

}  // namespace cordis::sim
