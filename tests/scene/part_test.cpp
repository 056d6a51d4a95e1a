// tests/scene/part_test.cpp
#include "sim_node/scene/sections/part.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include <gtest/gtest.h>
#include <unistd.h>

#include "sim_node/engine/world.h"
#include "tests/scene/bad_scene.h"

namespace cordis::scene {
namespace {

using engine::Vec3;

/// A hub and a rim of three, with spokes.
const std::string kWheel =
    R"(liaisons: {s: {kind: spring, stiffness_n_per_m: 5}}
parts:
  wheel:
    parameters: {mass: 1, size: 1, hub: $mass}
    matter:
      hub: {kind: mass, mass_kg: $hub, at_m: [0, 0]}
      rim: {kind: ring, count: 3, mass_kg: $mass, center_m: [0, 0], radius_m: $size, stiffness_n_per_m: 7}
    links:
      - {liaison: s, between: [hub, rim], name: spokes}
)";

Vec3 position(const Scene& scene, std::size_t mat) {
  return scene.network.mats.at(mat).position;
}

std::vector<std::string> names_of(const std::vector<NamedRange>& ranges) {
  std::vector<std::string> names;
  for (const NamedRange& range : ranges) names.push_back(range.name);
  return names;
}

TEST(Part, IsPutWhereItsUseSays) {
  const Scene scene = sound_scene(
      2, kWheel + "matter:\n  w: {part: wheel, translate_m: [10, 20], rotate_deg: 90}\n");
  ASSERT_EQ(scene.network.mats.size(), 4u);
  EXPECT_EQ(position(scene, 0), Vec3(10, 20, 0));
  EXPECT_EQ(position(scene, 1), Vec3(10, 21, 0));  // (1, 0) by a quarter turn, exactly
  EXPECT_EQ(names_of(scene.matter), (std::vector<std::string>{"w.hub", "w.rim"}));
  EXPECT_EQ(scene.matter[1].first, 1u);
  EXPECT_EQ(scene.matter[1].count, 3u);
  EXPECT_EQ(names_of(scene.links), (std::vector<std::string>{"w.rim.links", "w.spokes"}));
  EXPECT_EQ(scene.network.links[3].mat_b, 1u);
  EXPECT_DOUBLE_EQ(scene.network.links[3].rest_length, 1.0);
}

TEST(Part, TurnsVelocitiesToo) {
  const Scene scene = sound_scene(2,
                                  R"(parts:
  p: {matter: {m: {kind: mass, mass_kg: 1, at_m: [1, 0], velocity_m_per_s: [2, 0]}}}
matter:
  a: {part: p, rotate_deg: -90, translate_m: [5, 5]}
)");
  EXPECT_EQ(position(scene, 0), Vec3(5, 4, 0));
  EXPECT_EQ(scene.network.mats[0].velocity, Vec3(0, -2, 0));
}

TEST(Part, TurnsAboutAnyAxisIn3D) {
  const auto turned = [](const std::string& rotate) {
    return position(sound_scene(3,
                                R"(parts:
  p: {matter: {m: {kind: mass, mass_kg: 1, at_m: [1, 2, 3]}}}
matter:
  a: {part: p, rotate: )" + rotate + "}\n"),
                    0);
  };
  EXPECT_EQ(turned("{axis: x, deg: 90}"), Vec3(1, -3, 2));
  EXPECT_EQ(turned("{axis: -z, deg: 180}"), Vec3(-1, -2, 3));
  EXPECT_TRUE(turned("{axis: [1, 1, 1], deg: 120}").isApprox(Vec3(3, 1, 2), 1e-15));
  EXPECT_TRUE(turned("{axis: y, deg: 30}")
                  .isApprox(Vec3(std::sqrt(0.75) + 1.5, 2, 3 * std::sqrt(0.75) - 0.5), 1e-15));
}

TEST(Part, HasParametersThatAUseOverrides) {
  const Scene scene = sound_scene(2, kWheel +
                                         R"(matter:
  a: {part: wheel}
  b: {part: wheel, parameters: {mass: 3}}
  c: {part: wheel, parameters: {hub: 4, size: 2}}
)");
  const auto mass = [&](std::size_t mat) { return scene.network.mats.at(mat).mass; };
  EXPECT_EQ(mass(0), 1.0);
  EXPECT_EQ(mass(1), 1.0);
  EXPECT_EQ(mass(4), 3.0);  // the hub is as heavy as the rim unless set otherwise
  EXPECT_EQ(mass(5), 3.0);
  EXPECT_EQ(mass(8), 4.0);
  EXPECT_EQ(mass(9), 1.0);
  EXPECT_EQ(position(scene, 9), Vec3(2, 0, 0));
}

TEST(Part, IsRepeatedStepByStep) {
  const Scene scene = sound_scene(2, kWheel +
                                         R"(matter:
  row: {part: wheel, translate_m: [0, 1], repeat: {count: 3, translate_m: [5, 0]}}
links:
  - {liaison: s, between: ["row[0..1].hub", "row[1..2].hub"]}
signals:
  x: {of: "row[2].rim[1]", quantity: position, axis: x}
  e: {of: "row[1].spokes[2]", quantity: elongation}
)");
  ASSERT_EQ(scene.network.mats.size(), 12u);
  EXPECT_EQ(position(scene, 8), Vec3(10, 1, 0));
  EXPECT_EQ(scene.matter[4].name, "row[2].hub");
  EXPECT_EQ(scene.network.links[18].mat_a, 0u);
  EXPECT_EQ(scene.network.links[18].mat_b, 4u);
  EXPECT_EQ(scene.network.links[19].mat_b, 8u);
  EXPECT_EQ(scene.signals.signals()[0].index, 10u);
  EXPECT_EQ(scene.signals.signals()[1].index, 6u + 5u);
}

TEST(Part, StandsInPartsAndEachIsPutInTheOther) {
  const Scene scene = sound_scene(2, kWheel +
                                         R"(  arm:
    parameters: {long: 2}
    matter:
      w: {part: wheel, translate_m: [$long, 0], parameters: {size: 0.5}}
matter:
  carousel: {part: arm, translate_m: [0, 9], repeat: {count: 4, rotate_deg: 90}}
links:
  - {liaison: s, between: ["carousel[1].w.hub", "carousel[3].w.rim[0]"]}
)");
  ASSERT_EQ(scene.network.mats.size(), 16u);
  EXPECT_EQ(position(scene, 0), Vec3(2, 9, 0));
  EXPECT_EQ(position(scene, 4), Vec3(0, 11, 0));
  EXPECT_EQ(position(scene, 5), Vec3(0, 11.5, 0));  // its rim is turned with it
  EXPECT_EQ(position(scene, 8), Vec3(-2, 9, 0));
  EXPECT_EQ(position(scene, 12), Vec3(0, 7, 0));
  EXPECT_EQ(scene.network.links.back().mat_a, 4u);
  EXPECT_EQ(scene.network.links.back().mat_b, 13u);
}

TEST(Part, InOneDimensionIsShiftedAndLaidOut) {
  const Scene scene = sound_scene(1,
                                  R"(parts:
  p: {matter: {m: {kind: mass, mass_kg: 1, at_m: 2, layout_at_m: [0.1, 0]}}}
matter:
  a: {part: p, translate_m: 1, repeat: {count: 3, layout_translate_m: [0, 0.5]}}
)");
  EXPECT_EQ(position(scene, 2), Vec3(3, 0, 0));
  EXPECT_EQ(scene.layout[2].x, 0.1);
  EXPECT_EQ(scene.layout[2].z, 1.0);
}

TEST(Part, RestsWhereItIsPut) {
  const Scene scene = sound_scene(2, kWheel +
                                         R"(matter:
  row: {part: wheel, translate_m: [0.3, 0.7], rotate_deg: 33,
        repeat: {count: 20, translate_m: [0.37, 0.11], rotate_deg: 7}}
)");
  engine::World world(std::make_shared<const engine::Network>(scene.network));
  world.step();
  Vec3 sum = Vec3::Zero();
  for (std::uint32_t i = 0; i < scene.network.mats.size(); ++i) {
    EXPECT_LT(world.link_force(i).norm(), 1e-13);  // 7 N/m times the rounding of some metres
    sum += world.link_force(i);
  }
  EXPECT_LT(sum.norm(), 1e-13);
}

TEST(Part, WithFaultsIsReportedOnceHoweverOftenItIsUsed) {
  config::Problems problems;
  load_scene_text(scene_head(2) +
                      R"(parts:
  p: {matter: {m: {kind: mass, mass_kg: -1, at_m: [1, 0]}, n: {kind: mass, mass_kg: 0, at_m: [1, 0]}}}
  q: {matter: {a: {part: p}, b: {part: p}}}
matter:
  a: {part: q, repeat: {count: 100000}}
  b: {part: p}
signals:
  x: {of: a.b.m, quantity: speed}
)",
                  "t", problems);
  ASSERT_EQ(problems.all().size(), 2u) << problems.text();
  EXPECT_EQ(problems.all()[0].message, "'mass_kg' in matter 'm' of part 'p' must be > 0, got -1");
}

TEST(Part, SaysWhatIsWrongWithItBesideAFaultOfItsUse) {
  config::Problems problems;
  load_scene_text(scene_head(2) +
                      R"(parts:
  p: {matter: {m: {kind: mass, mass_kg: -1, at_m: [1, 0]}}}
matter:
  a: {part: p, translate_m: 3, repeat: {count: 5}}
  b: {part: p, repeat: {count: 0}}
signals:
  x: {of: "a[4].m", quantity: speed}
  y: {of: "b[1].m", quantity: speed}
)",
                  "t", problems);
  std::vector<std::string> said;
  for (const config::Problem& problem : problems.in_order()) said.push_back(problem.message);
  EXPECT_EQ(said, (std::vector<std::string>{
                      "'mass_kg' in matter 'm' of part 'p' must be > 0, got -1",
                      "'translate_m' in matter 'a' must have 2 numbers, got 1",
                      "'count' in 'repeat' of matter 'b' must be between 1 and 1000000, got 0"}));
}

class PartFiles : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder / "parts"); }
  void TearDown() override { std::filesystem::remove_all(folder); }
  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder / name) << text;
  }
  /// What is wrong with a scene that includes a file of parts.
  std::string problems_of(const std::string& include, const std::string& matter) {
    write("scene.yaml", scene_head(2) + "parts: {include: " + include + "}\nmatter:\n" + matter);
    config::Problems problems;
    scene = load_scene((folder / "scene.yaml").string(), problems);
    return problems.text();
  }

  Scene scene;
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) /
      (std::string("cordis_parts_") + std::to_string(getpid()) + "_" +
       testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST_F(PartFiles, BringTheirPartsAndTheLiaisonsOfThese) {
  write("parts/wheel.yaml", "cordis: 1\n" + kWheel);
  write("parts/cart.yaml",
        R"(cordis: 1
parts:
  include: wheel.yaml
  cart: {matter: {front: {part: wheel}, back: {part: wheel, translate_m: [3, 0]}}}
)");

  EXPECT_EQ(problems_of("[parts/cart.yaml, parts/wheel.yaml]", "  a: {part: cart}\n"), "");
  EXPECT_EQ(scene.network.mats.size(), 8u);
  EXPECT_EQ(names_of(scene.matter)[2], "a.back.hub");
}

TEST_F(PartFiles, ReportWhatIsWrongAtTheirOwnPlace) {
  write("parts/a.yaml", R"(cordis: 1
parts:
  include: b.yaml
)");
  write("parts/b.yaml",
        R"(cordis: 1
parts:
  include: a.yaml
  p: {matter: {m: {kind: fixed, at_m: [0, 0, 0]}}}
)");

  const std::string report = problems_of("parts/a.yaml", "  a: {part: p}\n");

  EXPECT_NE(report.find("b.yaml:3:12: error: 'a.yaml' includes itself"), std::string::npos)
      << report;
  EXPECT_NE(report.find("b.yaml:4:39: error: 'at_m' in matter 'm' of part 'p' must be 2 numbers"),
            std::string::npos)
      << report;
}

class BadPart : public BadScenes {};

TEST_P(BadPart, HasOneProblemAtItsPlace) {
  expect_only_problem(GetParam());
}

INSTANTIATE_TEST_SUITE_P(
    Parts, BadPart,
    testing::Values(
        BadScene{kHead2,
                 R"(parts:
  wheel: {matter: {m: {kind: fixed, at_m: [0, 0]}}}
matter:
  a: {part: ^weel}
)",
                 "no part is named 'weel'", "did you mean 'wheel'?"},
        BadScene{kHead2, "matter:\n  a: {part: ^[p]}\n",
                 "a part is called by its name, got a sequence", ""},
        BadScene{kHead2,
                 R"(parts:
  a: {matter: {x: {part: b}}}
  b: {matter: {y: {part: c}}}
  c: {matter: {z: {part: ^a}}}
matter:
  m: {part: a}
)",
                 "part 'a' contains itself: a > b > c > a", ""},
        BadScene{kHead2,
                 R"(parts:
  a: {matter: {x: {part: b}}}
  b: {matter: {y: {part: ^b}}}
matter:
  m: {part: a}
)",
                 "part 'b' contains itself: b > b", ""},
        BadScene{kHead2,
                 R"(parts:
  p: {^signals: {}, matter: {m: {kind: fixed, at_m: [0, 0]}}}
matter:
  b: {kind: mass, mass_kg: 1, at_m: [0, 0]}
)",
                 "unknown key 'signals' in part 'p'",
                 "known keys: parameters, ports, matter, links"},
        BadScene{kHead2, R"(parts:
  p: {matter: ^{}}
matter:
  a: {part: p}
)",
                 "part 'p' has no matter", ""},
        BadScene{kHead2,
                 R"(parts:
  p: {matter: {m: {kind: mass, mass_kg: ^$mas, at_m: [0, 0]}}, parameters: {mass: 1}}
matter:
  a: {part: p}
)",
                 "part 'p' has no parameter 'mas'", "did you mean 'mass'?"},
        BadScene{kHead2,
                 R"(parts:
  p: {matter: {m: {kind: mass, mass_kg: $mass, at_m: [0, 0]}}, parameters: {mass: 1}}
matter:
  a: {part: p, parameters: {^mas: 3}}
)",
                 "part 'p' has no parameter 'mas'", "did you mean 'mass'?"},
        BadScene{kHead2,
                 R"(parts:
  p: {matter: {m: {kind: mass, mass_kg: $mass, at_m: [0, 0]}}, parameters: {mass: }}
matter:
  ^a: {part: p}
)",
                 "part 'p' needs a value for the parameter 'mass'", ""},
        BadScene{kHead2,
                 R"(parts:
  p: {matter: {m: {kind: mass, mass_kg: $mass, at_m: [0, 0]}}, parameters: {mass: 1}}
matter:
  a: {part: p, parameters: {mass: ^-3}}
)",
                 "'mass_kg' in matter 'm' of part 'p' must be > 0, got -3", ""},
        BadScene{kHead2,
                 R"(parts:
  p:
    parameters: {mass: 1, place: [0, 0], way: $place, ^len: 0.2}
    matter: {m: {kind: mass, mass_kg: $mass, at_m: $way}}
matter:
  a: {part: p, repeat: {count: 6, translate_m: [1, 0]}, parameters: {len: 0.3, way: [1, 1]}}
)",
                 "parameter 'len' of part 'p' is used nowhere", ""},
        BadScene{kHead2,
                 R"(parts:
  p: {matter: {m: {kind: mass, mass_kg: $mass, at_m: [0, 0]}}, parameters: {mass: 1}}
matter:
  a: {part: p, parameters: {mass: ^3 * 1.2599}}
)",
                 "'mass_kg' in matter 'm' of part 'p' must be a number, got '3 * 1.2599'",
                 "write one number: this takes no formula"},
        BadScene{kHead2,
                 R"(parts:
  p: {matter: {m: {kind: fixed, at_m: [0, 0]}}}
matter:
  a: {part: p, repeat: {count: ^0}}
)",
                 "'count' in 'repeat' of matter 'a' must be between 1 and 1000000, got 0", ""},
        BadScene{kHead1,
                 R"(parts:
  p: {matter: {m: {kind: fixed, at_m: 0}}}
matter:
  a: {part: p, ^rotate_deg: 3}
)",
                 "unknown key 'rotate_deg' in matter 'a'",
                 "known keys: part, translate_m, layout_translate_m, parameters, repeat, color, "
                 "fixed, driven, velocity_m_per_s"},
        BadScene{kHead3,
                 R"(parts:
  p: {matter: {m: {kind: fixed, at_m: [0, 0, 0]}}}
matter:
  a: {part: p, rotate: {deg: 3, axis: ^[0, 0, 0]}}
)",
                 "'axis' in 'rotate' of matter 'a' must not be zero", ""},
        BadScene{kHead3,
                 R"(parts:
  p: {matter: {m: {kind: fixed, at_m: [0, 0, 0]}}}
matter:
  a: {part: p, rotate: ^{deg: 3}}
)",
                 "missing key 'axis' in 'rotate' of matter 'a'", ""},
        BadScene{kHead2,
                 R"(parts:
  p: {matter: {^m: {kind: lattice, structure: square, corner_m: [0, 0], counts: [1000, 600],
                    mass_kg: 1, spacing_m: 1}}}
matter:
  a: {part: p, repeat: {count: 2}}
)",
                 "the scene has more than 1000000 MATs or 8000000 links", ""},
        BadScene{kHead2,
                 R"(parts:
  p: {matter: {m: {kind: mass, mass_kg: 1, at_m: [0, 0]}}}
matter:
  a: {part: p, repeat: {count: 2}}
signals:
  s: {of: ^"a[2].m", quantity: speed}
)",
                 "'a' has the copies 0 to 1, got 2", ""}));

}  // namespace
}  // namespace cordis::scene
