// tests/scene/tutorial_test.cpp -- the scenes of docs/tutorial.md load, and do what it says of
// them.
#include <cmath>
#include <fstream>
#include <map>
#include <numbers>
#include <regex>
#include <sstream>

#include <gtest/gtest.h>

#include "sim_node/engine/world.h"
#include "sim_node/scene/sections/scene_reader.h"

namespace cordis::scene {
namespace {

using Sections = std::map<std::string, std::string>;

/// The top level keys of a YAML text, each with all that belongs to it.
Sections sections_of(const std::string& text) {
  Sections sections;
  std::istringstream lines(text);
  std::string key;
  for (std::string line; std::getline(lines, line);) {
    std::smatch begins;
    if (std::regex_search(line, begins, std::regex("^(\\w+):"))) key = begins[1];
    sections[key] += line + '\n';
  }
  return sections;
}

/// The scenes in the order of the text: a block without `cordis` changes the one before.
std::vector<Sections> tutorial() {
  std::ifstream file(CORDIS_SOURCE_DIR "/docs/tutorial.md");
  const std::string text(std::istreambuf_iterator<char>(file), {});
  const std::regex fenced("```yaml[^\n]*\n([^`]*)```");
  std::vector<Sections> scenes;
  for (std::sregex_iterator block(text.begin(), text.end(), fenced), end; block != end; ++block) {
    Sections next = sections_of((*block)[1]);
    if (next.contains("nodes")) continue;  // the launch file
    if (!next.contains("cordis")) next.insert(scenes.back().begin(), scenes.back().end());
    scenes.push_back(next);
  }
  return scenes;
}

Scene load(const Sections& sections) {
  std::string text;
  for (const auto& [key, section] : sections) text += section;
  config::Problems problems;
  Scene scene =
      load_scene_text(text, CORDIS_SOURCE_DIR "/launch_configs/scenes/first.yaml", problems);
  EXPECT_EQ(problems.text(), "") << text;
  return scene;
}

/// Presses the finger 2 cm down and lets it come up again.
/// @return per state machine how often a link or pair went from state to state
std::vector<std::uint64_t> changes_under_a_finger(const Scene& scene) {
  const auto network = std::make_shared<const engine::Network>(scene.network);
  engine::World world(network);
  const Port& port = scene.ports.at(0);
  const auto steps = static_cast<int>(3 * scene.step_rate_hz);
  for (int n = 1; n <= steps; ++n) {
    const double depth = 0.01 * (1 - std::cos(2 * std::numbers::pi * n / steps));
    world.impose_position(port.mat, port.rest + engine::Vec3(0, -depth, 0));
    EXPECT_EQ(world.step().non_finite_mats, 0u);
  }
  EXPECT_NEAR(world.energy().residual(), 0.0, 1e-9);
  std::vector<std::uint64_t> counts;
  for (std::uint32_t b = 0; b < scene.network.state_machines.size(); ++b) {
    const auto states = static_cast<std::uint32_t>(scene.network.state_machines[b].states.size());
    for (std::uint32_t source = 0; source < states; ++source) {
      for (std::uint32_t target = 0; target < states; ++target) {
        if (source != target) counts.push_back(world.change_count(b, source, target));
      }
    }
  }
  return counts;
}

void replace(std::string& text, const std::string& before, const std::string& after) {
  const std::size_t position = text.find(before);
  ASSERT_NE(position, std::string::npos) << before;
  text.replace(position, before.size(), after);
}

}  // namespace

TEST(Tutorial, ItsScenesLoadAndDoWhatItSays) {
  const std::vector<Sections> scenes = tutorial();
  ASSERT_EQ(scenes.size(), 5u);
  EXPECT_EQ(load(scenes[0]).network.mats.size(), 2u);

  using Counts = std::vector<std::uint64_t>;
  for (const std::size_t step : {1, 3}) {
    const Counts contact = changes_under_a_finger(load(scenes[step]));
    ASSERT_EQ(contact.size(), 2u) << step;
    EXPECT_GT(contact[0], 0u) << "the finger meets the ball";
    EXPECT_GT(contact[1], 0u) << "and leaves it";
  }
  EXPECT_EQ(load(scenes[3]).network.mats.size(), 1 + 7 + 2u);

  Sections grasp = scenes[3];
  replace(grasp["links"], "contact", "grasp");
  const Counts held = changes_under_a_finger(load(grasp));
  ASSERT_EQ(held.size(), 2u);
  EXPECT_GT(held[0], 0u);
  EXPECT_EQ(held[1], 0u) << "what it has touched it holds";

  Sections glue = scenes[4];
  replace(glue["links"], "contact", "glue");
  replace(glue["links"], ", stiffness_n_per_m: 300", "");
  const Counts glued = changes_under_a_finger(load(glue));
  ASSERT_EQ(glued.size(), 6u);  // apart, held, free
  EXPECT_GT(glued[0], 0u);
  EXPECT_GT(glued[3], 0u) << "held for half a second";
  EXPECT_GT(glued[4], 0u) << "and separated";
}

}  // namespace cordis::scene
