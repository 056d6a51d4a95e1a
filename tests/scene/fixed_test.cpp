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

TEST(FixedMatter, NeedsNoLiaison) {
  std::size_t changed = 0;
  for (const FixedMatter& matter : kMatter) {
    SCOPED_TRACE(matter.keys);
    std::string keys = matter.keys;
    const Scene joined = scene_with_bob(matter.space, "  a: {" + keys + ", fixed: true}\n");
    for (const std::string stiffness : {", stiffness_n_per_m: 9", "stiffness_n_per_m: 3"}) {
      const auto place = keys.find(stiffness);
      if (place != std::string::npos) keys.erase(place, stiffness.size());
    }
    const Scene scene = scene_with_bob(matter.space, "  a: {" + keys + ", fixed: true}\n");
    EXPECT_EQ(scene.network.links.size(), 0u);
    ASSERT_EQ(scene.network.mats.size(), joined.network.mats.size());
    for (std::size_t i = 0; i < scene.network.mats.size(); ++i) {
      EXPECT_EQ(scene.network.mats[i].position, joined.network.mats[i].position);
      EXPECT_EQ(scene.network.mats[i].kind, joined.network.mats[i].kind);
    }
    changed += keys == matter.keys ? 0 : 1;
    const Scene led =
        scene_with_bob(matter.space, "  a: {" + keys + ", driven: {displacement_m: [" +
                                         std::string(matter.space == 1   ? "time_s"
                                                     : matter.space == 2 ? "time_s, 0"
                                                                         : "time_s, 0, 0") +
                                         "]}}\n");
    EXPECT_EQ(led.network.drives.size(), scene.network.mats.size() - 1);
  }
  EXPECT_EQ(changed, 5u);
}

constexpr const char* kWheel = R"(parts:
  wheel:
    matter:
      hub: {kind: mass, ball: {mass_kg: 2, radius_m: 0.1}, at_m: [0, 0]}
      rim: {kind: ring, count: 5, mass_kg: 1, center_m: [0, 0], radius_m: 1, stiffness_n_per_m: 9,
            medium_viscosity_n_s_per_m: 2}
)";

TEST(FixedMatter, MayBeTheUseOfAPart) {
  const Scene scene = scene_with_bob(2, R"(  w: {part: wheel, fixed: true, translate_m: [1, 0]}
  row: {part: wheel, fixed: true, repeat: {count: 2, translate_m: [0, 3]}}
  moves: {part: wheel, fixed: false, translate_m: [5, 0]}
  led: {part: wheel, fixed: true, driven: {displacement_m: [0, time_s]}}
)",
                                     kWheel);
  const auto& mats = scene.network.mats;
  ASSERT_EQ(mats.size(), 5u * 6u + 1u);
  for (std::size_t i = 0; i < mats.size(); ++i) {
    const MatKind kind = i < 18   ? MatKind::kFixed
                         : i < 24 ? MatKind::kMass
                         : i < 30 ? MatKind::kPort
                                  : MatKind::kMass;
    EXPECT_EQ(mats[i].kind, kind) << i;
    EXPECT_EQ(mats[i].mass > 0.0, kind == MatKind::kMass) << i;
  }
  EXPECT_EQ(mats[0].position, engine::Vec3(1, 0, 0));
  EXPECT_EQ(scene.network.radius[0], 0.1);
  EXPECT_EQ(scene.network.drives.size(), 6u);
}

TEST(FixedMatter, OfAPartHasNothingThatMovesIt) {
  const std::pair<const char*, const char*> cases[] = {
      {"matter: {x: {kind: mass, mass_kg: 1, at_m: [0, 0], velocity_m_per_s: [1, 0]}}",
       "matter 'w' is fixed, and starts in motion"},
      {"matter: {x: {kind: mass, mass_kg: 1, at_m: [0, 0], driven: {force_n: [time_s, 0]}}}",
       "matter 'w' is fixed, and is driven"},
      {"ports: {x: {device: hand, axes: [0], role: mass, at_m: [0, 0], along: x}}",
       "matter 'w' is fixed, and has a port, which its device moves"},
  };
  for (const auto& [body, message] : cases) {
    SCOPED_TRACE(body);
    config::Problems problems;
    const std::string text = std::string(R"(cordis: 1
name: t
space: 2
step: {rate_hz: 1000}
matter:
  bob: {kind: mass, mass_kg: 1, at_m: [9, 9]}
  w: {part: p, fixed: true}
parts: {p: {)") + body + "}}\n";
    load_scene_text(text, "t", problems);
    EXPECT_EQ(problems.error_count(), 1u) << problems.text();
    EXPECT_NE(problems.text().find(std::string("t:7:23: error: ") + message + "\n"),
              std::string::npos)
        << problems.text();
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
