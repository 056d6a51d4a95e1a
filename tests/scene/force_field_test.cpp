// tests/scene/force_field_test.cpp -- forces by place, and a world that follows signals.
#include <cmath>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "sim_node/engine/world.h"
#include "sim_node/plan/plan.h"
#include "sim_node/scene/naming.h"
#include "sim_node/scene/parameters.h"
#include "tests/scene/bad_scene.h"
#include "tests/support/filled.h"

namespace cordis::scene {
namespace {

using engine::Vec3;

engine::World world_in(const Scene& scene) {
  return engine::World(std::make_shared<const engine::Network>(scene.network));
}

TEST(ForceField, IsOneLinePerMatter) {
  const Scene scene = sound_scene(2, R"YAML(
matter:
  bob: {kind: mass, mass_kg: 0.1, at_m: [0, 0.2], velocity_m_per_s: [1, 0],
        driven: {parameters: {k: 5}, force_n: ["-k * x_m", "-k * y_m"]}}
)YAML");
  engine::World world = world_in(scene);
  const double w = std::sqrt(5.0 / 0.1);
  for (int n = 1; n <= 1000; ++n) {
    world.step();
    const double t = n * scene.network.step;
    ASSERT_NEAR(world.position(0).x(), std::sin(w * t) / w, 1e-5) << n;  // (w dt)^2 w t / 24
    ASSERT_NEAR(world.position(0).y(), 0.2 * std::cos(w * t), 1e-5) << n;
  }
}

TEST(ForceField, ActsOnEachMassWhereItIs) {
  const Scene scene = sound_scene(1, R"YAML(
matter:
  row: {kind: mass, mass_kg: 2, at_m: [0.1, 0.2, -0.4], driven: {force_n: "-8 * x_m - 0.5 * velocity_x_m_per_s + 3 * time_s"}}
)YAML");
  ASSERT_EQ(scene.network.drives.size(), 3u);
  ASSERT_EQ(scene.network.time_functions.size(), 1u);
  for (std::uint32_t i = 0; i < 3; ++i) {
    const Vec3 force = force_at(scene.network, scene.network.drives[i],
                                {2.0, scene.network.mats[i].position, Vec3(4, 0, 0), nullptr});
    EXPECT_NEAR(force.x(), -8 * scene.network.mats[i].position.x() - 2.0 + 6.0, 1e-14);
  }
}

TEST(ForceField, OfAPartTurnsAndMovesWithIt) {
  const char* const parts = R"YAML(parts:
  inner: {matter: {bob: {kind: mass, mass_kg: 1, at_m: [0.5, 0], driven: {force_n: ["-4 * x_m", 0]}}}}
  outer: {matter: {bob: {kind: mass, mass_kg: 1, at_m: [0.5, 0]}}}
  shell: {matter: {core: {part: outer, driven: {force_n: ["-4 * x_m", 0]}}}}
matter:
  a: {part: inner, rotate_deg: 90, translate_m: [3, 1]}
  b: {part: shell, rotate_deg: 90, translate_m: [3, 1]}
)YAML";
  const Scene scene = sound_scene(2, parts);
  ASSERT_EQ(scene.network.drives.size(), 2u);
  for (const engine::Drive& drive : scene.network.drives) {
    EXPECT_LT((scene.network.mats[drive.mat].position - Vec3(3, 1.5, 0)).norm(), 1e-12);
    const Vec3 force = force_at(
        scene.network, drive, {0.0, scene.network.mats[drive.mat].position, Vec3::Zero(), nullptr});
    EXPECT_LT((force - Vec3(0, -2, 0)).norm(), 1e-12);
  }
}

TEST(ForceField, AsksForWhatConditionsAskFor) {
  // A motor holds a mass at a place that another one sets.
  const Scene scene = sound_scene(1, R"YAML(
matter:
  leader: {kind: fixed, at_m: 0.25}
  arm: {kind: mass, mass_kg: 0.5, at_m: 0, driven: {force_n: "50 * (leader.position_m - x_m) - 8 * speed"}}
signals:
  speed: {of: arm, quantity: velocity}
)YAML");
  engine::World world = world_in(scene);
  for (int n = 0; n < 20'000; ++n) world.step();
  EXPECT_NEAR(world.position(1).x(), 0.25, 1e-9);
  EXPECT_LT(std::abs(world.energy().residual()), 1e-12 * world.energy().largest);
}

TEST(ForceField, InAPartAsksForNamesOfThePart) {
  const Scene scene = sound_scene(1, R"YAML(parts:
  pair:
    matter:
      guide: {kind: fixed, at_m: 2}
      bob: {kind: mass, mass_kg: 1, at_m: 0, driven: {force_n: "guide.position_m"}}
matter:
  guide: {kind: fixed, at_m: 50}
  first: {part: pair}
  second: {part: pair, translate_m: 10}
)YAML");
  engine::World world = world_in(scene);
  world.step();
  world.step();
  // x(2) = 2 dt^2 f / m from rest
  EXPECT_NEAR(world.position(2).x(), 2e-6 * 2.0, 1e-15);
  EXPECT_NEAR(world.position(4).x() - 10.0, 2e-6 * 12.0, 1e-14);
}

TEST(WorldOfSignals, FallsAsASignalSays) {
  // The scene that the issue asks for: x is at rest, and so is what y falls by.
  const Scene scene = sound_scene(2, R"YAML(
world: {gravity_m_per_s2: [0, "-9.81 * x"]}
matter:
  b: {kind: mass, mass_kg: 0.1, at_m: [0.1, 0]}
signals: {x: {of: b, quantity: position, axis: x}}
)YAML");
  engine::World world = world_in(scene);
  for (int n = 0; n < 1000; ++n) world.step();
  EXPECT_NEAR(world.position(0).y(), -0.5 * 0.981, 1e-9);
  EXPECT_LT(std::abs(world.energy().residual()), 1e-12 * world.energy().largest);
}

TEST(WorldOfSignals, ThickensWithTime) {
  // m v' = -(a + b t) v has v = v0 exp(-(a t + b t^2 / 2) / m).
  for (const char* integrator : {"cordis", "leapfrog"}) {
    SCOPED_TRACE(integrator);
    config::Problems problems;
    const Scene scene = load_scene_text(test::filled(R"YAML(cordis: 1
space: 2
step: {rate_hz: 10000, integrator: <integrator>}
world: {viscosity_n_s_per_m: "0.1 + 0.3 * time_s"}
matter:
  free: {kind: mass, mass_kg: 0.2, at_m: [0, 0], velocity_m_per_s: [2, -1]}
  own: {kind: mass, mass_kg: 0.2, at_m: [0, 1], velocity_m_per_s: [2, 0], medium_viscosity_n_s_per_m: 0}
)YAML",
                                                     {{"integrator", std::string(integrator)}}),
                                        "t", problems);
    ASSERT_EQ(problems.text(), "");
    engine::World world = world_in(scene);
    for (int n = 0; n < 10'000; ++n) world.step();
    const double left = std::exp(-(0.1 + 0.15) / 0.2);
    EXPECT_NEAR(world.velocity(0).x(), 2.0 * left, 3e-4);  // cordis is of first order with a medium
    EXPECT_NEAR(world.velocity(0).y(), -1.0 * left, 3e-4);
    EXPECT_NEAR(world.velocity(1).x(), 2.0, 1e-9);  // rounding
    const engine::Energy energy = world.energy();
    EXPECT_NEAR(energy.port_work, -0.5 * 0.2 * 5.0 * (1.0 - left * left), 3e-4);
    EXPECT_EQ(energy.dissipated, 0.0);
  }
}

TEST(WorldOfSignals, IsAMediumOfAFormulaThatDoesNotChange) {
  const auto run = [](const std::string& viscosity) {
    const Scene scene = sound_scene(2, test::filled(R"YAML(
world: {viscosity_n_s_per_m: <viscosity>, flow_m_per_s: [1, sin(time_s)]}
matter: {a: {kind: mass, mass_kg: 0.4, at_m: [0, 0], velocity_m_per_s: [0, 2]}}
)YAML",
                                                    {{"viscosity", viscosity}}));
    engine::World world = world_in(scene);
    for (int n = 0; n < 3000; ++n) world.step();
    return world.position(0);
  };
  const Scene constant = sound_scene(1, R"YAML(
world: {viscosity_n_s_per_m: 0.1 * 3}
matter: {a: {kind: mass, mass_kg: 1, at_m: 0}}
)YAML");
  EXPECT_EQ(constant.network.medium_viscosity, 0.1 * 3);
  EXPECT_LT((run("0.7 + 0 * time_s") - run("0.7")).norm(), 1e-11);
}

TEST(WorldOfSignals, IsNotSetWhileARunGoesOn) {
  const Scene scene = sound_scene(1, R"YAML(
world: {viscosity_n_s_per_m: "max(0, x)"}
matter: {a: {kind: mass, mass_kg: 1, at_m: 0}}
signals: {x: {of: a, quantity: position}}
)YAML");
  Parameters parameters(std::make_shared<const Scene>(scene));
  EXPECT_EQ(parameters.set("world", "viscosity_n_s_per_m", 1.0).problem,
            "the viscosity of the medium follows a formula in this scene");
}

TEST(WorldOfSignals, NamesWhatIsNotCertain) {
  const Scene scene = sound_scene(1, R"YAML(
world: {viscosity_n_s_per_m: "max(0, x)", gravity_m_per_s2: "-x"}
matter: {bob: {kind: mass, mass_kg: 1, at_m: 0, driven: {force_n: "-x_m"}}}
signals: {x: {of: bob, quantity: position}}
)YAML");
  const auto name = [&scene](std::uint32_t drive) {
    return call_liaison(scene, engine::LiaisonId{engine::LiaisonKind::kForce, drive}).name;
  };
  ASSERT_EQ(scene.network.drives.size(), 3u);
  EXPECT_EQ(name(0), "the force on bob");
  EXPECT_EQ(name(1), "the gravity of the world");
  EXPECT_EQ(name(2), "the viscosity of the medium");
}

constexpr BadScene kBadFields[] = {
    {kHead2, "matter: {b: {kind: mass, mass_kg: 1, at_m: [0, 1], driven: {force_n: [^z_m, 0]}}}\n",
     "'force_n' in 'driven' of matter 'b' cannot ask for 'z_m'", "did you mean 'x_m'?"},
    {kHead2, "matter: {b: {kind: fixed, driven: {position_m: [^x_m, 0]}}}\n",
     "'position_m' in 'driven' of matter 'b' cannot ask for 'x_m'",
     "it may ask for time_s, pi and its parameters"},
    {kHead2,
     "matter: {b: {kind: mass, mass_kg: 1, at_m: [0, 1], driven: {force_n: [^length, 0]}}}\n",
     "'force_n' in 'driven' of matter 'b' cannot ask for 'length'",
     "it may ask for time_s, x_m, y_m, velocity_x_m_per_s, velocity_y_m_per_s, pi, its parameters "
     "and "
     "signals"},
    {kHead1, "matter: {b: {kind: mass, mass_kg: 1, at_m: 0, driven: ^{force_n: 1 / x_m}}}\n",
     "'force_n' of matter 'b' is no finite number at 0 s, where a mass of it begins", ""},
    {kHead1,
     "matter: {b: {kind: mass, mass_kg: 1, at_m: 0, driven: {parameters: ^{x_m: 1}, force_n: "
     "x_m}}}\n",
     "'x_m' has its meaning in formulas of forces", "give the parameter another name"},
    {kHead1,
     "world: {viscosity_n_s_per_m: ^1 - 2}\nmatter: {b: {kind: mass, mass_kg: 1, at_m: 0}}\n",
     "'viscosity_n_s_per_m' in world must be >= 0, got -1", ""},
    {kHead1,
     "world: {viscosity_n_s_per_m: ^1 / time_s}\nmatter: {b: {kind: mass, mass_kg: 1, at_m: 0}}\n",
     "'viscosity_n_s_per_m' in world is no finite number within 1e6 at 0 s", ""},
    {kHead1, "world: {gravity_m_per_s2: ^height}\nmatter: {b: {kind: mass, mass_kg: 1, at_m: 0}}\n",
     "'gravity_m_per_s2' in world cannot ask for 'height'",
     "it may ask for time_s, pi, its parameters and signals"},
    {kHead1,
     "world: {gravity_m_per_s2: ^b.colour}\nmatter: {b: {kind: mass, mass_kg: 1, at_m: 0}}\n",
     "a MAT has no quantity 'colour' that others may ask for",
     "it has position_m, position_x_m, velocity_m_per_s, velocity_x_m_per_s, force_n, force_x_n, "
     "speed_m_per_s"},
};

class BadForceFields : public BadScenes {};

TEST_P(BadForceFields, AreOneProblemAtItsPlace) {
  expect_only_problem(GetParam());
}

INSTANTIATE_TEST_SUITE_P(All, BadForceFields, testing::ValuesIn(kBadFields));

/// A mass of K' = 9 under gravity of a formula.
plan::Stability stability_under(const std::string& gravity) {
  const Scene scene = sound_scene(2, test::filled(R"YAML(world: {gravity_m_per_s2: [0, "<gravity>"]}
signals: {height: {of: m, quantity: position, axis: y}, changed: {quantity: changes}}
liaisons: {k: {kind: spring, stiffness_n_per_m: 9}}
matter:
  top: {kind: fixed, at_m: [0, 0]}
  m: {kind: mass, mass_kg: 1.0e-6, at_m: [0, -0.2]}
links: [{liaison: k, between: [top, m]}]
)YAML",
                                                  {{"gravity", gravity}}));
  return plan::stability_of(scene.network, plan::liaison_graph(scene.network));
}

TEST(ForceField, OfWhatNoMassMovesLeavesTheLimitSure) {
  for (const char* gravity : {"-9.81", "-9.81 * time_s", "-9.81 * if(changed > 0, 0, 1)"})
    EXPECT_TRUE(stability_under(gravity).diverges()) << gravity;
  const plan::Stability fed_back = stability_under("-9.81 * height");
  EXPECT_FALSE(fed_back.diverges());
  EXPECT_FALSE(fed_back.holds());
}

}  // namespace
}  // namespace cordis::scene
