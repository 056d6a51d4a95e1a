// tests/scene/fixed_test.cpp -- `fixed: true` on every kind of matter.
#include "tests/scene/bad_scene.h"

namespace cordis::scene {
namespace {

using engine::MatKind;

struct FixedMatter {
  int space;
  const char* keys;  ///< without a mass
};
constexpr FixedMatter kMatter[] = {
    {1, "kind: mass, at_m: [0, 1]"},
    {2, "kind: points, at_m: [[0, 0], [1, 0]]"},
    {2, "kind: string, count: 4, from_m: [0, 0], to_m: [1, 0], stiffness_n_per_m: 9"},
    {2, "kind: ring, count: 5, center_m: [0, 0], radius_m: 1, stiffness_n_per_m: 9"},
    {3, "kind: grid, rows: 2, columns: 3, corner_m: [0, 0, 0], spacing_m: 1, stiffness_n_per_m: 9"},
    {2, "kind: lattice, structure: square, corner_m: [0, 0], counts: [3, 3], spacing_m: 1"},
    {3, "kind: lattice, structure: fcc, corner_m: [0, 0, 0], counts: [2, 2, 2], spacing_m: 1"},
    {2, "kind: disc, center_m: [0, 0], radius_m: 2, spacing_m: 1"},
    {3, "kind: ball, center_m: [0, 0, 0], radius_m: 2, spacing_m: 1"},
    {2, "kind: pack, count: 3, ball: {radius_m: 0.1}, region: {from_m: [0, 0], to_m: [1, 1]}"},
    {2,
     "kind: skin, center_m: [0, 0], radius_m: 1, count: 6, stiffness_n_per_m: 9, "
     "core: {stiffness_n_per_m: 3}"},
    {2, "kind: beam, cells: 2, from_m: [0, 0], to_m: [1, 0], height_m: 0.2, stiffness_n_per_m: 9"},
};

TEST(FixedMatter, NeverMovesWhateverItsKind) {
  for (const FixedMatter& matter : kMatter) {
    SCOPED_TRACE(matter.keys);
    const std::string entry = std::string("  a: {") + matter.keys + ", fixed: true}\n";
    const Scene scene = scene_with_bob(matter.space, entry);
    const auto& mats = scene.network.mats;
    ASSERT_GT(mats.size(), 2u);
    for (std::size_t i = 0; i + 1 < mats.size(); ++i) EXPECT_EQ(mats[i].kind, MatKind::kFixed);
    EXPECT_EQ(mats.back().kind, MatKind::kMass);
  }
}

TEST(FixedMatter, HasThePlacesAndLinksOfThatWhichMoves) {
  for (const FixedMatter& matter : kMatter) {
    SCOPED_TRACE(matter.keys);
    std::string keys = matter.keys;
    const std::string ball = "ball: {";
    const auto place = keys.find(ball);
    if (place != std::string::npos) {
      keys.insert(place + ball.size(), "mass_kg: 2, ");
    } else {
      keys += ", mass_kg: 2";
    }
    const auto core = keys.find("core: {");
    if (core != std::string::npos) keys.insert(core + 7, "mass_kg: 2, ");
    const Scene moving = scene_with_bob(matter.space, "  a: {" + keys + ", fixed: false}\n");
    const Scene still = scene_with_bob(matter.space, "  a: {" + keys + ", fixed: true}\n");
    ASSERT_EQ(still.network.mats.size(), moving.network.mats.size());
    EXPECT_EQ(still.network.links.size(), moving.network.links.size());
    for (std::size_t i = 0; i + 1 < moving.network.mats.size(); ++i) {
      EXPECT_EQ(still.network.mats[i].position, moving.network.mats[i].position);
      EXPECT_EQ(moving.network.mats[i].kind, MatKind::kMass);
      EXPECT_EQ(still.network.mats[i].kind, MatKind::kFixed);
    }
  }
}

TEST(FixedMatter, MayBeDrivenAsAWhole) {
  const Scene scene = scene_with_bob(
      2,
      R"(  a: {kind: lattice, structure: square, corner_m: [0, 0], counts: [2, 2], spacing_m: 1,
      fixed: true, driven: {displacement_m: [0, time_s]}}
)");
  EXPECT_EQ(scene.network.drives.size(), 4u);
  EXPECT_EQ(scene.network.time_functions.size(), 1u);
}

class BadFixed : public testing::TestWithParam<BadScene> {};

TEST_P(BadFixed, HasOneProblemAtItsPlace) {
  expect_only_problem(GetParam());
}

INSTANTIATE_TEST_SUITE_P(
    Scene, BadFixed,
    testing::Values(
        BadScene{kHead1, "matter:\n  a: {kind: mass, at_m: 0, fixed: true, velocity_m_per_s: ^2}\n",
                 "what is fixed has no velocity: 'velocity_m_per_s' in matter 'a' contradicts "
                 "'fixed'",
                 ""},
        BadScene{kHead1,
                 "matter:\n  a: {kind: points, at_m: [0], fixed: true, velocity_m_per_s: ^2}\n",
                 "what is fixed has no velocity: 'velocity_m_per_s' in matter 'a' contradicts "
                 "'fixed'",
                 ""},
        BadScene{kHead1, "matter:\n  a: {kind: mass, mass_kg: 1, at_m: 0, fixed: ^maybe}\n",
                 "'fixed' in matter 'a' must be true or false, got 'maybe'", ""},
        BadScene{kHead1, "matter:\n  a: ^{kind: mass, at_m: 0, fixed: false}\n",
                 "missing key 'mass_kg' in matter 'a'", ""}));

}  // namespace
}  // namespace cordis::scene
