// tests/scene/reachable_energy_test.cpp -- scenes whose pairs or walls get much energy, or little.
#include <ostream>
#include <string>

#include <gtest/gtest.h>

#include "sim_node/plan/plan.h"
#include "sim_node/plan/stability/liaison_graph.h"
#include "tests/scene/scene_text.h"

namespace cordis::scene {
namespace {

struct Case {
  const char* name;
  double rate_hz;
  const char* text;
};

void PrintTo(const Case& one, std::ostream* stream) {
  *stream << one.name;
}

plan::Stability stability_of(const Case& one) {
  Scene scene = sound_scene(2, one.text);
  scene.network.step = 1.0 / one.rate_hz;
  return plan::stability_of(scene.network, plan::liaison_graph(scene.network));
}

class NotCertain : public testing::TestWithParam<Case> {};

/// Each of these was certified, and exploded or let a ball through.
TEST_P(NotCertain, AsItsEnergyIsCounted) {
  const plan::Stability stability = stability_of(GetParam());
  EXPECT_TRUE(stability.uncertainty.has_value() || !stability.holds());
}

constexpr Case kNotCertain[] = {
    {"TheWellOfAnotherSet", 2000.0, R"yaml(
liaisons:
  pull: {elasticity: {kind: rings, rings: [{stiffness_n_per_m: -60, radius_m: 1.5}, {stiffness_n_per_m: 1000, radius_m: 0.1}]}}
  balls: {elasticity: {kind: lennard_jones, depth_j: 0.0005, diameter_m: 0.03, cut_m: 0.08}}
matter: {a: {kind: points, mass_kg: 0.05, at_m: [[-0.4, 0], [0.4, 0]]}}
links:
  - {liaison: pull, within: a, name: pull}
  - {liaison: balls, within: a, name: balls}
)yaml"},
    {"AWellThatPairsComeInto", 2000.0, R"yaml(
liaisons:
  magnet: {elasticity: {kind: table, at_m: [-0.03, 0, 0.05, 0.3, 0.5], force_n: [-30, 0, 30, 30, 0]}, range_m: 0.54, rest_m: 0.04}
  balls: {elasticity: {kind: lennard_jones, depth_j: 0.0005, diameter_m: 0.03, cut_m: 0.08}}
matter: {a: {kind: points, mass_kg: 0.05, at_m: [[-0.3, 0], [0.3, 0]], velocity_m_per_s: ["0.5 * (1 - 2 * index)", 0]}}
links:
  - {liaison: magnet, within: a, name: pull}
  - {liaison: balls, within: a, name: balls}
)yaml"},
    {"AFallInARoom", 4000.0, R"yaml(
world: {gravity_m_per_s2: [0, -9.81]}
liaisons: {soft: {stiffness_n_per_m: 2000, viscosity_n_s_per_m: 1, pulls: false, range: rest}}
matter:
  a: {kind: mass, ball: {mass_kg: 1, radius_m: 0.1}, at_m: [0, 0]}
  room: {kind: box, center_m: [0, 0], size_m: [20, 20], sides: both}
links: [{liaison: soft, between_sets: [room, a], name: stop}]
)yaml"},
    {"AFallInADrum", 4000.0, R"yaml(
world: {gravity_m_per_s2: [0, -9.81]}
liaisons: {soft: {stiffness_n_per_m: 2000, viscosity_n_s_per_m: 1, pulls: false, range: rest}}
matter:
  a: {kind: mass, ball: {mass_kg: 1, radius_m: 0.1}, at_m: [0, 0]}
  drum: {kind: cylinder, center_m: [0, 0], radius_m: 10, sides: both}
links: [{liaison: soft, between_sets: [drum, a], name: stop}]
)yaml"},
    {"BallsPressedAtTheStart", 8000.0, R"yaml(
liaisons:
  hard: {stiffness_n_per_m: 20000, viscosity_n_s_per_m: 0.5, pulls: false, range: rest}
  soft: {stiffness_n_per_m: 1000, viscosity_n_s_per_m: 0.05, pulls: false, range: rest}
matter:
  a: {kind: mass, ball: {mass_kg: 0.01, radius_m: 0.05}, at_m: [[0, 0], [0.08, 0]]}
  wall: {kind: plane, at_m: [0.2, 0], normal: -x, sides: both}
links:
  - {liaison: hard, within: a, name: pressed}
  - {liaison: soft, between_sets: [wall, a], name: stop}
)yaml"},
    {"BallsThatAttractEachOtherThroughAWall", 8000.0, R"yaml(
liaisons:
  ring: {elasticity: {kind: rings, rings: [{stiffness_n_per_m: 1000, radius_m: 0.1}, {stiffness_n_per_m: -100, radius_m: 0.6}]}, viscosity_n_s_per_m: 0.1}
  soft: {stiffness_n_per_m: 2000, viscosity_n_s_per_m: 1, pulls: false, range: rest}
matter:
  a: {kind: mass, ball: {mass_kg: 0.1, radius_m: 0.05}, at_m: [[-0.5, 0], [0.05, 0]]}
  wall: {kind: plane, at_m: [0, 0], normal: -x, sides: both}
links:
  - {liaison: ring, within: a, name: pull}
  - {liaison: soft, between_sets: [wall, a], name: stop}
)yaml"},
    {"APistonThatThrowsBallsAtOthers", 4000.0, R"yaml(
liaisons:
  piston: {stiffness_n_per_m: 5000, pulls: false, range: rest}
  balls: {elasticity: {kind: lennard_jones, depth_j: 0.0002, diameter_m: 0.03, cut_m: 0.08}}
matter:
  p: {kind: plane, at_m: [-0.1, 0], normal: x, driven: {displacement_m: ["10 * min(time_s, 0.02)", 0]
}
}
  c: {kind: points, mass_kg: 0.02, radius_m: 0.05, at_m: [[0, 0], [0.4, 0], [0.5, 0]]}
links:
  - {liaison: balls, within: c, name: balls}
  - {liaison: piston, between_sets: [p, "c[0]"], name: push}
)yaml"},
    {"APistonThatThrowsABallAtAWall", 8000.0, R"yaml(
liaisons:
  hard: {stiffness_n_per_m: 20000, viscosity_n_s_per_m: 0.5, pulls: false, range: rest}
  soft: {stiffness_n_per_m: 60, viscosity_n_s_per_m: 0.02, pulls: false, range: rest}
matter:
  a: {kind: mass, ball: {mass_kg: 0.01, radius_m: 0.05}, at_m: [0, 0]}
  p: {kind: plane, at_m: [-0.1, 0], normal: x, driven: {displacement_m: ["2.5 * min(time_s, 0.04)", 0]
  }
  }
  wall: {kind: plane, at_m: [0.4, 0], normal: -x, sides: both}
links:
  - {liaison: hard, between_sets: [p, a], name: push}
  - {liaison: soft, between_sets: [wall, a], name: stop}
)yaml"},
    {"TwoBodiesThatMeet", 8000.0, R"yaml(
liaisons:
  hard: {stiffness_n_per_m: 20000, viscosity_n_s_per_m: 0.5, pulls: false, range: rest}
  soft: {stiffness_n_per_m: 95, viscosity_n_s_per_m: 0.02, pulls: false, range: rest}
matter:
  h: {kind: points, mass_kg: 0.5828, radius_m: 0.1, at_m: [[0, 0]], velocity_m_per_s: [1, 0]}
  l: {kind: points, mass_kg: 0.1, radius_m: 0.1, at_m: [[0.5, 0]], velocity_m_per_s: [-2.414, 0]}
  walls: {kind: plane, at_m: [1, 0], normal: -x, sides: both}
  far: {kind: plane, at_m: [-5, 0], normal: -x, sides: both}
links:
  - {liaison: hard, between_sets: [h, l], name: meet}
  - {liaison: soft, between_sets: [[walls, far], l], name: stop}
)yaml"},
};

INSTANTIATE_TEST_SUITE_P(Scenes, NotCertain, testing::ValuesIn(kNotCertain),
                         [](const auto& one) { return one.param.name; });

class Certain : public testing::TestWithParam<Case> {};

TEST_P(Certain, AsNothingElseComesToIt) {
  const plan::Stability stability = stability_of(GetParam());
  EXPECT_TRUE(stability.holds());
  EXPECT_FALSE(stability.uncertainty) << stability.uncertainty->why;
}

constexpr Case kCertain[] = {
    {"AHeavyBallAtRestBesideALightOneThatIsFast", 2000.0, R"yaml(
liaisons: {touch: {stiffness_n_per_m: 2000, viscosity_n_s_per_m: 0.09, pulls: false, range: rest}}
matter:
  a: {kind: points, mass_kg: [10, 0.01], radius_m: 0.05, at_m: [[0.5, 0.3], [-0.5, 0]], velocity_m_per_s: [0, "20 * index"]}
  room: {kind: box, center_m: [0, 0], size_m: [2, 2], sides: both}
links: [{liaison: touch, between_sets: [room, a], name: stop}]
)yaml"},
    {"ABeadOnAThreadBesideAWall", 8000.0, R"yaml(
world: {gravity_m_per_s2: [0, -9.81]}
liaisons:
  touch: {stiffness_n_per_m: 1200, viscosity_n_s_per_m: 0.04, pulls: false, range: rest}
  thread: {kind: spring_damper, stiffness_n_per_m: 2000, viscosity_n_s_per_m: 0.5}
matter:
  hook: {kind: fixed, at_m: [0, 1]}
  a: {kind: mass, ball: {mass_kg: 0.05, radius_m: 0.05}, at_m: [0.05, 0]}
  wall: {kind: plane, at_m: [-0.07, 0], normal: x, sides: both}
links: [{liaison: touch, between_sets: [wall, a], name: stop}, {liaison: thread, between: [hook, a]}]
)yaml"},
};

INSTANTIATE_TEST_SUITE_P(Scenes, Certain, testing::ValuesIn(kCertain),
                         [](const auto& one) { return one.param.name; });

}  // namespace
}  // namespace cordis::scene
