// tests/scene/fields_test.cpp -- gravity that changes in time, and a medium that flows.
#include <array>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "sim_node/engine/world.h"
#include "tests/scene/bad_scene.h"
#include "tests/support/filled.h"
#include "tests/support/test_seed.h"

namespace cordis::scene {
namespace {

using engine::Vec3;
using engine::World;

World world_of(const Scene& scene) {
  return World(std::make_shared<const engine::Network>(scene.network));
}

constexpr const char* kFree = R"(matter:
  a: {kind: mass, mass_kg: 0.5, at_m: 0}
  b: {kind: mass, mass_kg: 2, at_m: 3}
)";

TEST(Fields, AShakenBoxFollowsTheExactSolutionOfItsRecurrence) {
  const Scene scene = sound_scene(
      1, std::string(
             "world: {parameters: {depth: 5}, gravity_m_per_s2: \"depth * sin(40 * time_s)\"}\n") +
             kFree);
  World world = world_of(scene);
  // x(n+1) - 2 x(n) + x(n-1) = a dt^2 sin(n w), from rest and without force at 0: A sin(n w) + B n
  const double dt = 1e-3;
  const double w = 40 * dt;
  const double a = -5 * dt * dt / (2.0 - 2.0 * std::cos(w));
  const double b = -a * std::sin(w);

  for (int n = 1; n <= 3000; ++n) {
    world.step();
    const double x = a * std::sin(n * w) + b * n;
    ASSERT_NEAR(world.position(0).x(), x, 1e-9) << n;  // rounding adds up as n^2 eps x
    ASSERT_NEAR(world.position(1).x(), 3.0 + x, 1e-9) << n;
  }
  const engine::Energy energy = world.energy();
  EXPECT_LT(std::abs(energy.residual()), 1e-12 * energy.largest);
}

TEST(Fields, AConstantFormulaIsGravity) {
  const Scene constant = sound_scene(1, std::string("world: {gravity_m_per_s2: -9.81}\n") + kFree);
  const Scene formula =
      sound_scene(1, std::string("world: {gravity_m_per_s2: \"-9.81 + 0 * time_s\"}\n") + kFree);
  World falling = world_of(constant);
  World pushed = world_of(formula);
  for (int n = 0; n < 1000; ++n) {
    falling.step();
    pushed.step();
  }
  EXPECT_NEAR(pushed.position(0).x(), falling.position(0).x(), 1e-11);
  EXPECT_NEAR(pushed.energy().kinetic, falling.energy().kinetic, 1e-9);
  const engine::Energy energy = pushed.energy();  // the work of what pushes is that of gravity
  EXPECT_LT(std::abs(energy.residual()), 1e-12 * energy.largest);
}

TEST(Fields, WhatFallsInAFlowHasItsTerminalVelocity) {
  const Scene scene = sound_scene(2, R"(
world: {gravity_m_per_s2: [0, -10], viscosity_n_s_per_m: 0.8, flow_m_per_s: [3, 0.25]}
matter:
  light: {kind: mass, mass_kg: 0.02, at_m: [0, 0]}
  heavy: {kind: mass, mass_kg: 0.08, at_m: [1, 0]}
)");
  World world = world_of(scene);
  for (int n = 0; n < 6000; ++n) world.step();

  // Z (u - v) + m g = 0, which is a fixed point of the scheme as well; (1 - dt Z / m)^6000 is below 1e-26
  EXPECT_LT((world.velocity(0) - Vec3(3, 0.25 - 0.02 * 10 / 0.8, 0)).norm(), 1e-10);
  EXPECT_LT((world.velocity(1) - Vec3(3, 0.25 - 0.08 * 10 / 0.8, 0)).norm(), 1e-10);
  const engine::Energy energy = world.energy();
  EXPECT_LT(std::abs(energy.residual()), 1e-11 * energy.largest);
}

TEST(Fields, LeaveToolsWithoutWeightAndWhatIsFixedAlone) {
  const Scene scene = sound_scene(1, R"(
world: {gravity_m_per_s2: "-9 - time_s"}
matter:
  nail: {kind: fixed, at_m: 0}
  bob: {kind: mass, mass_kg: 1, at_m: 1}
ports:
  key: {device: k, axes: [0], role: liaison}
)");
  ASSERT_EQ(scene.network.drives.size(), 1u);
  EXPECT_EQ(scene.network.drives[0].mat, 1u);
  EXPECT_EQ(value_at(scene.network, scene.network.drives[0], 2.0), Vec3(-11, 0, 0));
  EXPECT_EQ(scene.network.gravity, Vec3(0, 0, 0));
}

TEST(Fields, PushEachMassWithItsOwnShareOfTwoFunctions) {
  std::mt19937 random(test::test_seed());
  std::uniform_real_distribution<double> any(0.1, 3.0);
  const double viscosity = any(random);
  std::string matter;
  std::vector<double> masses;
  for (int i = 0; i < 50; ++i) {
    masses.push_back(any(random));
    matter += "  m" + std::to_string(i) + ": {kind: mass, at_m: [" + std::to_string(i) +
              ", 0], mass_kg: " + config::number_text(masses.back()) + "}\n";
  }
  const Scene scene =
      sound_scene(2,
                  "world: {gravity_m_per_s2: [sin(time_s), -9], flow_m_per_s: [4, time_s ^ 2], "
                  "viscosity_n_s_per_m: " +
                      config::number_text(viscosity) + "}\nmatter:\n" + matter);

  EXPECT_EQ(scene.network.time_functions.size(), 2u);
  for (const double time : {0.0, 0.7, 2.0}) {
    std::vector<Vec3> force(masses.size(), Vec3::Zero());
    for (const engine::Drive& drive : scene.network.drives)
      force[drive.mat] += value_at(scene.network, drive, time);
    for (std::size_t i = 0; i < masses.size(); ++i) {
      const Vec3 expected =
          masses[i] * Vec3(std::sin(time), -9, 0) + viscosity * Vec3(4, time * time, 0);
      EXPECT_LT((force[i] - expected).norm(), 1e-13 * expected.norm()) << i;  // some roundings
    }
  }
}

TEST(Fields, MayBothBeAsDeepAsOneFormulaMayBe) {
  std::string deep = "time_s";
  for (int level = 1; level < 16; ++level) deep = "1 + (" + deep + ")";  // of the stack

  const Scene scene = sound_scene(1, "world: {viscosity_n_s_per_m: 1, gravity_m_per_s2: \"" + deep +
                                         "\", flow_m_per_s: \"" + deep + "\"}\n" + kFree);
  World world = world_of(scene);

  EXPECT_EQ(world.network().description().drives.size(), 2 * 2u);
}

TEST(Fields, PushBesideAForceOfTheMatter) {
  const Scene scene = sound_scene(2, R"yaml(
world: {gravity_m_per_s2: ["sin(time_s)", -9], flow_m_per_s: [4, 0], viscosity_n_s_per_m: 0.5}
matter:
  puck: {
kind:
  mass, mass_kg : 2, at_m : [ 0, 0 ], driven : {
  force_n:
    [ 3, "time_s" ]
  }
}
  free: {kind: mass, mass_kg: 1, at_m: [1, 0]}
)yaml");
  for (const double time : {0.0, 0.3, 2.0}) {
    std::array<Vec3, 2> force{Vec3::Zero(), Vec3::Zero()};
    for (const engine::Drive& drive : scene.network.drives)
      force.at(drive.mat) += value_at(scene.network, drive, time);
    const Vec3 of_fields = Vec3(std::sin(time), -9, 0);
    EXPECT_LT((force[0] - (2.0 * of_fields + Vec3(2 + 3, time, 0))).norm(), 1e-13);
    EXPECT_LT((force[1] - (of_fields + Vec3(2, 0, 0))).norm(), 1e-13);
  }
  World world = world_of(scene);
  for (int n = 0; n < 2000; ++n) world.step();
  const engine::Energy energy = world.energy();
  EXPECT_LT(std::abs(energy.residual()), 1e-12 * energy.largest);
}

/// Free masses, each with a viscosity of the medium of its own.
struct Floating {
  std::vector<double> masses;
  std::vector<double> viscosities;
  std::string matter = "matter:\n";

  explicit Floating(std::mt19937& random) {
    std::uniform_real_distribution<double> any(0.05, 2.0);
    for (int i = 0; i < 30; ++i) {
      masses.push_back(any(random));
      viscosities.push_back(random() % 4 == 0 ? 0.0 : any(random));
      matter += "  m" + std::to_string(i) + ": {kind: mass, at_m: [" + std::to_string(i) +
                ", 0], velocity_m_per_s: [2, 1], mass_kg: " + config::number_text(masses.back());
      if (random() % 3 == 0) {
        viscosities.back() = 0.25;  // that of the world
      } else {
        matter += ", medium_viscosity_n_s_per_m: " + config::number_text(viscosities.back());
      }
      matter += "}\n";
    }
  }
};

TEST(Medium, TakesFromEachMassByItsOwnViscosity) {
  std::mt19937 random(test::test_seed());
  const Floating floating(random);
  const Scene scene = sound_scene(2, "world: {viscosity_n_s_per_m: 0.25}\n" + floating.matter);
  World world = world_of(scene);
  constexpr int kSteps = 500;
  for (int n = 0; n < kSteps; ++n) world.step();

  for (std::uint32_t i = 0; i < 30; ++i) {
    // x(n+1) - x(n) = (1 - dt Z / m) (x(n) - x(n-1)), from v(-1/2) = (1 + dt Z / 2 m) v
    const double taken = 1e-3 * floating.viscosities[i] / floating.masses[i];
    const double speed = 2.0 * (1.0 + 0.5 * taken) * std::pow(1.0 - taken, kSteps);
    EXPECT_NEAR(world.velocity(i).x(), speed, 1e-12) << i;
  }
  const engine::Energy energy = world.energy();
  EXPECT_LT(std::abs(energy.residual()), 1e-12 * energy.largest);
}

TEST(Medium, IsForEachMassAsIfItWereAlone) {
  for (const char* integrator : {"cordis", "leapfrog", "implicit"}) {
    SCOPED_TRACE(integrator);
    std::mt19937 random(test::test_seed());
    const Floating floating(random);
    const auto world_in = [&](double viscosity, const std::string& matter) {
      config::Problems problems;
      const Scene scene =
          load_scene_text(test::filled(R"(cordis: 1
space: 2
step: {rate_hz: 1000, integrator: <integrator>}
world: {gravity_m_per_s2: [0, -9], viscosity_n_s_per_m: <viscosity>}
)",
                                       {{"integrator", std::string(integrator)},
                                        {"viscosity", config::number_text(viscosity)}}) +
                              matter,
                          "t", problems);
      EXPECT_EQ(problems.text(), "");
      return world_of(scene);
    };
    World all = world_in(0.25, floating.matter);
    for (int n = 0; n < 700; ++n) all.step();
    double dissipated = 0.0;
    for (std::uint32_t i = 0; i < 30; ++i) {
      World alone =
          world_in(floating.viscosities[i], "matter: {m: {kind: mass, at_m: [" + std::to_string(i) +
                                                ", 0], velocity_m_per_s: [2, 1], mass_kg: " +
                                                config::number_text(floating.masses[i]) + "}}\n");
      for (int n = 0; n < 700; ++n) alone.step();
      ASSERT_EQ(all.position(i), alone.position(0)) << i;
      dissipated += alone.energy().dissipated;
    }
    EXPECT_NEAR(all.energy().dissipated, dissipated, 1e-12 * dissipated);
  }
}

TEST(Medium, OfTheMatterThatIsThatOfTheWorldHasItsBits) {
  const std::string masses =
      "{kind: string, count: 9, mass_kg: 0.1, ends: fixed, stiffness_n_per_m: 50, "
      "viscosity_n_s_per_m: 0.1, rest_m: 0, displacement_m: \"0.1 * sin(index)\"";
  for (const char* integrator : {"cordis", "leapfrog", "implicit", "modal"}) {
    for (const char* viscosity : {"0.3", "80"}) {  // of leapfrog the second is solved implicitly
      const std::string head = test::filled(R"(cordis: 1
space: 1
step: {rate_hz: 1000, integrator: <integrator>}
)",
                                            {{"integrator", std::string(integrator)}});
      const auto hash_of = [&](const std::string& text) {
        config::Problems problems;
        World world = world_of(load_scene_text(head + text, "t", problems));
        EXPECT_EQ(problems.text(), "");
        for (int n = 0; n < 500; ++n) world.step();
        EXPECT_GT(world.energy().dissipated, 1e-3);
        return world.state_hash();
      };
      const std::string z = viscosity;
      EXPECT_EQ(hash_of("world: {viscosity_n_s_per_m: " + z + "}\nmatter: {s: " + masses + "}}\n"),
                hash_of("matter: {s: " + masses + ", medium_viscosity_n_s_per_m: " + z + "}}\n"))
          << integrator << ' ' << z;
    }
  }
}

TEST(Medium, RestsAndWakesWithItsOwnViscosity) {
  config::Problems problems;
  const Scene scene = load_scene_text(R"(cordis: 1
space: 2
step: {rate_hz: 1000, freeze: {tolerance_m: 1.0e-6}}
matter:
  a: {kind: string, count: 6, mass_kg: 0.1, from_m: [0, 0], to_m: [1, 0], ends: fixed, stiffness_n_per_m: 50, tension_n: 1,
      displacement_m: [0, 0.01], medium_viscosity_n_s_per_m: 1}
  b: {kind: string, count: 6, mass_kg: 0.1, from_m: [0, 1], to_m: [1, 1], ends: fixed, stiffness_n_per_m: 50, tension_n: 1,
      displacement_m: [0, 0.01], medium_viscosity_n_s_per_m: 0}
)",
                                      "t", problems);
  ASSERT_EQ(problems.text(), "");
  World world = world_of(scene);
  for (int n = 0; n < 20000; ++n) world.step();

  EXPECT_EQ(world.asleep_count(), 4u);  // what is in no medium swings on
  EXPECT_LT(std::abs(world.energy().residual()), 1e-9 * world.energy().largest);
}

TEST(Medium, AFlowCarriesWhatIsInIt) {
  const Scene scene = sound_scene(2, R"(
world: {gravity_m_per_s2: [0, -10], flow_m_per_s: [3, 0]}
matter:
  leaf: {kind: mass, mass_kg: 0.02, at_m: [0, 0], medium_viscosity_n_s_per_m: 0.4}
  seed: {kind: mass, mass_kg: 0.02, at_m: [1, 0], medium_viscosity_n_s_per_m: 0.1}
  stone: {kind: mass, mass_kg: 5, at_m: [2, 0]}
)");
  World world = world_of(scene);
  for (int n = 0; n < 9000; ++n) world.step();

  EXPECT_LT((world.velocity(0) - Vec3(3, -0.02 * 10 / 0.4, 0)).norm(), 1e-10);
  EXPECT_LT((world.velocity(1) - Vec3(3, -0.02 * 10 / 0.1, 0)).norm(), 1e-10);
  EXPECT_EQ(world.velocity(2).x(), 0.0);
}

TEST(Medium, ModesWantOneDecayOfAllMasses) {
  const auto refusal = [](const std::string& of_b) {
    config::Problems problems;
    load_scene_text(test::filled(R"(cordis: 1
space: 1
step: {rate_hz: 1000, integrator: modal}
matter:
  a: {kind: mass, mass_kg: 1, at_m: 0, medium_viscosity_n_s_per_m: 0.2}
  b: {kind: mass, mass_kg: 2, at_m: 0, medium_viscosity_n_s_per_m: <of_b>}
)",
                                 {{"of_b", of_b}}),
                    "t", problems);
    return problems.text();
  };
  EXPECT_EQ(refusal("0.4"), "");
  EXPECT_NE(refusal("0.2").find("different masses in a medium"), std::string::npos);
  config::Problems problems;
  load_scene_text(
      R"(cordis: 1
space: 1
step: {rate_hz: 1000, integrator: modal}
matter:
  a: {kind: mass, mass_kg: 1, at_m: 0, medium_viscosity_n_s_per_m: 0.2}
  b: {kind: mass, mass_kg: 1, at_m: 0, medium_viscosity_n_s_per_m: 0.3}
)",
      "t", problems);
  EXPECT_NE(problems.text().find("masses with different viscosities of the medium"),
            std::string::npos);
}

class BadFields : public testing::TestWithParam<BadScene> {};

TEST_P(BadFields, HaveOneProblemAtTheirPlace) {
  expect_only_problem(GetParam());
}

constexpr const char* kBob = "matter: {b: {kind: mass, mass_kg: 1, at_m: [0, 0]}}\n";
const std::string kNoMedium = std::string("world: {flow_m_per_s: ^[1, 0]}\n") + kBob;
const std::string kUnused = std::string("world: {parameters: {a: ^1}}\n") + kBob;
const std::string kUnusedBeside =
    std::string("world: {parameters: {a: 1, b: ^1}, gravity_m_per_s2: [0, \"-a * time_s\"]}\n") +
    kBob;
const std::string kNoName = std::string("world: {gravity_m_per_s2: [0, \"^tim_s\"]}\n") + kBob;
const std::string kNoNumber =
    std::string("world: {gravity_m_per_s2: ^[0, \"1 / time_s\"]}\n") + kBob;
const std::string kFixed =
    "matter: {w: {kind: fixed, at_m: [0, 0], medium_viscosity_n_s_per_m: ^1}, b: {kind: mass, "
    "mass_kg: 1, "
    "at_m: [0, 1]}}\n";
const std::string kLed =
    "matter: {w: {kind: mass, mass_kg: 1, at_m: [0, 0], medium_viscosity_n_s_per_m: ^1, driven: "
    "{position_m: [\"sin(time_s)\", 0]}}, b: {kind: mass, mass_kg: 1, at_m: [0, 1]}}\n";
const std::string kNegative =
    "matter: {b: {kind: mass, mass_kg: 1, at_m: [0, 1], medium_viscosity_n_s_per_m: ^-1}}\n";

INSTANTIATE_TEST_SUITE_P(
    Scene, BadFields,
    testing::Values(
        BadScene{kHead2, kUnused.c_str(), "parameter 'a' of world is used nowhere", ""},
        BadScene{kHead2, kUnusedBeside.c_str(), "parameter 'b' of world is used nowhere", ""},
        BadScene{kHead2, kNoMedium.c_str(),
                 "a medium that flows needs a viscosity_n_s_per_m > 0 in world, or a "
                 "medium_viscosity_n_s_per_m > 0 of matter",
                 ""},
        BadScene{kHead2, kNoName.c_str(), "'gravity_m_per_s2' in world cannot ask for 'tim_s'",
                 "did you mean 'time_s'?"},
        BadScene{kHead2, kNoNumber.c_str(),
                 "'gravity_m_per_s2' in world is no finite number within 1e6 at 0 s", ""},
        BadScene{kHead2, kFixed.c_str(), "what is fixed or driven feels no medium", ""},
        BadScene{kHead2, kLed.c_str(), "what is fixed or driven feels no medium", ""},
        BadScene{kHead2, kNegative.c_str(),
                 "'medium_viscosity_n_s_per_m' in matter 'b' must be >= 0, got -1", ""}));

}  // namespace
}  // namespace cordis::scene
