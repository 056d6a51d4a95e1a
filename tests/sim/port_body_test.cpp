// tests/sim/port_body_test.cpp -- a device that moves a whole body.
#include "sim_node/checks/port_body.h"

#include <cmath>
#include <memory>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "sim_node/run/simulation.h"
#include "sim_node/scene/sections/scene_reader.h"
#include "tests/support/filled.h"
#include "tests/support/test_seed.h"

namespace cordis::sim {
namespace {

using engine::Vec3;

scene::Scene sound(const std::string& text) {
  config::Problems problems;
  scene::Scene scene = scene::load_scene_text(text, "t", problems);
  EXPECT_EQ(problems.text(), "");
  return scene;
}

const char* const kHeld = R"(cordis: 1
space: 2
step: {rate_hz: 4000}
matter:
  other: {kind: mass, mass_kg: 3, at_m: [-5, 0]}
  jelly: {kind: lattice, structure: square, counts: [4, 3], corner_m: [0, 1], spacing_m: 0.1, mass_kg: 0.02, stiffness_n_per_m: 400, viscosity_n_s_per_m: 0.1}
  load: {kind: mass, mass_kg: 0.3, at_m: [0.1, 1.5]}
liaisons: {s: {kind: spring, stiffness_n_per_m: 300}}
links: [{liaison: s, between: [load, "jelly[9]"], rest_m: 0.3}]
ports:
  hand: {device: d, axes: [0, 1], role: liaison, of: [jelly, load]}
)";

TEST(PortBody, IsPushedAtItsCentreOfMassAndNeitherTurnsNorGivesWay) {
  const auto scene = std::make_shared<const scene::Scene>(sound(kHeld));
  Simulation simulation(scene, 7);
  const engine::World& world = simulation.world();
  const scene::Port& port = scene->ports.front();
  const Vec3 start = position_of(world, port);
  EXPECT_NEAR(start.x(), (12 * 0.02 * 0.15 + 0.3 * 0.1) / 0.54, 1e-14);
  EXPECT_NEAR(start.y(), (12 * 0.02 * 1.1 + 0.3 * 1.5) / 0.54, 1e-14);
  EXPECT_DOUBLE_EQ(mass_of(*scene, port), 0.54);

  EventRoom events;
  for (std::uint64_t tick = 1; tick <= 500; ++tick) {
    msg::GestureForces sample;
    sample.device_id(port.device_id);
    sample.epoch(5);
    sample.sample(tick);
    sample.axis_count(2);
    sample.force_n()[0] = 0.7;
    sample.force_n()[1] = -0.4;
    simulation.devices().front().receive(sample, true, DeviceReach{});
    while (!simulation.advance(1, events)) {
    }
  }

  const Vec3 moved = position_of(world, port) - start;
  EXPECT_GT(moved.x(), 0.1);
  EXPECT_NEAR(moved.y(), -0.4 / 0.7 * moved.x(), 1e-12);
  EXPECT_EQ(world.position(0), Vec3(-5, 0, 0));
  for (std::uint32_t mat = 1; mat < 14; ++mat) {
    const Vec3 way = world.position(mat) - scene->network.mats[mat].position;
    EXPECT_LT((way - moved).norm(), 1e-12) << mat;  // all alike, but for rounding
  }
  const auto answer = simulation.devices().front().answer_positions(world, true, 0);
  EXPECT_EQ(answer.position_m()[0], moved.x());
  EXPECT_EQ(answer.position_m()[1], moved.y());
  const engine::Energy energy = world.energy();
  EXPECT_NEAR(energy.port_work, 0.7 * moved.x() - 0.4 * moved.y(), 0.05 * energy.port_work);
  EXPECT_LT(std::abs(energy.residual()), 1e-12 * energy.largest);
}

TEST(PortBody, AHandOfTheStiffnessThatIsNamedStaysStill) {
  std::mt19937 random(test::test_seed());
  std::uniform_real_distribution<double> any(0.0, 1.0);
  for (int trial = 0; trial < 20; ++trial) {
    const auto decade = [&](double low, double high) {
      return std::to_string(low * std::pow(high / low, any(random)));
    };
    const scene::Scene scene = sound(test::filled(R"(cordis: 1
space: 1
step: {rate_hz: 1000}
matter:
  nail: {kind: fixed, at_m: -1}
  s: {kind: points, at_m: [0, 0.1, 0.2, 0.3],
      mass_kg: [<mass_kg>, <mass_kg_2>, <mass_kg_3>, <mass_kg_4>],
      medium_viscosity_n_s_per_m: <medium_viscosity_n_s_per_m>}
liaisons: {k: {kind: spring_damper, stiffness_n_per_m: <stiffness_n_per_m>,
               viscosity_n_s_per_m: <viscosity_n_s_per_m>}}
links:
  - {liaison: k, between: ["s[0..2]", "s[1..3]"]}
  - {liaison: k, between: [nail, "s[0]"]}
ports: {hand: {device: d, axes: [0], role: liaison, of: s}}
)",
                                                  {{"mass_kg", decade(0.01, 1)},
                                                   {"mass_kg_2", decade(0.01, 1)},
                                                   {"mass_kg_3", decade(0.01, 1)},
                                                   {"mass_kg_4", decade(0.01, 1)},
                                                   {"medium_viscosity_n_s_per_m", decade(0.001, 1)},
                                                   {"stiffness_n_per_m", decade(10, 3000)},
                                                   {"viscosity_n_s_per_m", decade(0.001, 1)}}));
    const plan::LiaisonGraph graph = plan::liaison_graph(scene.network);
    const scene::Port& port = scene.ports.front();
    // With a force that is not late and held for one step alone, the limit is that of the scheme.
    const plan::PortLoop at_once{1e-3, 0.0, 1};
    const double stiffness = plan::largest_hand_stiffness(max_load_of(graph, scene, port),
                                                          mass_of(scene, port), at_once);
    if (stiffness == 0.0) continue;
    engine::World world(std::make_shared<const engine::Network>(scene.network));
    apply_force(world, port, Vec3(5, 0, 0));
    double farthest = 0.0;
    for (int n = 0; n < 20000; ++n) {
      world.step();
      const Vec3 way = position_of(world, port) - port.rest;
      apply_force(world, port, -0.999 * stiffness * way);
      farthest = std::max(farthest, std::abs(way.x()));
    }
    EXPECT_LT(farthest, 1.0) << stiffness;
  }
}

TEST(PortBody, IsBrakedForCertainByWhatNoneOfItsMassesEscapes) {
  const auto viscosity = [](const std::string& core, const std::string& skin) {
    const scene::Scene scene = sound(test::filled(R"(cordis: 1
space: 1
step: {rate_hz: 1000}
matter:
  core: {kind: mass, at_m: 0, mass_kg: 1, medium_viscosity_n_s_per_m: <core>}
  skin: {kind: mass, at_m: 1, mass_kg: 0.001, medium_viscosity_n_s_per_m: <skin>}
liaisons: {k: {kind: spring, stiffness_n_per_m: 10, rest_m: 1}}
links: [{liaison: k, between: [core, skin]}]
ports: {hand: {device: d, axes: [0], role: liaison, of: [core, skin]}}
)",
                                                  {{"core", core}, {"skin", skin}}));
    return min_load_of(plan::liaison_graph(scene.network), scene, scene.ports.front()).viscosity;
  };
  EXPECT_EQ(viscosity("0", "5"), 0.0);
  const double share = 1.0 / 1.001;
  EXPECT_NEAR(viscosity("0.5", "5"), 1.0 / (share * share / 0.5 + 1e-6 * share * share / 5.0),
              1e-12);
  EXPECT_NEAR(viscosity("2", "0.002"), 2.002, 1e-12) << "in proportion to the masses: their sum";
}

TEST(PortBody, AHandThatIsLateStaysStillBelowTheStiffnessThatIsNamed) {
  std::mt19937 random(test::test_seed());
  std::uniform_real_distribution<double> any(0.0, 1.0);
  for (int trial = 0; trial < 20; ++trial) {
    const auto decade = [&](double low, double high) {
      return std::to_string(low * std::pow(high / low, any(random)));
    };
    const scene::Scene scene = sound(test::filled(R"(cordis: 1
space: 1
step: {rate_hz: 1000}
matter:
  nail: {kind: fixed, at_m: 2}
  core: {kind: mass, at_m: 0, mass_kg: <mass_kg>,
         medium_viscosity_n_s_per_m: <medium_viscosity_n_s_per_m>}
  skin: {kind: mass, at_m: 1, mass_kg: <mass_kg_2>}
liaisons:
  k: {kind: spring, rest_m: 1, stiffness_n_per_m: <stiffness_n_per_m>}
  z: {kind: damper, viscosity_n_s_per_m: <viscosity_n_s_per_m>}
links:
  - {liaison: k, between: [core, skin]}
  - {liaison: z, between: [skin, nail]}
ports: {hand: {device: d, axes: [0], role: liaison, of: [core, skin]}}
)",
                                                  {{"mass_kg", decade(0.1, 1)},
                                                   {"medium_viscosity_n_s_per_m", decade(0.1, 2)},
                                                   {"mass_kg_2", decade(0.01, 0.1)},
                                                   {"stiffness_n_per_m", decade(5, 50)},
                                                   {"viscosity_n_s_per_m", decade(0.1, 4)}}));
    const scene::Port& port = scene.ports.front();
    const plan::PortLoad load = min_load_of(plan::liaison_graph(scene.network), scene, port);
    const double stiffness =
        plan::largest_hand_stiffness(load, mass_of(scene, port), plan::PortLoop{1e-3, 1.0, 1});
    engine::World world(std::make_shared<const engine::Network>(scene.network));
    apply_force(world, port, Vec3(5, 0, 0));
    world.step();
    const double start = world.energy().kinetic + world.energy().elastic;
    double before = 0.0;  // where the centre was a period ago
    double last_way = 0.0;
    for (int n = 0; n < 40000; ++n) {
      const double way = (position_of(world, port) - port.rest).x();
      apply_force(world, port, Vec3(-0.95 * stiffness * before, 0, 0));
      before = way;
      ASSERT_TRUE(std::isfinite(way)) << stiffness;
      last_way = std::max(n < 39000 ? 0.0 : last_way, std::abs(way));
      world.step();
    }
    EXPECT_GT(start, 0.0);
    EXPECT_LT(last_way, 1.0) << stiffness;
  }
}

TEST(PortBody, OfOneMassIsAsAPortOfItsOwn) {
  const scene::Scene scene = sound(R"(cordis: 1
space: 1
step: {rate_hz: 1000}
world: {viscosity_n_s_per_m: 0.5}
matter:
  nail: {kind: fixed, at_m: 0}
  bob: {kind: mass, mass_kg: 0.2, at_m: 1}
liaisons: {k: {kind: spring_damper, stiffness_n_per_m: 70, viscosity_n_s_per_m: 0.3, rest_m: 1}}
links: [{liaison: k, between: [nail, bob]}]
ports: {hand: {device: d, axes: [0], role: liaison, of: bob}}
)");
  const plan::LiaisonGraph graph = plan::liaison_graph(scene.network);
  const plan::PortLoad load = max_load_of(graph, scene, scene.ports.front());
  EXPECT_NEAR(load.stiffness, 70.0, 1e-9);
  EXPECT_NEAR(load.viscosity, 0.8, 1e-12);
  EXPECT_EQ(mass_of(scene, scene.ports.front()), 0.2);
}

TEST(PortBody, SaysWhatItCannotMove) {
  const auto problem = [](const std::string& port) {
    config::Problems problems;
    scene::load_scene_text(test::filled(R"(cordis: 1
space: 1
step: {rate_hz: 1000}
matter:
  nail: {kind: fixed, at_m: 0}
  bob: {kind: mass, mass_kg: 1, at_m: [1, 2, 3]}
ports:
  a: {device: d, axes: [0], role: liaison, of: "bob[0..1]"}
  b: <port>
)",
                                        {{"port", port}}),
                           "t", problems);
    return problems.all().empty() ? "" : problems.all()[0].message;
  };
  EXPECT_EQ(problem("{device: d, axes: [1], role: liaison, of: \"bob[2]\"}"), "");
  EXPECT_EQ(problem("{device: e, axes: [1], role: mass, of: \"bob[2]\"}"),
            "a body is pushed, so its port has the role liaison");
  EXPECT_EQ(problem("{device: d, axes: [1], role: liaison, of: nail}"),
            "a port moves masses, and 'nail[0]' is fixed, driven or held by a device");
  EXPECT_EQ(problem("{device: d, axes: [1], role: liaison, of: bob}"),
            "'bob[0]' is moved by port 'a' already");
  EXPECT_EQ(problem("{device: d, axes: [1], role: liaison, of: \"bob[2]\", mass_kg: 1}"),
            "unknown key 'mass_kg' in port 'b'");
}

TEST(PortBody, HasNoMassThatAnotherPortPushes) {
  const auto problem = [](const std::string& ports) {
    config::Problems problems;
    scene::load_scene_text(
        R"(cordis: 1
space: 1
step: {rate_hz: 1000}
matter: {bob: {kind: mass, mass_kg: 1, at_m: 1}}
ports:
)" + ports,
        "t", problems);
    return problems.all().empty() ? "" : problems.all()[0].message;
  };
  const std::string finger =
      "  finger: {device: d, axes: [0], role: liaison, at_m: 0, mass_kg: 1}\n";
  EXPECT_EQ(problem(finger + "  hand: {device: d, axes: [1], role: liaison, of: bob}\n"), "");
  EXPECT_EQ(problem(finger + "  hand: {device: d, axes: [1], role: liaison, of: [bob, finger]}\n"),
            "'finger.handle[0]' is moved by port 'finger' already");
}

}  // namespace
}  // namespace cordis::sim
