// tests/reduction/scenes.h -- scenes before and after their reductions.
#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "sim_node/engine/world.h"
#include "sim_node/plan/reduction/reduce.h"
#include "sim_node/scene/sections/scene_reader.h"

namespace cordis::plan {

inline scene::Scene loaded(const std::string& text) {
  config::Problems problems;
  scene::Scene scene = scene::load_scene_text(text, "t", problems);
  EXPECT_EQ(problems.text(), "");
  return scene;
}

inline scene::Scene reduced(const std::string& text) {
  config::Problems problems;
  scene::Scene scene = reduce(loaded(text), problems);
  EXPECT_EQ(problems.text(), "");
  return scene;
}

/// What is reported when the scene is reduced.
inline std::string refusal_of(const std::string& text) {
  config::Problems problems;
  scene::Scene scene = scene::load_scene_text(text, "t", problems);
  if (!problems.has_errors()) reduce(std::move(scene), problems);
  return problems.text();
}

/// The text of a scene with one liaison more, whose condition asks outside its links: `latch`.
inline std::string with_latch(std::string text, const std::string& condition) {
  text.insert(text.find("matter:"), "  latch: {states: {shut: {exits: [{to: open, when: \"" +
                                        condition + "\"}]}, open: {final: true}}}\n");
  return text;
}

/// The MATs of a name.
inline scene::NamedRange matter(const scene::Scene& scene, const std::string& name) {
  for (const scene::NamedRange& range : scene.matter) {
    if (range.name == name) return range;
  }
  ADD_FAILURE() << name;
  return {};
}

/// The signals after so many steps.
inline std::vector<double> signals_after(const scene::Scene& scene, int steps) {
  engine::World world(std::make_shared<const engine::Network>(scene.network));
  for (int n = 0; n < steps; ++n) world.step();
  std::vector<double> values(scene.signals.count());
  scene.signals.read(world, values.data());
  return values;
}

/// Where the MATs of a name are after each of so many steps, in one row.
inline std::vector<engine::Vec3> motion(const scene::Scene& scene, const std::string& name,
                                        int steps) {
  engine::World world(std::make_shared<const engine::Network>(scene.network));
  const scene::NamedRange mats = matter(scene, name);
  std::vector<engine::Vec3> row;
  for (int n = 0; n < steps; ++n) {
    world.step();
    for (std::uint32_t i = 0; i < mats.count; ++i) row.push_back(world.position(mats.first + i));
  }
  return row;
}

/// The largest distance between two motions.
inline double largest_difference(const std::vector<engine::Vec3>& a,
                                 const std::vector<engine::Vec3>& b) {
  EXPECT_EQ(a.size(), b.size());
  double largest = 0.0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    largest = std::max(largest, (a[i] - b[i]).norm());
  }
  return largest;
}

inline double largest_distance(const std::vector<engine::Vec3>& a) {
  double largest = 0.0;
  for (const engine::Vec3& place : a) largest = std::max(largest, (place - a.front()).norm());
  return largest;
}

}  // namespace cordis::plan
