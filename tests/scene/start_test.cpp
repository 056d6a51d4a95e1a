// tests/scene/start_test.cpp -- matter that starts with a velocity, a spin or away from its place.
#include <cmath>
#include <memory>
#include <random>

#include <Eigen/Geometry>

#include "sim_node/engine/world.h"
#include "tests/scene/bad_scene.h"

namespace cordis::scene {
namespace {

using engine::Mat;
using engine::MatKind;
using engine::Vec3;

constexpr double kPi = 3.14159265358979323846;

struct SpunMatter {
  int space;
  const char* keys;
};
constexpr SpunMatter kSpunMatter[] = {
    {2, "kind: mass, mass_kg: 0.2, at_m: [[0, 0], [1, 0], [0.3, 2]]"},
    {2, "kind: points, at_m: [[0, 0], [1, 0], [0, 3]], mass_kg: [1, 2, 5]"},
    {2, "kind: string, count: 4, from_m: [0, 0], to_m: [1, 0], mass_kg: 1, stiffness_n_per_m: 9"},
    {2, "kind: ring, count: 5, center_m: [4, 7], radius_m: 1, mass_kg: 1, stiffness_n_per_m: 9"},
    {3,
     "kind: grid, rows: 2, columns: 3, corner_m: [1, 2, 3], spacing_m: 1, mass_kg: 1, "
     "stiffness_n_per_m: 9"},
    {2,
     "kind: lattice, structure: square, corner_m: [0, 0], counts: [3, 3], spacing_m: 1, mass_kg: "
     "1"},
    {3,
     "kind: lattice, structure: fcc, corner_m: [0, 0, 0], counts: [2, 2, 2], spacing_m: 1, "
     "mass_kg: 1"},
    {2, "kind: disc, center_m: [5, 0], radius_m: 2, spacing_m: 1, mass_kg: 1"},
    {3, "kind: ball, center_m: [0, 0, 9], radius_m: 2, spacing_m: 1, mass_kg: 1"},
    {2,
     "kind: pack, count: 3, ball: {mass_kg: 1, radius_m: 0.1}, region: {from_m: [0, 0], to_m: [1, "
     "1]}"},
    {2,
     "kind: skin, center_m: [0, 0], radius_m: 1, count: 6, mass_kg: 1, stiffness_n_per_m: 9, "
     "core: {mass_kg: 8, stiffness_n_per_m: 3}"},
    {2,
     "kind: beam, cells: 2, from_m: [0, 0], to_m: [1, 0], height_m: 0.2, mass_kg: 1, "
     "stiffness_n_per_m: 9"},
};

Vec3 centre_of_mass(const std::vector<Mat>& mats) {
  Vec3 sum = Vec3::Zero();
  double mass = 0.0;
  for (const Mat& mat : mats) {
    sum += mat.mass * mat.position;
    mass += mat.mass;
  }
  return sum / mass;
}

TEST(Start, IsARigidMotionOfEveryKindOfMatter) {
  for (const SpunMatter& matter : kSpunMatter) {
    SCOPED_TRACE(matter.keys);
    const bool is_flat = matter.space == 2;
    const std::string motion = is_flat
                                   ? "velocity_m_per_s: [0.5, -2], spin_rad_per_s: 3"
                                   : "velocity_m_per_s: [0.5, -2, 1], spin_rad_per_s: [1, -2, 3]";
    const Vec3 velocity(0.5, -2, is_flat ? 0 : 1);
    const Vec3 spin = is_flat ? Vec3(0, 0, 3) : Vec3(1, -2, 3);
    const Scene scene = sound_scene(
        matter.space, "matter:\n  a: {" + std::string(matter.keys) + ", " + motion + "}\n");
    const std::vector<Mat>& mats = scene.network.mats;
    const Vec3 centre = centre_of_mass(mats);
    Vec3 momentum = Vec3::Zero();
    double mass = 0.0;
    for (const Mat& mat : mats) {
      const Vec3 arm = mat.position - centre;
      EXPECT_LT((mat.velocity - velocity - spin.cross(arm)).norm(), 1e-13 * (1 + arm.norm()));
      momentum += mat.mass * mat.velocity;
      mass += mat.mass;
    }
    // of the whole as of its centre of mass
    EXPECT_LT((momentum - mass * velocity).norm(), 1e-12 * mass);
  }
}

TEST(Start, GivesAFreeBodyTheAngularMomentumThatItKeeps) {
  const Scene scene = sound_scene(2, R"(matter:
  wheel: {kind: skin, center_m: [3, 1], radius_m: 0.1, count: 12, mass_kg: 0.01, stiffness_n_per_m: 400,
          core: {mass_kg: 0.2, stiffness_n_per_m: 300}, spin_rad_per_s: 5}
)");
  // twelve masses on a circle about their centre, where the core is: L = 12 m r^2 w
  const double expected = 12 * 0.01 * 0.1 * 0.1 * 5;

  engine::World world(std::make_shared<engine::Network>(scene.network));

  for (int step = 0; step < 2000; ++step) {
    world.step();
    // x(n-1) is known to a rounding of its 3 m, the velocity to that over dt: m r (1e-15 / dt) each
    ASSERT_NEAR(world.angular_momentum().z(), expected, 1e-10) << "step " << step;
  }
  EXPECT_LT(world.momentum().norm(), 1e-10);
}

TEST(Start, OfAUseIsAddedToThatOfItsPartAndTurnsWithThePartsAround) {
  const Scene scene = sound_scene(3, R"(parts:
  pair:
    matter:
      a: {kind: mass, mass_kg: 1, at_m: [[-1, 0, 0], [1, 0, 0]], spin_rad_per_s: [0, 0, 2]}
      nail: {kind: fixed, at_m: [0, 0, 5]}
  frame:
    matter:
      inner: {part: pair, velocity_m_per_s: [1, 0, 0], spin_rad_per_s: [0, 0, 3], repeat: {count: 2, translate_m: [10, 0, 0]}}
matter:
  outer: {part: frame, rotate: {axis: z, deg: 90}, translate_m: [7, 7, 7]}
)");

  const std::vector<Mat>& mats = scene.network.mats;
  ASSERT_EQ(mats.size(), 6u);
  for (std::size_t copy = 0; copy < 2; ++copy) {
    // each copy about its own centre: 2 + 3 rad/s at 1 m, turned by a quarter with all of it
    EXPECT_LT((mats[3 * copy].velocity - Vec3(5, 1, 0)).norm(), 1e-14);
    EXPECT_LT((mats[3 * copy + 1].velocity - Vec3(-5, 1, 0)).norm(), 1e-14);
    EXPECT_EQ(mats[3 * copy + 2].velocity, Vec3(0, 0, 0));
  }
}

TEST(Start, FollowsFormulasOfPlaceAndIndex) {
  const Scene scene = sound_scene(2, R"YAML(matter:
  s: {kind: string, count: 9, from_m: [0, 0], to_m: [2, 0], ends: fixed, mass_kg: 0.1, stiffness_n_per_m: 10,
      parameters: {depth: 0.01}, displacement_m: [0, "depth * sin(pi * x_m / 2)"],
      velocity_m_per_s: ["0.1 * index", "y_m + count"]}
)YAML");

  const std::vector<Mat>& mats = scene.network.mats;
  for (std::size_t i = 0; i < 9; ++i) {
    const double x = 0.25 * static_cast<double>(i);
    const bool moves = i > 0 && i < 8;
    EXPECT_NEAR(mats[i].position.y(), moves ? 0.01 * std::sin(kPi * x / 2) : 0.0, 1e-17);
    EXPECT_EQ(mats[i].position.x(), x);
    EXPECT_EQ(mats[i].velocity, moves ? Vec3(0.1 * static_cast<double>(i), 9, 0) : Vec3(0, 0, 0));
  }
  for (const engine::Link& link : scene.network.links) EXPECT_EQ(link.rest_length, 0.25);
}

TEST(Start, IsAModeOfAStringThatSwingsAlone) {
  // 1-D: mode 2 of a chain with fixed ends; w from 4 (K / m) sin^2(pi 2 / (2 * 10)), as the scheme has it
  const Scene scene = sound_scene(1, R"YAML(matter:
  s: {kind: string, count: 11, ends: fixed, mass_kg: 0.001, stiffness_n_per_m: 100,
      displacement_m: "0.01 * sin(2 * pi * index / 10)"}
)YAML");
  engine::World world(std::make_shared<engine::Network>(scene.network));
  const double s = std::sin(kPi * 2 / 20);
  const double w = std::acos(1.0 - 0.5 * 4 * 100 / 0.001 * s * s * 1e-6);

  for (int n = 1; n <= 500; ++n) {
    world.step();
    const double part = std::cos(n * w);  // at rest at step 0
    for (std::uint32_t i = 0; i < 11; ++i) {
      const double start = i == 0 || i == 10 ? 0.0 : 0.01 * std::sin(2 * kPi * i / 10);
      ASSERT_NEAR(world.position(i).x(), start * part, 1e-13) << "step " << n;
    }
  }
}

TEST(Start, OfFormulasIsTurnedWithItsPart) {
  const Scene scene = sound_scene(2, R"YAML(parts:
  p: {matter: {m: {kind: mass, mass_kg: 1, at_m: [1, 0], displacement_m: ["x_m", 0], velocity_m_per_s: ["2 * x_m", 0]}}}
matter:
  u: {part: p, translate_m: [5, 5], rotate_deg: 90}
)YAML");
  EXPECT_LT((scene.network.mats[0].position - Vec3(5, 7, 0)).norm(), 1e-15);
  EXPECT_LT((scene.network.mats[0].velocity - Vec3(0, 2, 0)).norm(), 1e-15);
}

class BadStart : public testing::TestWithParam<BadScene> {};

TEST_P(BadStart, HasOneProblemAtItsPlace) {
  expect_only_problem(GetParam());
}

INSTANTIATE_TEST_SUITE_P(
    Scene, BadStart,
    testing::Values(
        BadScene{kHead1, "matter:\n  a: {kind: mass, mass_kg: 1, at_m: 0, spin_rad_per_s: ^3}\n",
                 "nothing turns in a scene of space 1", ""},
        BadScene{
            kHead2,
            "matter:\n  a: {kind: mass, mass_kg: 1, at_m: [0, 0], spin_rad_per_s: ^[0, 0, 3]}\n",
            "'spin_rad_per_s' in matter 'a' must be a number, got a sequence", ""},
        BadScene{kHead3,
                 "matter:\n  a: {kind: mass, mass_kg: 1, at_m: [0, 0, 0], spin_rad_per_s: ^3}\n",
                 "'spin_rad_per_s' in matter 'a' must have 3 numbers, got 1",
                 "write 3 numbers [x, y, z]"},
        BadScene{
            kHead2, "matter:\n  a: {kind: mass, at_m: [0, 0], fixed: true, spin_rad_per_s: ^3}\n",
            "what is fixed has no spin: 'spin_rad_per_s' in matter 'a' contradicts 'fixed'", ""},
        BadScene{
            kHead2, "matter:\n  a: {kind: fixed, at_m: [0, 0], velocity_m_per_s: ^[1, 0]}\n",
            "what is fixed has no velocity: 'velocity_m_per_s' in matter 'a' contradicts 'fixed'",
            ""},
        BadScene{
            kHead2,
            R"(matter:
  a: {kind: mass, at_m: [0, 0], displacement_m: ^[1, 0], driven: {displacement_m: [time_s, 0]}}
)",
            "a driven position has the displacement of its function: 'displacement_m' in matter "
            "'a' contradicts it",
            ""},
        BadScene{kHead2,
                 R"(matter:
  a: {kind: mass, mass_kg: 1, at_m: [0, 0], displacement_m: ["^time_s", 0]}
)",
                 "'displacement_m' in matter 'a' cannot ask for 'time_s'",
                 "it may ask for index, count, x_m, y_m, pi and its parameters"},
        BadScene{kHead2,
                 "matter:\n  a: {kind: mass, mass_kg: 1, at_m: [0, 0], displacement_m: ^\"x_m\"}\n",
                 "'displacement_m' in matter 'a' must be 2 formulas, one for each axis, got 'x_m'",
                 ""},
        BadScene{kHead2,
                 R"(matter:
  a: {kind: mass, mass_kg: 1, at_m: [0, 0], velocity_m_per_s: ^[if(index == 0, 0.01, 0), 0]}
)",
                 "'velocity_m_per_s' in matter 'a' must be 2 formulas, one for each axis, got 4",
                 "put quotes around a formula with commas"},
        BadScene{kHead1,
                 R"(matter:
  a: {kind: mass, mass_kg: 1, at_m: 0, displacement_m: [max^(x_m]}
)",
                 "'displacement_m' in matter 'a' has a '(' that is never closed",
                 "put quotes around a formula with commas"},
        BadScene{kHead2,
                 R"(matter:
  m: {kind: mass, mass_kg: 1, at_m: [0, 0], parameters: {v: ^2}, velocity_m_per_s: [0, 6]}
)",
                 "parameter 'v' of matter 'm' is used nowhere", ""},
        BadScene{kHead2,
                 R"(matter:
  m: {kind: string, count: 3, from_m: [0, 0], to_m: [1, 0], mass_kg: 1, parameters: {v: ^2},
      stiffness_n_per_m: 1}
)",
                 "parameter 'v' of matter 'm' is used nowhere", ""},
        BadScene{kHead2,
                 R"(matter:
  m: {kind: mass, mass_kg: 1, at_m: [0, 0], parameters: {a: 1, v: ^2}, displacement_m: [a, 0]}
)",
                 "parameter 'v' of matter 'm' is used nowhere", ""},
        BadScene{kHead2,
                 R"(parts:
  p:
    matter:
      m: {kind: mass, mass_kg: 1, at_m: [0, 0], parameters: {v: ^2}}
matter: {u: {part: p, repeat: {count: 3}}}
)",
                 "parameter 'v' of matter 'm' of part 'p' is used nowhere", ""},
        BadScene{kHead2,
                 R"(parts:
  p:
    parameters: {a: 1}
    matter: {m: {kind: mass, mass_kg: 1, at_m: [0, 0], displacement_m: [-sin(^$a), 0]}}
matter: {u: {part: p}}
)",
                 "'displacement_m' in matter 'm' of part 'p' has a '$'",
                 "$name is a whole value alone: write parameters: {name: $name}, and name in the "
                 "formula"},
        BadScene{kHead2,
                 R"(parts:
  p:
    parameters: {a: 1}
    matter: {m: {kind: mass, mass_kg: 1, at_m: [0, 0], parameters: {b: ^$a * 1}, displacement_m: [b, 0]}}
matter: {u: {part: p}}
)",
                 "a value in part 'p' has a '$'",
                 "$name is a whole value alone: write parameters: {name: $name}, and name in the "
                 "formula"},
        BadScene{kHead2,
                 R"(matter:
  a: {kind: mass, mass_kg: 1, at_m: [0, 0], velocity_m_per_s: ^["1 / x_m", 0]}
)",
                 "'velocity_m_per_s' in matter 'a' at index 0 is no finite number", ""},
        BadScene{
            kHead2,
            "matter:\n  a: {kind: mass, mass_kg: 1, at_m: [0, 0], displacement_m: ^[2e6, 0]}\n",
            "'displacement_m' in matter 'a' at index 0 is beyond 1e6", ""},
        BadScene{kHead2,
                 R"(matter:
  a: {kind: mass, mass_kg: 1, at_m: [0, 0], parameters: ^{x_m: 1}, displacement_m: [x_m, 0]}
)",
                 "'x_m' has its meaning in formulas of the start",
                 "give the parameter another name"},
        BadScene{kHead2,
                 R"(parts: {p: {matter: {a: {kind: fixed, at_m: [0, 0]}}}}
matter:
  u: {part: p, spin_rad_per_s: ^1}
  b: {kind: mass, mass_kg: 1, at_m: [1, 1]}
)",
                 "part 'p' has no mass that starts in motion", ""}));

}  // namespace
}  // namespace cordis::scene
