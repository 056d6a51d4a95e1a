// tests/scene/absurd_scene_test.cpp -- absurd scenes are reported in few sentences,
// and soon: a reader that followed them to their end would need minutes, or all memory.
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/scene/scene_text.h"
#include "tests/support/filled.h"

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
    return R"(liaisons:
  l:
    kind: spring
    stiffness_n_per_m: p0
    parameters:
)" + repeated(count, [](auto i, auto next) { return "      p" + i + ": 2 * p" + next + "\n"; }) +
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
  EXPECT_EQ(problems_in(R"(liaisons:
  l:
    states:
      x:
        exits:
)" + repeated(1001, [](auto i, auto) { return "          - {to: x, when: age_s > " + i + "}\n"; }) +
                        kBob),
            "liaison 'l' has more than 1000 exits");
}

TEST(AbsurdScene, OfManyWrongNamesIsReportedUpToAHundredOfThem) {
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
  EXPECT_EQ(problems_in(
                R"(parts:
  p0: {matter: {m: {kind: lattice, structure: square, corner_m: [0, 0], counts: [100, 100],
                    mass_kg: 1, spacing_m: 1}}}
)" +
                repeated(40,
                         [](auto i, auto next) {
                           return "  p" + next + ": {matter: {a: {part: p" + i + "}, b: {part: p" +
                                  i + "}}}\n";
                         }) +
                R"(matter:
  z: {part: p40}
)"),
            "the scene has more than 1000000 MATs or 8000000 links");
}

// Without the bound each of these would add a million times a million copies.
TEST(AbsurdScene, OfPartsRepeatedWithinEachOtherIsRefused) {
  const std::string nested = repeated(12,
                                      [](auto i, auto next) {
                                        return "  p" + next + ": {matter: {m: {part: p" + i +
                                               ", repeat: {count: 1000, translate_m: [1, 0]}}}}\n";
                                      }) +
                             R"(matter:
  z: {part: p12}
  a: {kind: mass, mass_kg: 1, at_m: [0, 0]}
)";
  EXPECT_EQ(problems_in("parts:\n  p0: {links: []}\n" + nested),
            "missing key 'matter' in part 'p0'");
  EXPECT_EQ(problems_in("parts:\n  p0: {matter: {m: {kind: fixed, at_m: [0, 0]}}}\n" + nested),
            "the scene uses parts more than 100000 times, each copy counted");
}

TEST(AbsurdScene, OfPartsInAnEndlessRowIsRefused) {
  EXPECT_EQ(problems_in("parts:\n  p0: {matter: {m: {kind: mass, mass_kg: 1, at_m: [0, 0]}}}\n" +
                        repeated(20'000,
                                 [](auto i, auto next) {
                                   return "  p" + next + ": {matter: {m: {part: p" + i + "}}}\n";
                                 }) +
                        "matter:\n  z: {part: p20000}\n"),
            "parts stand more than 64 levels within each other");
}

TEST(AbsurdScene, OfLongPartsInManyCopiesIsRefused) {
  const std::string parameters =
      repeated(2000, [](auto i, auto) { return ", a" + i + ": [1, 2, 3]"; });
  const std::string asked = repeated(2000, [](auto i, auto) { return ", $a" + i; });
  EXPECT_EQ(problems_in(test::filled(R"(parts:
  p: {parameters: {b: 1<parameters>, place: [$b<asked>]}, matter: {m: {kind: fixed, at_m: $place}}}
  q: {matter: {m: {part: p, parameters: {place: [0, 0]}}}}
matter:
  z: {part: q, repeat: {count: 40000}}
)",
                                     {{"parameters", parameters}, {"asked", asked}})),
            "the parts of the scene put more than 10000000 values into it");
}

const std::string kContact = "liaisons:\n  t: {kind: state_machine, stiffness_n_per_m: 0.1}\n";

/// Masses in a square, 1 m apart.
std::string square_of(int side) {
  const std::string count = std::to_string(side);
  return "matter:\n  s: {kind: lattice, structure: square, counts: [" + count + ", " + count +
         "], mass_kg: 1, corner_m: [0, 0], spacing_m: 1}\n";
}

TEST(AbsurdScene, OfASetInWhichAllAreNearAllIsRefusedAtItsRange) {
  config::Problems problems;
  load_scene_text(scene_head(2) + kContact + square_of(1000) +
                      R"(links:
  - {liaison: t, within: s, rest_m: 1, range_m: 2000}
  - {liaison: t, within: s, rest_m: 1, range_m: 3000, name: other}
signals:
  b: {of: other, quantity: bonds}
)",
                  "t", problems);
  ASSERT_EQ(problems.in_order().size(), 1u) << problems.text();
  const config::Problem problem = problems.in_order()[0];
  EXPECT_EQ(problem.message,
            "the sets of the scene have more than 8000000 pairs of MATs in or near their range at "
            "the start");
  EXPECT_EQ(problem.hint,
            "this one joins all that are nearer than 2000 m; give it a shorter 'range_m', or fewer "
            "MATs");
  EXPECT_EQ(problem.place.line, 9);
  EXPECT_EQ(problem.place.column, 26);
}

TEST(AbsurdScene, OfSetsThatAreNearlyInRangeOfEachOtherIsRefused) {
  // 40,000 masses in two heaps, none of the one in range of the other
  const std::string heap = ", structure: square, counts: [200, 100], mass_kg: 1, spacing_m: 0.0001";
  EXPECT_EQ(problems_in(kContact + test::filled(R"(matter:
  p: {kind: lattice, corner_m: [0, 0]<heap>}
  q: {kind: lattice, corner_m: [1.2, 0]<heap>}
links:
  - {liaison: t, between_sets: [p, q], rest_m: 1, range_m: 1}
  - {liaison: t, between_sets: [q, p], rest_m: 1, range_m: 1}
)",
                                                {{"heap", heap}})),
            "the sets of the scene have more than 8000000 pairs of MATs in or near their range at "
            "the start");
}

TEST(AbsurdScene, OfTooManySetsIsRefused) {
  const auto scene = [](int side, int count) {
    return kContact + square_of(side) + "links:\n" + repeated(count, [](auto, auto) {
             return std::string("  - {liaison: t, within: s, rest_m: 0.1, range_m: 0.1}\n");
           });
  };
  EXPECT_EQ(problems_in(scene(2, 1001)), "the scene has more than 1000 liaisons of sets");
  EXPECT_EQ(problems_in(scene(700, 5)),
            "the sets of the scene have more than 2000000 MATs together");
}

TEST(AbsurdScene, OfTooManySurfacesIsRefused) {
  EXPECT_EQ(problems_in(kContact + R"(
parts:
  step: {matter: {stone: {kind: box, center_m: [0, 0], size_m: [0.1, 0.1]}}}
matter:
  ball: {kind: mass, mass_kg: 0.01, at_m: [0, 0.5]}
  stairs: {part: step, repeat: {count: 10001, translate_m: [0.2, -0.1]}}
links:
  - {liaison: t, between_sets: [ball, "stairs.*"], rest_m: 0.02, range_m: 0.02}
)"),
            "the sets of the scene have more than 10000 surfaces together");
}

TEST(AbsurdScene, OfTooManyDevicesIsRefused) {
  const auto scene = [](int count) {
    return kBob + "ports:\n" + repeated(count, [](auto i, auto) {
             return "  p" + i + ": {device: d" + i + ", axes: [0], role: mass, at_m: [0, 1]}\n";
           });
  };
  EXPECT_EQ(problems_in(scene(64)), "");
  EXPECT_EQ(problems_in(scene(70)), "the scene has more than 64 devices");
}

TEST(AbsurdScene, ThatIsFullSaysSoOnceAndReadsNoMoreMatter) {
  EXPECT_EQ(
      problems_in("matter:\n" +
                  repeated(3000,
                           [](auto i, auto) {
                             return "  s" + i +
                                    ": {kind: lattice, structure: square, counts: [1000, 900], "
                                    "mass_kg: 1, corner_m: [0, 0], spacing_m: 1}\n";
                           })),
      "the scene has more than 1000000 MATs or 8000000 links");
}

}  // namespace
}  // namespace cordis::scene
