#include "sim_node/scene/writer/scene_text.h"

#include <filesystem>

#include "tests/reduction/scenes.h"

namespace cordis::plan {
namespace {

const std::filesystem::path kConfigs = std::filesystem::path(CORDIS_SOURCE_DIR) / "launch_configs";

/// The text of a scene, read again.
scene::Scene read_again(const scene::Scene& scene) {
  const std::string text = scene::scene_text(scene, "as it was");
  config::Problems problems;
  scene::Scene again = scene::load_scene_text(text, "again", problems);
  EXPECT_FALSE(problems.has_errors()) << scene.name << "\n" << problems.text();
  return again;
}

/// Of every kind of matter, liaison, set and port one at least.
std::vector<std::string> example_scenes() {
  std::vector<std::string> files;
  for (const char* name : {"scenes/plucked_string", "scenes/ratchet", "scenes/material_skin",
                           "scenes/mobile", "scenes/sticking_balls", "lab/bowed"}) {
    files.push_back((kConfigs / (std::string(name) + ".yaml")).string());
  }
  return files;
}

/// Two networks joined alike: MATs, ends, laws.
void expect_alike(const scene::Scene& a, const scene::Scene& b) {
  const engine::NetworkDescription& before = a.network;
  const engine::NetworkDescription& after = b.network;
  ASSERT_EQ(before.mats.size(), after.mats.size());
  for (std::size_t i = 0; i < before.mats.size(); ++i) {
    EXPECT_EQ(before.mats[i].kind, after.mats[i].kind);
    EXPECT_EQ(before.mats[i].mass, after.mats[i].mass);
    EXPECT_EQ(before.mats[i].position, after.mats[i].position);
    EXPECT_EQ(before.mats[i].velocity, after.mats[i].velocity);
  }
  EXPECT_EQ(before.radius, after.radius);
  EXPECT_EQ(a.radius_m, b.radius_m);
  EXPECT_EQ(before.links.size(), after.links.size());
  ASSERT_EQ(before.state_links.size(), after.state_links.size());
  for (std::size_t i = 0; i < before.state_links.size(); ++i) {
    EXPECT_EQ(before.state_links[i].rest_length, after.state_links[i].rest_length);
  }
  EXPECT_EQ(before.maxwell_links.size(), after.maxwell_links.size());
  EXPECT_EQ(before.sets.size(), after.sets.size());
  EXPECT_EQ(a.signals.count(), b.signals.count());
  ASSERT_EQ(a.ports.size(), b.ports.size());
  for (std::size_t i = 0; i < a.ports.size(); ++i) {
    EXPECT_EQ(a.ports[i].needs.travel, b.ports[i].needs.travel);
    EXPECT_EQ(a.ports[i].needs.up, b.ports[i].needs.up);
    EXPECT_EQ(a.ports[i].needs.down, b.ports[i].needs.down);
    EXPECT_EQ(a.ports[i].needs.force, b.ports[i].needs.force);
  }
}

TEST(SceneText, AnExampleIsTheSameSceneWhenItIsReadAgain) {
  for (const std::string& file : example_scenes()) {
    config::Problems problems;
    scene::Scene scene = scene::load_scene(file, problems);
    ASSERT_FALSE(problems.has_errors());
    scene::Scene again = read_again(scene);
    expect_alike(scene, again);
    const std::size_t mats = scene.network.mats.size();
    if (again.network.mats.size() != mats) continue;

    engine::World world(std::make_shared<const engine::Network>(scene.network));
    engine::World same(std::make_shared<const engine::Network>(again.network));
    std::vector<double> signals(scene.signals.count());
    std::vector<double> same_signals(scene.signals.count());
    for (int n = 0; n < 20; ++n) {
      world.step();
      same.step();
    }
    scene.signals.read(world, signals.data());
    again.signals.read(same, same_signals.data());
    for (std::uint32_t i = 0; i < mats; ++i) {
      EXPECT_LT((world.position(i) - same.position(i)).norm(), 1e-13) << file;
    }
    for (std::size_t s = 0; s < signals.size(); ++s) {
      EXPECT_NEAR(signals[s], same_signals[s], 1e-10 * (1.0 + std::abs(signals[s])))
          << file << ": " << scene.signals.signals()[s].name;
    }
  }
}

TEST(SceneText, PartsOfParallelLiaisonsBecomeLiaisonsOfTheirOwn) {
  const scene::Scene scene = loaded(
      "cordis: 1\nspace: 2\nstep: {rate_hz: 1000}\n"
      "liaisons:\n"
      "  thread: {states: {taut: {stiffness_n_per_m: 50, pushes: false, final: true}}}\n"
      "  both:\n"
      "    parameters: {k: 20, yield_m: 0.05}\n"
      "    parallel:\n"
      "      - thread\n"
      "      - {kind: spring, stiffness_n_per_m: k}\n"
      "      - {kind: state_machine, start: whole, states: {\n"
      "          whole: {stiffness_n_per_m: 2 * k, exits: [{to: off, when: elongation_m > "
      "yield_m}]},\n"
      "          off: {final: true}}}\n"
      "parts:\n"
      "  pendulum: {matter: {bob: {kind: mass, mass_kg: 0.1, at_m: [0, -1]}}}\n"
      "matter:\n"
      "  hook: {kind: fixed, at_m: [0, 0]}\n"
      "  p: {part: pendulum, repeat: {count: 2, translate_m: [0.1, 0]}}\n"
      "world: {gravity_m_per_s2: [0, -9.81]}\n"
      "ports:\n"
      "  key: {device: d, axes: 0, role: mass, at_m: [5, 5], needs: {travel_m: 0.05, force_n: 5}}\n"
      "links:\n"
      "  - {liaison: both, between: [hook, \"p[0].bob\"], name: cord}\n"
      "  - {liaison: both, between: [hook, \"p[1].bob\"], k: 10, yield_m: 0.02}\n");
  const scene::Scene again = read_again(scene);

  expect_alike(scene, again);
  const auto before = motion(scene, "p[1].bob", 400);
  const auto after = motion(again, "p_1__bob", 400);
  EXPECT_GT(largest_distance(before), 0.02);  // far enough to break
  EXPECT_LT(largest_difference(before, after), 1e-13);
}

}  // namespace
}  // namespace cordis::plan
