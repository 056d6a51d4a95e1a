// tests/scene/colour_test.cpp -- colours that a scene gives to matter.
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "sim_node/plan/reduction/reduce.h"
#include "tests/scene/bad_scene.h"

namespace cordis::scene {
namespace {

using config::Colour;

constexpr Colour kRed{255, 0, 0};
constexpr Colour kTeal{0, 128, 128};
constexpr Colour kOrange{255, 136, 0};

/// The colour of each MAT.
std::vector<std::optional<Colour>> colours_of(const Scene& scene) {
  std::vector<std::optional<Colour>> colours(scene.network.mats.size());
  for (const ColouredRange& range : scene.colours) {
    for (std::uint32_t i = 0; i < range.count; ++i) colours.at(range.first + i) = range.colour;
  }
  return colours;
}

TEST(MatterColour, IsGivenToEveryMatOfItsEntryAndToNoOther) {
  const Scene scene = sound_scene(2, R"(matter:
  a: {kind: mass, mass_kg: 1, at_m: [[0, 0], [1, 0]], color: red}
  b: {kind: mass, mass_kg: 1, at_m: [2, 0]}
  c: {kind: fixed, at_m: [3, 0], color: '#ff8800'}
)");
  const std::vector<std::optional<Colour>> wanted{kRed, kRed, std::nullopt, kOrange};
  EXPECT_EQ(colours_of(scene), wanted);
}

struct KindOfMatter {
  int space;
  const char* entry;
};

constexpr std::array kKinds{
    KindOfMatter{2, "kind: mass, mass_kg: 1, at_m: [0, 0]"},
    KindOfMatter{2, "kind: fixed, at_m: [0, 0]"},
    KindOfMatter{2, "kind: points, mass_kg: 1, at_m: [[0, 0], [1, 1]]"},
    KindOfMatter{2,
                 "kind: string, count: 3, mass_kg: 1, from_m: [0, 0], to_m: [1, 0], "
                 "stiffness_n_per_m: 1"},
    KindOfMatter{1, "kind: string, count: 3, mass_kg: 1, stiffness_n_per_m: 1"},
    KindOfMatter{2,
                 "kind: ring, count: 3, mass_kg: 1, center_m: [0, 0], radius_m: 1, "
                 "stiffness_n_per_m: 1"},
    KindOfMatter{2,
                 "kind: grid, rows: 2, columns: 2, mass_kg: 1, corner_m: [0, 0], spacing_m: 1, "
                 "stiffness_n_per_m: 1"},
    KindOfMatter{2,
                 "kind: lattice, structure: square, spacing_m: 1, corner_m: [0, 0], "
                 "counts: [2, 2], mass_kg: 1"},
    KindOfMatter{2, "kind: disc, center_m: [0, 0], radius_m: 2, spacing_m: 1, mass_kg: 1"},
    KindOfMatter{3, "kind: ball, center_m: [0, 0, 0], radius_m: 2, spacing_m: 1, mass_kg: 1"},
    KindOfMatter{2,
                 "kind: pack, ball: {mass_kg: 1, radius_m: 0.1}, "
                 "region: {center_m: [0, 0], radius_m: 1}, count: 3"},
    KindOfMatter{2,
                 "kind: skin, center_m: [0, 0], radius_m: 1, count: 6, mass_kg: 1, "
                 "stiffness_n_per_m: 1"},
    KindOfMatter{2,
                 "kind: beam, cells: 2, from_m: [0, 0], to_m: [1, 0], height_m: 0.1, "
                 "mass_kg: 1, stiffness_n_per_m: 1"},
    KindOfMatter{2, "kind: plane, at_m: [0, 0], normal: y"},
    KindOfMatter{2, "kind: box, center_m: [0, 0], size_m: [1, 1]"},
    KindOfMatter{2, "kind: cylinder, center_m: [0, 0], radius_m: 1"},
};

class MatterKindColour : public testing::TestWithParam<KindOfMatter> {};

TEST_P(MatterKindColour, IsTaken) {
  const Scene scene = scene_with_bob(GetParam().space,
                                     std::string("  a: {") + GetParam().entry + ", color: teal}\n");
  const std::vector<std::optional<Colour>> colours = colours_of(scene);
  ASSERT_GE(colours.size(), 2u);
  for (std::size_t mat = 0; mat + 1 < colours.size(); ++mat) EXPECT_EQ(colours[mat], kTeal) << mat;
  EXPECT_FALSE(colours.back()) << "the bob";
}

INSTANTIATE_TEST_SUITE_P(Kinds, MatterKindColour, testing::ValuesIn(kKinds));

const std::string kFlag = R"(parts:
  flag:
    parameters: {tip_color: '#ff8800'}
    matter:
      pole: {kind: mass, mass_kg: 1, at_m: [0, 0]}
      tip: {kind: mass, mass_kg: 1, at_m: [0, 1], color: $tip_color}
  pair:
    matter:
      left: {part: flag}
      right: {part: flag, translate_m: [2, 0], color: red}
)";

TEST(PartColour, OfAUseIsThatOfMatterWithoutItsOwn) {
  const Scene scene = sound_scene(2, kFlag + R"(matter:
  f: {part: flag, color: red}
  g: {part: flag, translate_m: [9, 9]}
)");
  EXPECT_EQ(colours_of(scene),
            (std::vector<std::optional<Colour>>{kRed, kOrange, std::nullopt, kOrange}));
}

TEST(PartColour, OfAnInnerUseStandsBeforeThatOfAnOuterOne) {
  const Scene scene = sound_scene(2, kFlag +
                                         R"(matter:
  p: {part: pair, color: teal}
  bob: {kind: mass, mass_kg: 1, at_m: [9, 9]}
)");
  EXPECT_EQ(colours_of(scene),
            (std::vector<std::optional<Colour>>{kTeal, kOrange, kRed, kOrange, std::nullopt}));
}

TEST(PartColour, MayBeAParameterAndIsThatOfEveryCopy) {
  const Scene scene = sound_scene(2, kFlag +
                                         R"(matter:
  f: {part: flag, parameters: {tip_color: teal}, repeat: {count: 2, translate_m: [1, 0]},
      color: teal}
)");
  EXPECT_EQ(colours_of(scene), std::vector<std::optional<Colour>>(4, kTeal));
  EXPECT_EQ(scene.colours.size(), 1u) << "neighbours of one colour are one range";
}

TEST(MatterColour, StaysThatOfItsMatsWhenAReductionTakesOthersOut) {
  Scene scene = sound_scene(1, R"(reduce: [series]
matter:
  a: {kind: fixed, at_m: 0, color: red}
  joint: {kind: mass, mass_kg: 0, at_m: 1, color: teal}
  b: {kind: mass, mass_kg: 1, at_m: 2, color: '#ff8800'}
liaisons: {s: {kind: spring, stiffness_n_per_m: 100}}
links:
  - {liaison: s, between: [a, joint]}
  - {liaison: s, between: [joint, b]}
)");
  config::Problems problems;
  scene = plan::reduce(std::move(scene), problems);
  EXPECT_EQ(colours_of(scene), (std::vector<std::optional<Colour>>{kRed, kOrange}));
}

class BadColour : public testing::TestWithParam<BadScene> {};

TEST_P(BadColour, IsRefusedAtItsPlace) {
  expect_only_problem(GetParam());
}

INSTANTIATE_TEST_SUITE_P(
    Colours, BadColour,
    testing::Values(
        BadScene{kHead2, "matter:\n  a: {kind: mass, mass_kg: 1, at_m: [0, 0], color: ^rde}\n",
                 "'color' in matter 'a' must be a colour: a name of CSS as red, or '#rrggbb', got "
                 "'rde'",
                 "did you mean 'red'?"},
        BadScene{kHead2, "matter:\n  a: {kind: mass, mass_kg: 1, at_m: [0, 0], color: ^'#f80'}\n",
                 "'color' in matter 'a' must be a colour: a name of CSS as red, or '#rrggbb', got "
                 "'#f80'",
                 ""},
        BadScene{kHead2,
                 "matter:\n  a: {kind: mass, mass_kg: 1, at_m: [0, 0], color: ^[1, 0, 0]}\n",
                 "'color' in matter 'a' must be a colour: a name of CSS as red, or '#rrggbb', got "
                 "a sequence",
                 ""},
        BadScene{kHead3,
                 R"(matter:
  a: {kind: plane, at_m: [0, 0, 0], normal: y, color: ^transparent}
  b: {kind: mass, mass_kg: 1, at_m: [0, 1, 0]}
)",
                 "'color' in matter 'a' must be a colour: a name of CSS as red, or '#rrggbb', got "
                 "'transparent'",
                 ""}));

TEST(BadColour, BehindAnUnquotedHashIsACommentOfYaml) {
  config::Problems problems;
  load_scene_text(scene_head(2) +
                      R"(matter:
  a:
    kind: mass
    mass_kg: 1
    at_m: [0, 0]
    color: #ff8800
)",
                  "t", problems);
  EXPECT_NE(problems.text().find("'color' in matter 'a' must be a colour"), std::string::npos)
      << problems.text();
  EXPECT_NE(problems.text().find("write it in quotes, as '#ff8800'"), std::string::npos)
      << problems.text();
}

}  // namespace
}  // namespace cordis::scene
