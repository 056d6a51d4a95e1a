// tests/scene/link_test.cpp
#include <utility>

#include <gtest/gtest.h>

#include "tests/scene/scene_text.h"

namespace cordis::scene {
namespace {

constexpr const char* kMatter =
    R"(matter:
  one: {kind: mass, mass_kg: 1, at_m: [0, 0]}
  three: {kind: mass, mass_kg: 1, at_m: [[3, 4], [6, 8], [9, 12]]}
  other: {kind: mass, mass_kg: 1, at_m: [[3, 5], [6, 10], [9, 15]]}
)";
constexpr const char* kLiaisons =
    R"(liaisons:
  s: {kind: spring, stiffness_n_per_m: 10}
  d: {kind: damper, viscosity_n_s_per_m: 20}
  sd: {kind: spring_damper, stiffness_n_per_m: 30, viscosity_n_s_per_m: 40, rest_m: 0.5}
)";

std::vector<std::pair<std::uint32_t, std::uint32_t>> ends_of(const std::string& links) {
  const Scene scene = sound_scene(2, kMatter + std::string(kLiaisons) + "links:\n" + links);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> ends;
  for (const engine::Link& link : scene.network.links) ends.emplace_back(link.mat_a, link.mat_b);
  return ends;
}

engine::Link link_of(const std::string& link) {
  return sound_scene(2, kMatter + std::string(kLiaisons) + "links:\n  - " + link + "\n")
      .network.links.at(0);
}

using Ends = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

TEST(Links, JoinEquallyManyOneToOne) {
  EXPECT_EQ(ends_of("  - {liaison: s, between: [three, other]}\n"), (Ends{{1, 4}, {2, 5}, {3, 6}}));
  EXPECT_EQ(ends_of("  - {liaison: s, between: [\"three[0..1]\", \"three[1..2]\"]}\n"),
            (Ends{{1, 2}, {2, 3}}));
}

TEST(Links, JoinOneWithManyAsAStar) {
  EXPECT_EQ(ends_of("  - {liaison: s, between: [one, three]}\n"), (Ends{{0, 1}, {0, 2}, {0, 3}}));
  EXPECT_EQ(ends_of("  - {liaison: s, between: [\"three[1..2]\", one]}\n"), (Ends{{2, 0}, {3, 0}}));
}

TEST(Links, PickMatsByIndexFromZero) {
  EXPECT_EQ(ends_of("  - {liaison: s, between: [one, \"three[2]\"]}\n"), (Ends{{0, 3}}));
  EXPECT_EQ(ends_of("  - {liaison: s, between: [\"one[0]\", \"three[1..1]\"]}\n"), (Ends{{0, 2}}));
}

TEST(Links, HaveTheParametersOfTheirLiaisonUnlessOverridden) {
  const engine::Link spring = link_of("{liaison: s, between: [one, \"three[0]\"]}");
  EXPECT_EQ(spring.stiffness, 10.0);
  EXPECT_EQ(spring.viscosity, 0.0);
  EXPECT_EQ(spring.rest_length, 5.0);  // the distance at the start: 3-4-5

  const engine::Link damper = link_of("{liaison: d, between: [one, \"three[0]\"]}");
  EXPECT_EQ(damper.stiffness, 0.0);
  EXPECT_EQ(damper.viscosity, 20.0);

  const engine::Link both = link_of("{liaison: sd, between: [one, \"three[0]\"]}");
  EXPECT_EQ(both.stiffness, 30.0);
  EXPECT_EQ(both.viscosity, 40.0);
  EXPECT_EQ(both.rest_length, 0.5);

  const engine::Link other = link_of(
      "{liaison: sd, between: [one, \"three[0]\"], stiffness_n_per_m: 1, viscosity_n_s_per_m: 2, "
      "rest_m: 3}");
  EXPECT_EQ(other.stiffness, 1.0);
  EXPECT_EQ(other.viscosity, 2.0);
  EXPECT_EQ(other.rest_length, 3.0);
}

TEST(Links, RestLengthIsSignedInOneDimension) {
  const Scene scene = sound_scene(1, std::string(kLiaisons) +
                                         R"(matter:
  a: {kind: mass, mass_kg: 1, at_m: [2, 5]}
links:
  - {liaison: s, between: ["a[1]", "a[0]"]}
  - {liaison: s, between: ["a[0]", "a[1]"], rest_m: -4}
)");
  EXPECT_EQ(scene.network.links[0].rest_length, -3.0);
  EXPECT_EQ(scene.network.links[1].rest_length, -4.0);
}

TEST(Links, BearTheNameGivenOrThatOfTheirLiaison) {
  const Scene scene = sound_scene(2, kMatter + std::string(kLiaisons) +
                                         R"(links:
  - {liaison: s, between: [one, three]}
  - {liaison: s, name: mine, between: [one, "other[0..1]"]}
)");
  ASSERT_EQ(scene.links.size(), 2u);
  EXPECT_EQ(scene.links[0].name, "s");
  EXPECT_EQ(scene.links[0].count, 3u);
  EXPECT_EQ(scene.links[1].name, "mine");
  EXPECT_EQ(scene.links[1].first, 3u);
  EXPECT_EQ(scene.links[1].count, 2u);
}

TEST(Links, WarnOfEndsThatCoincideUnderARestLength) {
  const auto problems_of = [](int space, const std::string& links) {
    config::Problems problems;
    const std::string zero = space == 1 ? "[0, 0, 1]" : "[[0, 0], [0, 0], [1, 0]]";
    load_scene_text(scene_head(space) + std::string(kLiaisons) +
                        "matter:\n  a: {kind: mass, mass_kg: 1, at_m: " + zero + "}\nlinks:\n" +
                        links,
                    "t", problems);
    return problems.text();
  };
  const std::string apart = "  - {liaison: s, between: [\"a[0]\", \"a[1]\"], rest_m: 0.1}\n";

  const std::string report = problems_of(2, apart);

  EXPECT_NE(report.find("warning: 'a[0]' and 'a[1]' start at the same point, so their link has no "
                        "direction and exerts no force"),
            std::string::npos)
      << report;
  EXPECT_NE(report.find("move one of them"), std::string::npos) << report;
  EXPECT_EQ(problems_of(1, apart), "");
  EXPECT_EQ(problems_of(2, "  - {liaison: s, between: [\"a[0]\", \"a[1]\"]}\n"), "");
  EXPECT_EQ(problems_of(2, "  - {liaison: s, between: [\"a[0]\", \"a[2]\"], rest_m: 0.1}\n"), "");
}

}  // namespace
}  // namespace cordis::scene
