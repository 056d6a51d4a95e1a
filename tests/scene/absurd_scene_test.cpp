// tests/scene/absurd_scene_test.cpp -- scenes that nobody would write are told in few sentences,
// and soon: a reader that followed them to their end would need minutes, or all memory.
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/scene/scene_text.h"

namespace cordis::scene {
namespace {

/// What `line` gives for 0 to count - 1.
std::string repeated(
    int count, const std::function<std::string(const std::string&, const std::string&)>& line) {
  std::string text;
  for (int i = 0; i < count; ++i) text += line(std::to_string(i), std::to_string(i + 1));
  return text;
}

/// The first problem of a scene of two masses with these sections besides.
std::string problems_in(const std::string& sections) {
  config::Problems problems;
  load_scene_text(scene_head(2) + sections, "t", problems);
  if (problems.all().empty()) return "";
  EXPECT_LE(problems.in_order().size(), config::Problems::kMaxProblems + 1);
  for (const config::Problem& problem : problems.all()) EXPECT_LT(problem.text().size(), 600u);
  return problems.in_order().front().message;
}

const std::string kBob = "matter:\n  a: {kind: mass, mass_kg: 1, at_m: [[0, 0], [1, 0]]}\n";
const std::string kSpring = "liaisons:\n  s: {kind: spring, stiffness_n_per_m: 1}\n";

TEST(AbsurdScene, OfAnEndlessNameIsRefused) {
  EXPECT_EQ(problems_in("name: " + std::string(1'000'000, 'x') + "\n" + kBob),
            "'name' in scene is longer than 1000 characters");
}

TEST(AbsurdScene, OfParametersInAnEndlessRowIsRefused) {
  const auto scene = [](int count) {
    return "liaisons:\n  l:\n    kind: spring\n    stiffness_n_per_m: p0\n    parameters:\n" +
           repeated(count,
                    [](auto i, auto next) { return "      p" + i + ": 2 * p" + next + "\n"; }) +
           "      p" + std::to_string(count) + ": 1\n" + kBob;
  };
  EXPECT_EQ(problems_in(scene(64)), "");
  EXPECT_EQ(problems_in(scene(65)),
            "more than 64 parameters of liaison 'l' each depend on the next, down to 'p64'");
  EXPECT_EQ(problems_in(scene(20'000)),
            "'parameters' in liaison 'l' has more than 1000 parameters");
}

TEST(AbsurdScene, OfLiaisonsInParallelWithinEachOtherWithoutEndIsRefused) {
  const std::string first = problems_in(
      "liaisons:\n" +
      repeated(1000,
               [](auto i, auto next) { return "  l" + i + ": {parallel: [l" + next + "]}\n"; }) +
      "  l1000: {kind: spring, stiffness_n_per_m: 1}\n" + kBob);
  EXPECT_EQ(first, "the liaison 'l1' cannot be used here");
}

TEST(AbsurdScene, OfTooManyExitsIsRefused) {
  EXPECT_EQ(problems_in("liaisons:\n  l:\n    states:\n      x:\n        exits:\n" +
                        repeated(1001,
                                 [](auto i, auto) {
                                   return "          - {to: x, when: age_s > " + i + "}\n";
                                 }) +
                        kBob),
            "liaison 'l' has more than 1000 exits");
}

TEST(AbsurdScene, OfManyWrongNamesIsToldUpToAHundredOfThem) {
  const std::string matter =
      repeated(3000, [](auto i, auto) { return "  b" + i + ": {kind: fixed, at_m: [0, 1]}\n"; });
  EXPECT_EQ(problems_in(kSpring + kBob + matter + "links:\n" +
                        repeated(3000,
                                 [](auto i, auto) {
                                   return "  - {liaison: s, between: [c" + i + ", \"a[0]\"]}\n";
                                 })),
            "no matter or port is named 'c0'");
  EXPECT_EQ(
      problems_in(
          "liaisons:\n" +
          repeated(3000, [](auto i, auto) { return "  l" + i + ": {like: k" + i + "}\n"; }) + kBob),
      "no liaison is named 'k0'");
}

TEST(AbsurdScene, OfPartsThatDoubleWithoutEndIsRefused) {
  EXPECT_EQ(
      problems_in(
          "parts:\n  p0: {matter: {m: {kind: lattice, structure: square, corner_m: [0, 0], counts: "
          "[100, 100], mass_kg: 1, spacing_m: 1}}}\n" +
          repeated(40,
                   [](auto i, auto next) {
                     return "  p" + next + ": {matter: {a: {part: p" + i + "}, b: {part: p" + i +
                            "}}}\n";
                   }) +
          "matter:\n  z: {part: p40}\n"),
      "the scene has more than 1000000 MATs or 8000000 links");
}

}  // namespace
}  // namespace cordis::scene
