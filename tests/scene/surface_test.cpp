// tests/scene/surface_test.cpp -- planes, boxes, cylinders and polylines as a scene writes them.
#include <cmath>
#include <limits>
#include <memory>

#include "sim_node/engine/world.h"
#include "tests/scene/bad_scene.h"

namespace cordis::scene {
namespace {

using engine::Surface;
using engine::SurfaceKind;
using engine::Vec3;

constexpr double kNoEnd = std::numeric_limits<double>::infinity();

constexpr const char* kTouch = R"(liaisons:
  land: {kind: state_machine, stiffness_n_per_m: 600, pulls: false, range: rest}
links:
  - {liaison: land, between_sets: [floor, balls]}
)";

TEST(SurfaceMatter, IsAFixedMatWithAShape) {
  const Scene scene = sound_scene(3, std::string(R"(matter:
  balls: {kind: mass, ball: {mass_kg: 1, radius_m: 0.1}, at_m: [[0, 1, 0], [1, 1, 0]]}
  floor: {kind: plane, at_m: [1, 2, 3], normal: [0, 3, 4], sides: both}
  step: {kind: box, center_m: [1, 0, 0], size_m: [0.2, 0, 0.4]}
  corner: {kind: box, from_m: [1, 1, 1], to_m: [0, 3, 2]}
  post: {kind: cylinder, center_m: [0, 1, 0], axis: -y, radius_m: 0.2, length_m: 3}
  rod: {kind: cylinder, center_m: [0, 1, 0], axis: [1, 1, 0], radius_m: 0.2}
)") + kTouch);

  const auto& surfaces = scene.network.surfaces;
  ASSERT_EQ(surfaces.size(), 5u);
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    EXPECT_EQ(surfaces[s].mat, 2 + s);
    EXPECT_EQ(scene.network.mats[2 + s].kind, engine::MatKind::kFixed);
    EXPECT_EQ(scene.matter[1 + s].first, 2 + s);
    EXPECT_EQ(scene.radius_m[2 + s], 0.0);
  }
  EXPECT_EQ(surfaces[0].kind, SurfaceKind::kPlane);
  EXPECT_TRUE(surfaces[0].both_sides);
  EXPECT_LT((surfaces[0].axis - Vec3(0.0, 0.6, 0.8)).norm(), 1e-15);
  EXPECT_EQ(surfaces[1].half_size, Vec3(0.1, kNoEnd, 0.2));
  EXPECT_EQ(surfaces[2].half_size, Vec3(0.5, 1.0, 0.5));
  EXPECT_EQ(scene.network.mats[4].position, Vec3(0.5, 2.0, 1.5));
  EXPECT_EQ(surfaces[3].axis, Vec3(0.0, -1.0, 0.0));
  EXPECT_EQ(surfaces[3].half_size, Vec3(0.2, 1.5, 0.0));
  EXPECT_EQ(surfaces[4].half_size[1], kNoEnd);

  ASSERT_EQ(scene.network.sets.size(), 1u);
  const engine::SetLiaison& set = scene.network.sets[0];
  EXPECT_EQ(set.set_p, std::vector<std::uint32_t>{2});
  EXPECT_EQ(set.set_q, (std::vector<std::uint32_t>{0, 1}));
  EXPECT_EQ(set.range, 0.1);
  EXPECT_NO_THROW(engine::Network{scene.network});
}

TEST(SurfaceMatter, ExistsInEveryDimension) {
  const Scene line = sound_scene(1, std::string(R"(matter:
  balls: {kind: mass, ball: {mass_kg: 1, radius_m: 0.1}, at_m: 1}
  floor: {kind: plane, at_m: 0, normal: -x}
  block: {kind: box, from_m: 3, to_m: 4}
)") + kTouch);
  EXPECT_EQ(line.network.surfaces[0].axis, Vec3(-1.0, 0.0, 0.0));
  EXPECT_FALSE(line.network.surfaces[0].both_sides);
  EXPECT_EQ(line.network.surfaces[1].half_size, Vec3(0.5, kNoEnd, kNoEnd));
  EXPECT_NO_THROW(engine::Network{line.network});

  const Scene flat = sound_scene(2, std::string(R"(matter:
  balls: {kind: mass, ball: {mass_kg: 1, radius_m: 0.1}, at_m: [0, 2]}
  floor: {kind: box, center_m: [0, 0], size_m: [4, 1]}
  post: {kind: cylinder, center_m: [1, 1], radius_m: 0.3}
)") + kTouch);
  EXPECT_EQ(flat.network.surfaces[0].half_size, Vec3(2.0, 0.5, kNoEnd));
  EXPECT_EQ(flat.network.surfaces[1].axis, Vec3(0.0, 0.0, 1.0));
  EXPECT_NO_THROW(engine::Network{flat.network});
}

TEST(SurfaceMatter, OfAPolylineIsASegmentBetweenTwoCorners) {
  for (const bool closed : {false, true}) {
    const Scene scene = sound_scene(2, std::string("matter:\n") + R"(
  balls: {kind: mass, ball: {mass_kg: 1, radius_m: 0.1}, at_m: [0, 2]}
  floor: {kind: polyline, corners_m: [[0, 0], [3, 4], [3, 6]])" +
                                           (closed ? ", closed: true}\n" : "}\n") + kTouch);
    const auto& surfaces = scene.network.surfaces;
    ASSERT_EQ(surfaces.size(), closed ? 3U : 2U);
    EXPECT_EQ(scene.matter[1].first, 1u);
    EXPECT_EQ(scene.matter[1].count, surfaces.size());
    EXPECT_EQ(surfaces[0].kind, SurfaceKind::kSegment);
    EXPECT_EQ(surfaces[0].mat, 1u);
    EXPECT_EQ(surfaces[1].mat, 2u);
    EXPECT_EQ(scene.network.mats[1].position, Vec3(1.5, 2.0, 0.0));
    EXPECT_EQ(scene.network.mats[2].position, Vec3(3.0, 5.0, 0.0));
    EXPECT_LT((surfaces[0].axis - Vec3(0.6, 0.8, 0.0)).norm(), 1e-15);
    EXPECT_EQ(surfaces[0].half_size[0], 2.5);
    EXPECT_EQ(surfaces[0].leads_to, surfaces[1].axis);
    EXPECT_EQ(surfaces[1].comes_from, surfaces[0].axis);
    // The line that closes it turns by more than a right angle at both of its ends.
    EXPECT_EQ(surfaces[0].comes_from, Vec3(Vec3::Zero()));
    EXPECT_EQ(surfaces.back().leads_to, Vec3(Vec3::Zero()));
    EXPECT_EQ(scene.network.sets[0].set_p.size(), surfaces.size());
    EXPECT_NO_THROW(engine::Network{scene.network});
  }
}

TEST(SurfaceMatter, IsPutWhereItsPartIs) {
  const Scene scene = sound_scene(2, R"(parts:
  bench:
    matter:
      seat: {kind: box, center_m: [0, 1], size_m: [4, 1]}
      floor: {kind: plane, at_m: [0, 0], normal: y}
      leg: {kind: cylinder, center_m: [1, 0], radius_m: 0.3}
liaisons:
  land: {kind: state_machine, stiffness_n_per_m: 600, pulls: false, range: rest}
matter:
  balls: {kind: mass, ball: {mass_kg: 1, radius_m: 0.1}, at_m: [0, 20]}
  row: {part: bench, rotate_deg: 90, repeat: {count: 2, translate_m: [10, 0]}}
links:
  - {liaison: land, between_sets: [balls, ["row.*"]], name: landing}
)");
  const auto& surfaces = scene.network.surfaces;
  ASSERT_EQ(surfaces.size(), 6u);
  EXPECT_EQ(surfaces[0].half_size.head(2), Eigen::Vector2d(0.5, 2.0));
  EXPECT_EQ(scene.network.mats[surfaces[0].mat].position, Vec3(-1.0, 0.0, 0.0));
  EXPECT_EQ(surfaces[1].axis, Vec3(-1.0, 0.0, 0.0));
  EXPECT_EQ(scene.network.mats[surfaces[5].mat].position, Vec3(0.0, 11.0, 0.0));
  EXPECT_EQ(scene.network.sets[0].set_p.size(), 6u);  // surfaces stand first
  EXPECT_NO_THROW(engine::Network{scene.network});
}

TEST(SurfaceMatter, OfAPolylineTurnsWithItsPart) {
  const Scene scene = sound_scene(2, R"(parts:
  yard:
    matter:
      fence: {kind: polyline, corners_m: [[0, 0], [4, 0], [8, 3]]}
liaisons:
  land: {kind: state_machine, stiffness_n_per_m: 600, pulls: false, range: rest}
matter:
  balls: {kind: mass, ball: {mass_kg: 1, radius_m: 0.1}, at_m: [0, 20]}
  mine: {part: yard, rotate_deg: 90, translate_m: [1, 0]}
links:
  - {liaison: land, between_sets: [balls, ["mine.*"]], name: landing}
)");
  const auto& surfaces = scene.network.surfaces;
  ASSERT_EQ(surfaces.size(), 2u);
  EXPECT_LT((scene.network.mats[surfaces[0].mat].position - Vec3(1.0, 2.0, 0.0)).norm(), 1e-15);
  EXPECT_LT((surfaces[0].axis - Vec3(0.0, 1.0, 0.0)).norm(), 1e-15);
  EXPECT_LT((surfaces[0].leads_to - Vec3(-0.6, 0.8, 0.0)).norm(), 1e-15);
  EXPECT_EQ(surfaces[1].axis, surfaces[0].leads_to);
  EXPECT_EQ(surfaces[1].comes_from, surfaces[0].axis);
  EXPECT_EQ(surfaces[1].leads_to, Vec3(Vec3::Zero()));
  EXPECT_NO_THROW(engine::Network{scene.network});
}

TEST(SurfaceMatter, OfBothSidesIsItsOutsideAndItsInnerFaces) {
  const Scene scene = sound_scene(3, std::string(R"(parts:
  case:
    matter:
      can: {kind: box, center_m: [0, 0, 0], size_m: [0.2, 0.4, 0], sides: both}
matter:
  balls: {kind: mass, ball: {mass_kg: 1, radius_m: 0.1}, at_m: [[0, 1, 0], [1, 1, 0]]}
  floor: {kind: cylinder, center_m: [0, 3, 0], axis: x, radius_m: 0.2, length_m: 3, sides: both}
  post: {kind: cylinder, center_m: [0, 4, 0], axis: x, radius_m: 0.2, sides: one}
  mine: {part: case, rotate: {axis: z, deg: 90}, translate_m: [7, 0, 0]}
)") + kTouch);
  const auto& surfaces = scene.network.surfaces;
  ASSERT_EQ(surfaces.size(), 4u + 1u + 5u);
  EXPECT_EQ(scene.network.sets[0].set_p, (std::vector<std::uint32_t>{2, 3, 4, 5}));
  for (std::size_t s = 0; s < surfaces.size(); ++s) EXPECT_EQ(surfaces[s].mat, 2 + s);
  EXPECT_TRUE(surfaces[0].both_sides);
  EXPECT_EQ(surfaces[1].kind, SurfaceKind::kCylinderWall);
  EXPECT_EQ(surfaces[3].axis, Vec3(-1.0, 0.0, 0.0));
  EXPECT_FALSE(surfaces[4].both_sides);
  EXPECT_EQ(surfaces[5].kind, SurfaceKind::kBox);
  EXPECT_EQ(surfaces[5].half_size, Vec3(0.2, 0.1, kNoEnd)) << "it is turned";
  EXPECT_EQ(surfaces[6].axis, Vec3(0.0, 1.0, 0.0));
  EXPECT_EQ(surfaces[6].half_size, surfaces[5].half_size);
  EXPECT_EQ(scene.network.mats[surfaces[6].mat].position, Vec3(7.0, 0.0, 0.0));
  EXPECT_NO_THROW(engine::Network{scene.network});
}

/// A trapdoor holds a ball for a second, and lets it fall after.
TEST(SurfaceMatter, OpensWhereTheStiffnessOfItsLiaisonEnds) {
  const Scene scene = sound_scene(2, R"yaml(world: {gravity_m_per_s2: [0, -10]}
liaisons:
  gate: {kind: state_machine, stiffness_n_per_m: "if(time_s < 1, 600, 0)",
         viscosity_n_s_per_m: "if(time_s < 1, 0.3, 0)", pulls: false, range: rest}
matter:
  marble: {kind: mass, ball: {mass_kg: 0.01, radius_m: 0.02}, at_m: [0, 0.0198]}
  trapdoor: {kind: box, center_m: [0, -0.01], size_m: [0.2, 0.02]}
links:
  - {liaison: gate, between_sets: [marble, trapdoor]}
)yaml");
  engine::World world(std::make_shared<const engine::Network>(scene.network));
  const auto run_to = [&](double time) {
    while (static_cast<double>(world.step_count()) * scene.network.step < time) world.step();
  };
  run_to(0.99);
  EXPECT_NEAR(world.position(0).y(), 0.02 - 0.1 / 600.0, 1e-5);
  run_to(1.2);
  EXPECT_NEAR(world.position(0).y(), 0.02 - 0.1 / 600.0 - 0.5 * 10.0 * 0.2 * 0.2, 0.003);
}

class BadSurface : public BadScenes {};

TEST_P(BadSurface, HasOneProblemAtItsPlace) {
  expect_only_problem(GetParam());
}

constexpr const char* kOneOfTwo = "a box has two corners, or a center and a size: one of them";
constexpr const char* kOwnSet = "surfaces are a set of their own";
constexpr const char* kWriteSets = "write between_sets: [matter, surfaces]";

INSTANTIATE_TEST_SUITE_P(
    Surfaces, BadSurface,
    testing::Values(
        BadScene{kHead2, "matter:\n  a: ^{kind: plane, at_m: [0, 0]}\n",
                 "missing key 'normal' in matter 'a'", ""},
        BadScene{kHead2, "matter:\n  a: {kind: polyline, corners_m: ^[[0, 0]]}\n",
                 "'corners_m' in matter 'a' must be at least 2 points, got 1", ""},
        BadScene{kHead2,
                 "matter:\n  a: {kind: polyline, corners_m: ^[[0, 0], [1, 0]], closed: true}\n",
                 "'corners_m' in matter 'a' must be at least 3 points, got 2", ""},
        BadScene{kHead2, "matter:\n  a: {kind: polyline, corners_m: ^[[0, 0], [1, 0], [1, 0]]}\n",
                 "two corners of matter 'a' that follow each other are the same point", ""},
        BadScene{kHead2, "matter:\n  a: {kind: plane, at_m: [0, 0], normal: ^[0, 0]}\n",
                 "'normal' in matter 'a' must not be zero", ""},
        BadScene{kHead2, "matter:\n  a: {kind: plane, at_m: [0, 0], normal: ^z}\n",
                 "'normal' in matter 'a': a scene of space 2 has no direction 'z'", ""},
        BadScene{kHead2, "matter:\n  a: {kind: plane, at_m: [0, 0], normal: ^[x, y]}\n",
                 "'normal' in matter 'a' must be one direction", ""},
        BadScene{kHead2, "matter:\n  a: {kind: plane, at_m: [0, 0], normal: y, sides: ^two}\n",
                 "'sides' in matter 'a' must be one of one, both, got 'two'", ""},
        BadScene{kHead2, "matter:\n  a: {kind: plane, at_m: [0, 0], normal: y, ^side: one}\n",
                 "unknown key 'side' in matter 'a'", "did you mean 'sides'?"},
        BadScene{kHead2, "matter:\n  a: {kind: box, center_m: [0, 0], size_m: ^[0, 0]}\n",
                 "a box must have a size along one axis at least", ""},
        BadScene{kHead2, "matter:\n  a: {kind: box, center_m: [0, 0], size_m: ^[-1, 1]}\n",
                 "'size_m' in matter 'a' must be >= 0", ""},
        BadScene{kHead2, "matter:\n  a: {kind: box, from_m: [0, 0], to_m: ^[1, 0]}\n",
                 "the corners of a box must differ along every axis", ""},
        BadScene{kHead2,
                 "matter:\n  a: {kind: box, from_m: [0, 0], to_m: [1, 1], size_m: ^[1, 1]}\n",
                 kOneOfTwo, ""},
        BadScene{kHead2, "matter:\n  a: {kind: cylinder, center_m: [0, 0], radius_m: ^0}\n",
                 "'radius_m' in matter 'a' must be > 0 and <= 1000000, got 0", ""},
        BadScene{kHead2,
                 "matter:\n  a: {kind: cylinder, center_m: [0, 0], radius_m: 1, ^axis: x}\n",
                 "unknown key 'axis' in matter 'a'",
                 "known keys: kind, driven, center_m, radius_m, sides, color"},
        BadScene{kHead1, "matter:\n  a: {kind: ^cylinder, center_m: 0, radius_m: 1}\n",
                 "a cylinder needs a scene of space 2 or 3, this one has 1", ""},
        BadScene{
            kHead2,
            R"(parts: {p: {matter: {^b: {kind: box, center_m: [0, 0], size_m: [1, 1]}}}}
matter:
  a: {part: p, rotate_deg: 30}
)",
            "a box lies along the axes of the scene: a part that has one is turned by quarters "
            "of a circle about them",
            "turn it by a multiple of 90 degrees, or draw it as a polyline of its corners with "
            "closed: true"},
        BadScene{
            kHead3,
            R"(parts: {p: {matter: {^b: {kind: box, center_m: [0, 0, 0], size_m: [1, 1, 1]}}}}
matter:
  a: {part: p, rotate: {axis: z, deg: 30}}
)",
            "a box lies along the axes of the scene: a part that has one is turned by quarters "
            "of a circle about them",
            "turn it by a multiple of 90 degrees, or take a plane for the side that is touched"},
        BadScene{kLinked,
                 R"(  f: {kind: plane, at_m: [0, 0], normal: y}
links:
  - {liaison: s, between: ^[a, f]}
)",
                 "a link joins MATs, and a surface has no place of its own",
                 "write between_sets: [matter, surface], also for one MAT"},
        BadScene{kLinked,
                 R"(  f: {kind: plane, at_m: [0, 0], normal: y}
links:
  - {liaison: s, within: ^[a, f], rest_m: 1, range_m: 1}
)",
                 kOwnSet, kWriteSets},
        BadScene{kLinked,
                 R"(  f: {kind: plane, at_m: [0, 0], normal: y}
links:
  - {liaison: s, between_sets: ^[a, [b, f]], rest_m: 1, range_m: 1}
)",
                 kOwnSet, kWriteSets},
        BadScene{kLinked,
                 R"(  f: {kind: plane, at_m: [0, 0], normal: y}
  g: {kind: plane, at_m: [0, 0], normal: x}
links:
  - {liaison: s, between_sets: ^[f, g], rest_m: 1, range_m: 1}
)",
                 "both sets are surfaces", ""},
        BadScene{kHead2,
                 R"(liaisons:
  v: {elasticity: {kind: lennard_jones, depth_j: 1, diameter_m: 1, cut_m: 3}}
matter:
  a: {kind: mass, mass_kg: 1, at_m: [0, 9]}
  f: {kind: plane, at_m: [0, 0], normal: y}
links:
  - {liaison: ^v, between_sets: [f, a]}
)",
                 "a surface takes no Lennard-Jones law, which has no value inside it",
                 "take rings, a table or an expression"},
        BadScene{kLinked,
                 R"(  f: {kind: plane, at_m: [0, 0], normal: y}
links:
  - {liaison: s, between_sets: [f, a], rest_m: 1, range_m: 1, name: n}
signals:
  p: {of: n, quantity: pieces, near_m: ^0.1}
)",
                 "surfaces are no pieces", "count bound pairs, without near_m"}));

}  // namespace
}  // namespace cordis::scene
