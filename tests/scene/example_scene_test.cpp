// tests/scene/example_scene_test.cpp
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <random>
#include <regex>
#include <sstream>
#include <utility>

#include <gtest/gtest.h>

#include "node/config/launch.h"
#include "sim_node/engine/world.h"
#include "sim_node/plan/reduction/reduce.h"
#include "sim_node/scene/sections/scene_reader.h"
#include "tests/support/rounds.h"

namespace cordis::scene {
namespace {

const std::filesystem::path kConfigs = std::filesystem::path(CORDIS_SOURCE_DIR) / "launch_configs";

std::vector<std::string> files_in(const std::filesystem::path& folder) {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".yaml") files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::string text_of(const std::string& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

Scene example(const std::string& name) {
  config::Problems problems;
  Scene scene = load_scene((kConfigs / "scenes" / name).string(), problems);
  EXPECT_EQ(problems.text(), "");
  return scene;
}

engine::World world_of(const Scene& scene) {
  return engine::World(std::make_shared<const engine::Network>(scene.network));
}

TEST(ExampleScene, LoadsWithoutAWord) {
  const std::vector<std::string> files = files_in(kConfigs / "scenes");
  EXPECT_GE(files.size(), 3u);
  for (const std::string& file : files) {
    config::Problems problems;
    load_scene(file, problems);
    EXPECT_EQ(problems.text(), "") << file;
  }
}

TEST(ExampleScene, ChangesTheRoleOfItsDevicesByOneWord) {
  int switched = 0;
  for (const std::string& file : files_in(kConfigs / "scenes")) {
    const std::string before = text_of(file);
    const std::string after = std::regex_replace(before, std::regex("role: mass"), "role: liaison");
    config::Problems problems;
    const Scene scene = load_scene_text(after, file, problems);
    EXPECT_EQ(problems.text(), "") << file;
    for (const Port& port : scene.ports) {
      EXPECT_EQ(port.role, Role::kLiaison);
      EXPECT_GT(scene.network.mats[port.mat].mass, 0.0);
      ++switched;
    }
  }
  EXPECT_GE(switched, 15);
}

TEST(ExampleScene, OfEveryLaunchFileLoadsWithoutAWord) {
  for (const std::string& file : files_in(kConfigs)) {
    config::Problems problems;
    const config::Launch launch = config::load_launch(file, {}, problems);
    for (const config::LaunchNode& node : launch.nodes) {
      const config::Value path = node.section.find("scene");
      if (path.exists()) load_scene(launch.resolve(path.text()).string(), problems, path.place());
    }
    EXPECT_EQ(problems.text(), "") << file;
  }
}

/// Upper bound of K' + 2 Z', which must stay below 4: Gershgorin's circles of the stiffness and the
/// viscosity matrix divided by the masses, in units of the step. [Luc90 III Calculability]
double stability_bound(const Scene& scene) {
  const engine::NetworkDescription& network = scene.network;
  std::vector<double> stiffness(network.mats.size());
  std::vector<double> viscosity(network.mats.size(), network.medium_viscosity / 2.0);
  for (const engine::Link& link : network.links) {
    for (const std::uint32_t mat : {link.mat_a, link.mat_b}) {
      stiffness[mat] += link.stiffness;
      viscosity[mat] += link.viscosity;
    }
  }
  double bound = 0.0;
  for (std::size_t i = 0; i < network.mats.size(); ++i) {
    if (network.mats[i].kind != engine::MatKind::kMass) continue;
    if (network.mats[i].mass == 0.0) continue;  // a reduction takes it out
    const double per_mass = network.step / network.mats[i].mass;
    bound =
        std::max(bound, per_mass * (2.0 * stiffness[i] * network.step + 2.0 * 2.0 * viscosity[i]));
  }
  return bound;
}

TEST(ExampleScene, IsFarFromInstability) {
  for (const std::string& file : files_in(kConfigs / "scenes")) {
    config::Problems problems;
    const Scene scene = load_scene(file, problems);
    EXPECT_LT(stability_bound(scene), 0.6 * 4.0) << file;
  }
  EXPECT_LT(stability_bound(example("plucked_string.yaml")), 4.0 / 50.0);  // as its comment says
}

TEST(PluckedString, SwingsAsTheLoadedStringOfTheBooks) {
  // N masses m at distances a between fixed ends under tension T:  w1 = 2 sqrt(T / (m a)) sin(pi /
  // (2 (N + 1)))
  Scene scene = example("plucked_string.yaml");
  constexpr int kLinks = 39;
  constexpr double kTension = 18.2;
  constexpr double kAmplitude = 1.0e-4;  // so small that the tension stays what it is
  scene.network.links.resize(kLinks);    // the string without the finger
  scene.network.medium_viscosity = 0.0;
  for (engine::Link& link : scene.network.links) link.viscosity = 0.0;
  for (int i = 0; i <= kLinks; ++i) {
    scene.network.mats[i].position.y() = kAmplitude * std::sin(std::numbers::pi * i / kLinks);
  }
  scene.network.mats[0].position.y() = scene.network.mats[kLinks].position.y() = 0.0;
  engine::World world = world_of(scene);

  constexpr int kHalfSwings = 6;
  std::vector<double> crossings;
  for (double before = kAmplitude;
       crossings.size() < kHalfSwings + 1 && world.step_count() < 10'000;) {
    world.step();
    const double now = world.position(20).y();
    const double step = static_cast<double>(world.step_count());
    if (before * now < 0.0) crossings.push_back((step - now / (now - before)) * scene.network.step);
    before = now;
  }

  ASSERT_EQ(crossings.size(), kHalfSwings + 1u);
  const double measured = std::numbers::pi * kHalfSwings / (crossings.back() - crossings.front());
  const double distance = 0.65 / kLinks;
  const double exact =
      2.0 * std::sqrt(kTension / (0.02 * distance)) * std::sin(std::numbers::pi / (2.0 * kLinks));
  // the scheme is (w dt)^2 / 24 = 1e-6 fast; the amplitude tightens the string by 2e-7
  EXPECT_NEAR(measured / exact, 1.0, 5e-6);
  EXPECT_NEAR(exact / (2.0 * std::numbers::pi), 3.0, 0.05);  // Hz, as the scene says
}

TEST(PluckedString, GoesOnSwingingVisiblyWhenTheKeyIsLetGo) {
  const Scene scene = example("plucked_string.yaml");
  engine::World world = world_of(scene);
  const Port& key = scene.ports.at(0);
  constexpr double kPulled = -0.02;
  // pulled down in 1 s, let go in 50 ms, kept by its stop
  const auto key_at = [](double time) {
    if (time < 1.0) return kPulled * time;
    return time < 1.05 ? kPulled * (1.05 - time) / 0.05 : 0.0;
  };

  double largest_force = 0.0;
  double swing = 0.0;  // 3 s to 4 s after the beginning
  while (world.step_count() < 16'000) {
    const double time = static_cast<double>(world.step_count()) * scene.network.step;
    world.impose_position(key.mat, key.rest + key_at(time) * key.directions[0]);
    ASSERT_EQ(world.step().non_finite_mats, 0u);
    largest_force = std::max(largest_force, std::abs(world.link_force(key.mat).y()));
    if (time > 3.0) swing = std::max(swing, std::abs(world.position(20).y()));
  }

  EXPECT_GT(swing, 0.005);        // of 0.65 m
  EXPECT_GT(largest_force, 0.5);  // N: a finger feels it
  EXPECT_LT(largest_force, 5.0);
}

/// Reads a damaged text. The outcome is a scene that the engine takes, or problems.
void read_damaged(const std::string& text, const std::string& name) {
  config::Problems problems;
  const Scene scene = load_scene_text(text, name, problems);
  if (problems.has_errors()) {
    for (const config::Problem& problem : problems.all()) {
      ASSERT_FALSE(problem.message.empty());
      ASSERT_LT(problem.message.size(), 400u) << problem.message;
      ASSERT_GE(problem.place.line, 1) << problem.message;
    }
    ASSERT_FALSE(problems.text().empty());
    return;
  }
  EXPECT_EQ(scene.radius_m.size(), scene.network.mats.size());
  EXPECT_EQ(scene.layout.size(), scene.space() == 1 ? scene.network.mats.size() : 0u);
  config::Problems problems_of_reductions;
  const Scene reduced = plan::reduce(scene, problems_of_reductions);
  if (problems_of_reductions.has_errors()) return;
  EXPECT_NO_THROW(engine::Network{reduced.network});
}

/// Texts that are quickly read: of the smaller scenes.
std::vector<std::pair<std::string, std::string>> small_scenes() {
  std::vector<std::pair<std::string, std::string>> scenes;
  for (const std::string& file : files_in(kConfigs / "scenes")) {
    config::Problems problems;
    if (load_scene(file, problems).network.mats.size() < 100)
      scenes.emplace_back(file, text_of(file));
  }
  EXPECT_GE(scenes.size(), 5u);
  return scenes;
}

constexpr std::size_t kDamagedScenes = test::rounds(1000);  // of each test

TEST(DamagedScene, ThatIsCutOffIsASceneOrProblems) {
  const auto scenes = small_scenes();
  for (const auto& [file, text] : scenes) {
    const std::size_t stride = 1 + text.size() * scenes.size() / kDamagedScenes;
    for (std::size_t length = 0; length < text.size(); length += stride)
      read_damaged(text.substr(0, length), file);
  }
}

TEST(DamagedScene, WithWrongBytesIsASceneOrProblems) {
  std::mt19937 random(1990);
  const std::string alphabet = "\t\n {}[]:,-#&*!|>'\"%@`.0123456789eExyz_\\\x01\xc3\xff";
  const auto scenes = small_scenes();
  for (const auto& [file, text] : scenes) {
    for (std::size_t round = 0; round < kDamagedScenes / scenes.size(); ++round) {
      std::string damaged = text;
      for (std::size_t flips = 1 + round % 3; flips > 0; --flips) {
        damaged[random() % damaged.size()] = alphabet[random() % alphabet.size()];
      }
      read_damaged(damaged, file);
    }
  }
}

TEST(DamagedScene, WithLostOrDoubledLinesIsASceneOrProblems) {
  std::mt19937 random(1990);
  const auto scenes = small_scenes();
  for (const auto& [file, text] : scenes) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(line + '\n');
    for (std::size_t round = 0; round < kDamagedScenes / scenes.size(); ++round) {
      std::vector<std::string> damaged = lines;
      const auto any_line = [&] {
        return damaged.begin() + static_cast<std::ptrdiff_t>(random() % damaged.size());
      };
      if (round % 3 == 0) damaged.erase(any_line());
      if (round % 3 == 1) damaged.insert(any_line(), lines[random() % lines.size()]);
      if (round % 3 == 2) std::swap(*any_line(), *any_line());
      std::string joined;
      for (const std::string& line : damaged) joined += line;
      read_damaged(joined, file);
    }
  }
}

TEST(DamagedScene, WithWordsOfTheWrongKindIsASceneOrProblems) {
  std::mt19937 random(1990);
  const std::vector<std::string> words{
      ".nan", "-.inf", "1e308",  "-1e308", "1e999", "1e-320", "-1",   "0",  "99999999999999999999",
      "0x10", "1,5",   "text",   "\"1\"",  "'",     "[]",     "{}",   "~",  "[[]]",
      "true", "1.5e",  "\u0661", "3 N",    "$x",    "*x",     "&x 1", "!t", "[0, 0, 0, 0]"};
  const std::string ends = " ,:[]{}\n";
  const auto scenes = small_scenes();
  for (const auto& [file, text] : scenes) {
    for (std::size_t round = 0; round < kDamagedScenes / 2 / scenes.size(); ++round) {
      const std::size_t begin = text.find_first_not_of(ends, random() % text.size());
      if (begin == std::string::npos) continue;
      const std::size_t end = std::min(text.find_first_of(ends, begin), text.size());
      read_damaged(text.substr(0, begin) + words[random() % words.size()] + text.substr(end), file);
    }
  }
}

}  // namespace
}  // namespace cordis::scene
