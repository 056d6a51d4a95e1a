// tests/scene/driven_test.cpp -- matter that follows a function of time, as a scene writes it.
#include <cmath>

#include "tests/scene/bad_scene.h"

namespace cordis::scene {
namespace {

using engine::MatKind;
using engine::Vec3;

Vec3 place_at(const Scene& scene, std::size_t drive, double time) {
  return value_at(scene.network, scene.network.drives.at(drive), time);
}

TEST(DrivenMatter, FollowsAFormulaOfTime) {
  const Scene scene = scene_with_bob(2, R"YAML(
  bow: {kind: fixed, driven: {position_m: ["0.1 + 0.2 * time_s", "sin(2 * pi * time_s)"]}}
  plate: {kind: points, at_m: [[1, 0], [2, 0]], mass_kg: 1,
          driven: {parameters: {depth: 0.02, f: 3 }, displacement_m: [0, "-depth * (1 - cos(f * time_s))"]}}
)YAML");

  ASSERT_EQ(scene.network.mats.size(), 4u);
  ASSERT_EQ(scene.network.drives.size(), 3u);
  EXPECT_EQ(scene.network.time_functions.size(), 2u);
  EXPECT_EQ(scene.network.mats[0].kind, MatKind::kPort);
  EXPECT_EQ(scene.network.mats[0].position, Vec3(0.1, 0, 0));
  EXPECT_EQ(scene.network.mats[3].kind, MatKind::kMass);
  EXPECT_TRUE(scene.ports.empty());
  for (const double t : {0.0, 0.3, 1.7}) {
    const Vec3 bow(0.1 + 0.2 * t, std::sin(2 * 3.14159265358979323846 * t), 0.0);
    EXPECT_LT((place_at(scene, 0, t) - bow).norm(), 1e-15);
    const double down = -0.02 * (1 - std::cos(3 * t));
    EXPECT_LT((place_at(scene, 1, t) - Vec3(1, down, 0)).norm(), 1e-15);
    EXPECT_LT((place_at(scene, 2, t) - Vec3(2, down, 0)).norm(), 1e-15);
  }
}

TEST(DrivenMatter, FollowsATable) {
  const Scene scene = scene_with_bob(1, R"(
  a: {kind: fixed, at_m: 0.5, driven: {position_m: {at_s: [0, 2], values: [0.5, 1.5]}}}
  b: {kind: fixed, at_m: 3, driven: {displacement_m: {at_s: [1, 2], values: [0, 1], between: smooth}}}
)");

  EXPECT_DOUBLE_EQ(place_at(scene, 0, 0.5).x(), 0.75);
  EXPECT_DOUBLE_EQ(place_at(scene, 0, 9.0).x(), 1.5);
  EXPECT_DOUBLE_EQ(place_at(scene, 1, 0.5).x(), 3.0);
  EXPECT_DOUBLE_EQ(place_at(scene, 1, 1.5).x(), 3.5);
  EXPECT_NEAR(place_at(scene, 1, 1.25).x(), 3.0 + 3.0 / 16.0 - 2.0 / 64.0, 1e-15);
}

TEST(DrivenMatter, IsPushedByAForce) {
  const Scene scene = scene_with_bob(2, R"(
  s: {kind: string, count: 4, from_m: [0, 0], to_m: [1, 0], ends: fixed, mass_kg: 0.1,
      stiffness_n_per_m: 10, driven: {force_n: [0, "2 * time_s"]}}
)");

  ASSERT_EQ(scene.network.drives.size(), 2u);  // its ends do not move
  EXPECT_TRUE(scene.network.drives[0].is_force);
  EXPECT_EQ(scene.network.drives[0].mat, 1u);
  EXPECT_EQ(place_at(scene, 1, 1.5), Vec3(0, 3, 0));
}

TEST(DrivenMatter, IsTurnedAndShiftedWithItsPart) {
  config::Problems problems;
  const Scene scene = load_scene_text(scene_head(2) + R"(parts:
  arm:
    matter:
      tip: {kind: fixed, driven: {position_m: ["1 + time_s", 0]}}
      pad: {kind: mass, mass_kg: 1, at_m: [2, 0], driven: {force_n: [5, 0]}}
matter:
  first: {part: arm, translate_m: [10, 0], rotate_deg: 90}
  second: {part: arm, translate_m: [20, 0], rotate_deg: 33}
)",
                                      "t", problems);

  ASSERT_EQ(problems.text(), "");
  ASSERT_EQ(scene.network.drives.size(), 4u);
  EXPECT_LT((place_at(scene, 0, 0.0) - Vec3(10, 1, 0)).norm(), 1e-12);
  EXPECT_LT((place_at(scene, 0, 2.0) - Vec3(10, 3, 0)).norm(), 1e-12);
  EXPECT_LT((place_at(scene, 1, 2.0) - Vec3(0, 5, 0)).norm(), 1e-12);
  const double angle = 33.0 * 3.14159265358979323846 / 180.0;
  EXPECT_LT(
      (place_at(scene, 2, 2.0) - Vec3(20 + 3 * std::cos(angle), 3 * std::sin(angle), 0)).norm(),
      1e-12);
}

constexpr const char* kGong = R"(parts:
  gong:
    matter:
      plate: {kind: string, count: 3, from_m: [0, 0], to_m: [1, 0], ends: first_fixed, mass_kg: 1, stiffness_n_per_m: 5}
)";

TEST(DrivenMatter, IsAPartAsAWhole) {
  const Scene scene = sound_scene(2, std::string(kGong) + R"YAML(matter:
  moved: {part: gong, rotate_deg: 90, repeat: {count: 2, translate_m: [0, 1]}, driven: {displacement_m: [0, "time_s"]}}
  pushed: {part: gong, translate_m: [5, 0], driven: {force_n: [1, "2 * time_s"]}}
)YAML");

  ASSERT_EQ(scene.network.drives.size(), 6u + 2u);
  EXPECT_EQ(scene.network.time_functions.size(), 2u);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(scene.network.mats[i].kind, MatKind::kPort);
    EXPECT_EQ(place_at(scene, i, 0.0), scene.network.mats[i].position);
    EXPECT_LT((place_at(scene, i, 2.0) - scene.network.mats[i].position - Vec3(0, 2, 0)).norm(),
              1e-15);
  }
  EXPECT_EQ(scene.network.mats[6].kind, MatKind::kFixed);
  EXPECT_EQ(place_at(scene, 6, 3.0), Vec3(1, 6, 0));
  EXPECT_EQ(scene.network.drives[7].mat, 8u);
}

TEST(DrivenMatter, OfAPartIsTurnedByThePartsAroundIt) {
  const Scene scene = sound_scene(2, std::string(kGong) + R"YAML(  frame:
    matter:
      inner: {part: gong, rotate_deg: 45, driven: {displacement_m: [time_s, 0]}}
matter:
  outer: {part: frame, rotate_deg: 90, translate_m: [3, 0]}
  bob: {kind: mass, mass_kg: 1, at_m: [9, 9]}
)YAML");

  ASSERT_EQ(scene.network.drives.size(), 3u);
  EXPECT_LT((place_at(scene, 2, 2.0) - scene.network.mats[2].position - Vec3(0, 2, 0)).norm(),
            1e-15);
}

TEST(DrivenMatter, OfSurfacesIsThatOfTheirMats) {
  const Scene scene = sound_scene(2, R"YAML(
matter:
  floor: {kind: plane, at_m: [0, 1], normal: y, driven: {displacement_m: [0, 2 * time_s]}}
  ram: {kind: box, center_m: [3, 0], size_m: [1, 1], driven: {displacement_m: {at_s: [0, 1], values: [[0, 0], [1, 0]]}}}
  post: {kind: cylinder, center_m: [0, 5], radius_m: 1, driven: {displacement_m: [time_s, 0]}}
  hills: {kind: polyline, corners_m: [[0, 0], [2, 0], [4, 2]], driven: {displacement_m: [0, time_s]}}
  bob: {kind: mass, mass_kg: 1, at_m: [9, 9]}
)YAML");
  ASSERT_EQ(scene.network.surfaces.size(), 5u);
  ASSERT_EQ(scene.network.drives.size(), 5u);
  const Vec3 places[] = {Vec3(0, 2, 0), Vec3(3.5, 0, 0), Vec3(0.5, 5, 0), Vec3(1, 0.5, 0),
                         Vec3(3, 1.5, 0)};
  for (std::uint32_t i = 0; i < 5; ++i) {
    EXPECT_EQ(scene.network.surfaces[i].mat, i);
    EXPECT_EQ(scene.network.mats[i].kind, MatKind::kPort);
    EXPECT_EQ(place_at(scene, i, 0.0), scene.network.mats[i].position);
    EXPECT_EQ(place_at(scene, i, 0.5), places[i]);
  }
  EXPECT_EQ(scene.network.drives[3].function, scene.network.drives[4].function);
}

TEST(DrivenMatter, OfAPartTakesItsSurfacesAlong) {
  const Scene scene = sound_scene(2, R"YAML(
parts:
  sieve:
    matter:
      wire: {kind: cylinder, center_m: [1, 0], radius_m: 0.1}
      wall: {kind: plane, at_m: [0, 0], normal: x}
      rim: {kind: fixed, at_m: [0, 0]}
matter:
  u: {part: sieve, rotate_deg: 90, driven: {displacement_m: [3 * time_s, 0]}}
  bob: {kind: mass, mass_kg: 1, at_m: [9, 9]}
)YAML");
  ASSERT_EQ(scene.network.drives.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 way = place_at(scene, i, 1.0) - scene.network.mats[i].position;
    EXPECT_LT((way - Vec3(3, 0, 0)).norm(), 1e-15);
  }
  EXPECT_LT((scene.network.surfaces[1].axis - Vec3(0, 1, 0)).norm(), 1e-15);
}

constexpr BadScene kBadDriven[] = {
    {kHead1, R"(matter:
  a: {kind: fixed, at_m: 0, driven: {parameters: {v: ^2}, displacement_m: time_s}}
  b: {kind: mass, mass_kg: 1, at_m: 0}
)",
     "parameter 'v' of 'driven' of matter 'a' is used nowhere", ""},
    {kHead2,
     R"(parts:
  p: {matter: {a: {kind: fixed, at_m: [0, 0]}}}
matter:
  u: {part: p, driven: ^{position_m: [0, 0]}}
)",
     "'position_m' drives one MAT: matter 'u' follows displacement_m or force_n", ""},
    {kHead2,
     R"(parts:
  p: {matter: {a: {kind: fixed, driven: {position_m: [0, 0]}}}}
matter:
  u: {part: p, driven: ^{displacement_m: [0, 0]}}
)",
     "matter 'u' has matter that is driven already", ""},
    {kHead2,
     R"(parts:
  p: {matter: {a: {kind: plane, at_m: [0, 0], normal: y}}}
matter:
  u: {part: p, driven: ^{force_n: [0, 1]}}
)",
     "'force_n' drives masses, matter 'u' has none", ""},
    {kHead2,
     R"(parts:
  p: {matter: {a: {kind: mass, mass_kg: 1, at_m: [0, 0], velocity_m_per_s: [1, 0]}}}
matter:
  u: {part: p, driven: ^{displacement_m: [0, 0]}}
)",
     "a driven position has the velocity of its function, and matter 'u' has one of its own", ""},

    {kHead1, "matter:\n  a: {kind: fixed, at_m: 0, driven: ^{}}\n",
     "'driven' of matter 'a' needs position_m, displacement_m or force_n", ""},
    {kHead1, "matter:\n  a: {kind: fixed, driven: {position_m: time_s, force_n: ^1}}\n",
     "either 'position_m' or 'force_n' can be given in 'driven' of matter 'a'", ""},
    {kHead2, "matter:\n  a: {kind: fixed, driven: {position_m: ^[time_s]}}\n",
     "'position_m' in 'driven' of matter 'a' must be 2 formulas, one for each axis, or a table, "
     "got 1",
     ""},
    {kHead1, "matter:\n  a: {kind: fixed, driven: {position_m: \"2 * ^tme_s\"}}\n",
     "'position_m' in 'driven' of matter 'a' cannot ask for 'tme_s'", "did you mean 'time_s'?"},
    {kHead1, "matter:\n  a: {kind: fixed, driven: {position_m: \"2 * ^elongation_m\"}}\n",
     "'position_m' in 'driven' of matter 'a' cannot ask for 'elongation_m'",
     "it may ask for time_s, pi and its parameters"},
    {kHead1, "matter:\n  a: {kind: fixed, driven: {position_m: \"if(^rising(time_s), 1, 0)\"}}\n",
     "'position_m' in 'driven' of matter 'a' cannot ask for 'rising' or 'falling'", ""},
    {kHead1, "matter:\n  a: {kind: fixed, driven: {position_m: ^\"time_s > 1\"}}\n",
     "'position_m' in 'driven' of matter 'a' must be a number, got a comparison",
     "write if(..., 1, 0)"},
    {kHead1, "matter:\n  a: {kind: fixed, driven: {position_m: ^\"log(time_s)\"}}\n",
     "'position_m' in 'driven' of matter 'a' is no finite number at 0 s", ""},
    {kHead1, "matter:\n  a: {kind: fixed, driven: {position_m: ^\"2000000 + time_s\"}}\n",
     "'position_m' in 'driven' of matter 'a' begins farther than 1e6 m away", ""},
    {kHead1, "matter:\n  a: {kind: fixed, at_m: 1, driven: {displacement_m: ^\"cos(time_s)\"}}\n",
     "'displacement_m' in 'driven' of matter 'a' must be 0 at 0 s, where the matter is, got 1",
     "subtract that, or put the matter there"},
    {kHead1, "matter:\n  a: {kind: fixed, at_m: ^1, driven: {position_m: \"2 + time_s\"}}\n",
     "'at_m' in matter 'a' must be where 'position_m' is at 0 s, or be left out", ""},
    {kHead1, "matter:\n  a: {kind: fixed, at_m: [1, 2], driven: ^{position_m: 1}}\n",
     "'position_m' drives one MAT, matter 'a' has 2",
     "write displacement_m: it moves all of them alike"},
    {kHead1,
     R"(matter:
  a: {kind: mass, mass_kg: 1, at_m: 0, velocity_m_per_s: ^1, driven: {position_m: time_s}}
)",
     "a driven position has the velocity of its function: 'velocity_m_per_s' in matter 'a' "
     "contradicts it",
     ""},
    {kHead1, "matter:\n  a: {kind: fixed, at_m: 0, driven: ^{force_n: 1}}\n",
     "'force_n' drives masses, matter 'a' has none", ""},
    {kHead2,
     "matter:\n  a: {kind: plane, at_m: [0, 0], normal: y, driven: ^{position_m: [0, 0]}}\n",
     "a surface follows displacement_m", ""},
    {kHead2,
     R"(matter:
  a: {kind: polyline, corners_m: [[0, 0], [1, 0], [2, 1]], driven: ^{force_n: [0, 0]}}
)",
     "a surface follows displacement_m", ""},
    {kHead2,
     R"(matter:
  a: {kind: box, center_m: [0, 0], size_m: [1, 1], ^velocity_m_per_s: [1, 0], driven: {displacement_m: [0, 0]}}
)",
     "unknown key 'velocity_m_per_s' in matter 'a'",
     "known keys: kind, driven, center_m, size_m, sides, color"},
    {kHead1,
     "matter:\n  a: {kind: fixed, driven: {position_m: {at_s: ^[0, 2, 2], values: [1, 2, 3]}}}\n",
     "'at_s' in 'position_m' in 'driven' of matter 'a' must grow from each time to the next, got 2 "
     "before 2",
     ""},
    {kHead1, "matter:\n  a: {kind: fixed, driven: {position_m: {at_s: [0, 2], values: ^[1]}}}\n",
     "'values' in 'position_m' in 'driven' of matter 'a' must be 2, one for each time, got 1", ""},
    {kHead1,
     R"(matter:
  a: {kind: fixed, driven: {position_m: {at_s: [0], values: [1], between: ^stairs}}}
)",
     "'between' in 'position_m' in 'driven' of matter 'a' must be one of linear, smooth, got "
     "'stairs'",
     ""},
};

class BadDriven : public testing::TestWithParam<BadScene> {};

TEST_P(BadDriven, HasOneProblemAtItsPlace) {
  expect_only_problem(GetParam());
}

INSTANTIATE_TEST_SUITE_P(Scene, BadDriven, testing::ValuesIn(kBadDriven));

}  // namespace
}  // namespace cordis::scene
