// tests/scene/damaged_liaison_test.cpp
#include <filesystem>
#include <fstream>
#include <memory>
#include <random>
#include <sstream>

#include <gtest/gtest.h>

#include "sim_node/engine/world.h"
#include "tests/scene/scene_text.h"
#include "tests/support/rounds.h"

namespace cordis::scene {
namespace {

/// The standard liaisons as a scene of their own, with a link or a set of many of them.
std::string whole_text() {
  const std::filesystem::path file =
      std::filesystem::path(CORDIS_SOURCE_DIR) / "launch_configs" / "liaisons" / "standard.yaml";
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str() +
         R"(space: 1
step: {rate_hz: 1000}
matter:
  a: {kind: mass, ball: {mass_kg: 1, radius_m: 0.1}, at_m: [0, 1, 2]}
links:
  - {liaison: contact, within: a}
  - {liaison: collophane, between: ["a[0]", "a[1]"], hold_m: 0.5}
  - {liaison: ecrouissage, between: ["a[1]", "a[2]"], original_m: 1}
  - {liaison: plastic, between: ["a[1]", "a[2]"], name: lead}
  - {liaison: standard_linear_solid, between: ["a[0]", "a[2]"]}
)";
}

/// The outcome must be a scene that the engine takes and steps, or problems.
void read_damaged(const std::string& text) {
  config::Problems problems;
  const Scene scene = load_scene_text(text, "t", problems);
  if (problems.has_errors()) {
    ASSERT_FALSE(problems.text().empty());
    return;
  }
  engine::World world(std::make_shared<const engine::Network>(scene.network));
  for (int n = 0; n < 3; ++n) world.step();
}

TEST(StandardLiaisons, MakeASceneWithoutAWord) {
  config::Problems problems;
  load_scene_text(whole_text(), "t", problems);
  EXPECT_EQ(problems.text(), "");
}

TEST(DamagedLiaison, WithWrongBytesIsASceneOrProblems) {
  std::mt19937 random(1990);
  const std::string alphabet = "\n {}[]:,-#\"'.0123456789eExyz_<>=*/+()&|^";
  const std::string text = whole_text();
  for (int round = 0; round < test::rounds(300); ++round) {
    std::string damaged = text;
    for (int flips = 1 + round % 4; flips > 0; --flips)
      damaged[random() % damaged.size()] = alphabet[random() % alphabet.size()];
    read_damaged(damaged);
  }
}

TEST(DamagedLiaison, WithSwappedWordsIsASceneOrProblems) {
  std::mt19937 random(1990);
  std::vector<std::string> words;
  std::istringstream stream(whole_text());
  for (std::string line; std::getline(stream, line);) {
    if (line.find('#') == std::string::npos) words.push_back(line + '\n');
  }
  for (int round = 0; round < test::rounds(300); ++round) {
    std::vector<std::string> damaged = words;
    damaged[random() % damaged.size()] = words[random() % words.size()];
    std::string text;
    for (const std::string& line : damaged) text += line;
    read_damaged(text);
  }
}

TEST(SetLiaison, OfUnsoundMatterSaysNothingOfItsOwn) {
  for (const char* link : {"within: a", "between_sets: [a, b]", "between_sets: [b, a]"}) {
    config::Problems problems;
    load_scene_text(scene_head(2) +
                        R"(liaisons:
  s: {kind: spring, stiffness_n_per_m: 1, rest_m: 1}
matter:
  a: {kind: mass, at_m: [[0, 0], [1, 0]]}
  b: {kind: mass, mass_kg: 1, at_m: [[2, 0], [3, 0]]}
links:
  - {liaison: s, range_m: 1, )" +
                        link + "}\n",
                    "t", problems);
    ASSERT_EQ(problems.all().size(), 1u) << problems.text();
    EXPECT_EQ(problems.all()[0].place.line, 7);
  }
}

TEST(SetLiaison, HasNoQuantitiesOfALink) {
  config::Problems problems;
  load_scene_text(scene_head(2) +
                      R"(liaisons:
  s: {kind: spring, stiffness_n_per_m: 1, rest_m: 1}
matter:
  a: {kind: mass, mass_kg: 1, at_m: [[0, 0], [1, 0]]}
links:
  - {liaison: s, within: a, range_m: 1, name: glue}
signals:
  g: {of: glue, quantity: force}
)",
                  "t", problems);
  ASSERT_EQ(problems.all().size(), 1u) << problems.text();
  EXPECT_EQ(problems.all()[0].message, "a liaison of sets has no quantity 'force'");
  EXPECT_EQ(problems.all()[0].hint, "it has pieces, bonds");
}

TEST(BadLiaisons, AreAllReportedInOneGo) {
  config::Problems problems;
  load_scene_text(scene_head(2) +
                      R"(liaisons:
  a: {like: b}
  b: {like: a}
  c:
    parameters: {x: y}
    states: {one: {exits: [{to: two, when: elongation_m > 1}]}, two: {}}
  d: {elasticity: {kind: table, at_m: [1, 0], force_n: [0, 0]}}
  e: {parallel: [f]}
  g: {states: {one: {stiffness_n_per_m: -1, exits: [{to: too, when: age_s}]}, two: {}}}
matter:
  m: {kind: mass, mass_kg: 1, at_m: [[0, 0], [1, 0]]}
links:
  - {liaison: a, between: ["m[0]", "m[1]"], hold_m: 1}
  - {liaison: h, within: m}
)",
                  "t", problems);

  std::string places;
  for (const config::Problem& problem : problems.in_order())
    places += std::to_string(problem.place.line) + ':' + std::to_string(problem.place.column) + ' ';
  EXPECT_EQ(places, "6:13 8:21 10:43 11:18 12:41 12:58 12:69 17:15 ") << problems.text();
}

}  // namespace
}  // namespace cordis::scene
