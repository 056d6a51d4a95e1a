// tests/scene/scene_text.h -- scenes written down in tests.
#pragma once

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "sim_node/scene/sections/scene_reader.h"

namespace cordis::scene {

/// The first three lines of a scene; what follows begins at line 4.
inline std::string scene_head(int space) {
  return "cordis: 1\nspace: " + std::to_string(space) + "\nstep: {rate_hz: 1000}\n";
}

/// A scene that must load without a word.
inline Scene sound_scene(int space, const std::string& body) {
  config::Problems problems;
  Scene scene = load_scene_text(scene_head(space) + body, "t", problems);
  EXPECT_EQ(problems.text(), "");
  return scene;
}

/// A scene with one bob of matter besides, so that it has a mass to move.
inline Scene scene_with_bob(int space, const std::string& matter, const std::string& rest = {}) {
  const std::string place = space == 1 ? "0" : space == 2 ? "[0, 9]" : "[0, 9, 9]";
  return sound_scene(space, "matter:\n" + matter +
                                "  bob: {kind: mass, mass_kg: 1, at_m: " + place + "}\n" + rest);
}

/// The smallest distance between two MATs of the scene [m].
inline double smallest_distance(const Scene& scene) {
  double smallest = 1e9;
  const auto& mats = scene.network.mats;
  for (std::size_t a = 0; a < mats.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b)
      smallest = std::min(smallest, (mats[a].position - mats[b].position).norm());
  }
  return smallest;
}

}  // namespace cordis::scene
