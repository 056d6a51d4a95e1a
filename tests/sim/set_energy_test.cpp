// tests/sim/set_energy_test.cpp -- what may reach a pair of a set counts in its certificate.
#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "sim_node/plan/plan.h"
#include "sim_node/run/bound_text.h"
#include "tests/sim/loaded_scenes.h"
#include "tests/support/watched_scenes.h"

namespace cordis::sim {
namespace {

/// A pressed spring, 10 J, shoots 1 g at two balls of 1 kg.
const char* const kShot = R"(cordis: 1
name: shot
space: 1
step: {rate_hz: <rate>, integrator: cordis}
matter:
  wall: {kind: fixed, at_m: [-0.5]}
  shot: {kind: points, mass_kg: 0.001, at_m: [[0]]}
  targets: {kind: points, mass_kg: 1, at_m: [[1.0], [1.5]]}
liaisons:
  spring: {stiffness_n_per_m: 80.0, pulls: false}
  atom: {elasticity: {kind: lennard_jones, depth_j: 0.01, diameter_m: 0.1, cut_m: 0.25}}
links:
  - {liaison: spring, between: [wall, "shot[0]"], rest_m: 1.0}
  - {liaison: atom, between_sets: [shot, targets], range_m: 0.25}
)";

/// Two balls of 10 g fall from 2 and 40 m on two that are fixed.
const char* const kDrop = R"(cordis: 1
name: drop
space: 1
step: {rate_hz: <rate>}
world: {gravity_m_per_s2: [-9.81]}
matter:
  floor: {kind: points, fixed: true, at_m: [[0], [-5]]}
  balls: {kind: points, mass_kg: 0.01, at_m: [[2], [40]]}
liaisons:
  atom: {elasticity: {kind: lennard_jones, depth_j: 0.001, diameter_m: 0.1, cut_m: 0.25}}
links:
  - {liaison: atom, between_sets: [balls, floor], range_m: 0.25}
)";

/// Light balls among heavy ones, on pressed links of 3 kJ.
const char* const kLinked = R"(cordis: 1
name: linked
space: 1
step: {rate_hz: <rate>, integrator: cordis}
matter:
  b: {kind: points, at_m: [[2.7315], [-3.04279], [2.50232]], mass_kg: [0.0009205, 0.001189, 0.0008127], radius_m: 0.4767, velocity_m_per_s: [78.17]}
  c: {kind: points, at_m: [[0.56345], [0.25017], [-2.49454], [0.03753], [-1.27506], [-0.46457], [0.6853], [0.58524], [0.82941]], mass_kg: [0.0004668, 0.01225, 0.0006909, 0.002491, 0.0005487, 0.01835, 0.000758, 0.002588, 0.01575], radius_m: 0.2987, velocity_m_per_s: [-32.99]}
liaisons:
  spring: {stiffness_n_per_m: 1300.0, pulls: false}
  felt: {elasticity: {kind: power, coefficient: 52.92, exponent: 1.5}, pulls: false}
  atom: {elasticity: {kind: lennard_jones, depth_j: 0.1342, diameter_m: 0.337, cut_m: 0.8426}}
links:
  - {liaison: spring, between: ["c[0]", "c[1]"], rest_m: 1.566}
  - {liaison: felt, between: ["c[0]", "b[1]"], rest_m: 0.7805}
  - {liaison: atom, between_sets: [b, c], rest_m: 0.47, range_m: 0.611}
)";

std::string at_rate(const std::string& text, const std::string& rate_hz) {
  return test::filled(text, {{"rate", rate_hz}});
}

/// The largest energy over that of the start, of kinetic and potential energy, fall included.
double largest_growth(const std::string& text, double duration_s) {
  const auto loaded = loaded_scene_of(text);
  Simulation& simulation = loaded->simulation;
  EventRoom events(64);
  const auto energy_of_now = [&] {
    const engine::Energy energy = simulation.world().energy();
    return energy.kinetic + energy.elastic + energy.gravity;
  };
  const double start = energy_of_now();
  double largest = start;
  while (simulation.simulated_s() < duration_s && !simulation.failed()) {
    simulation.advance(1, events);
    largest = std::max(largest, energy_of_now());
  }
  return largest / start;
}

TEST(SetEnergy, OfALinkThatShootsABallAtASetCounts) {
  for (const char* const rate : {"2000", "5000", "10000"})
    EXPECT_FALSE(loaded_scene_of(at_rate(kShot, rate))->is_certain) << rate;
  const std::string fine = at_rate(kShot, "30000");
  EXPECT_TRUE(loaded_scene_of(fine)->is_certain);
  EXPECT_LT(largest_growth(fine, 0.1), 1.1);
}

TEST(SetEnergy, OfBallsThatFallOnASetCounts) {
  for (const char* const rate : {"1000", "2000"})
    EXPECT_FALSE(loaded_scene_of(at_rate(kDrop, rate))->is_certain) << rate;
  const std::string fine = at_rate(kDrop, "10000");
  EXPECT_TRUE(loaded_scene_of(fine)->is_certain);
  EXPECT_LT(largest_growth(fine, 3.5), 1.1);
}

TEST(SetEnergy, OfLinksBetweenMembersOfASetCounts) {
  EXPECT_FALSE(loaded_scene_of(at_rate(kLinked, "17000"))->is_certain);
}

/// More targets make no step longer than one does.
TEST(SetEnergy, IsThatOfASinglePairAtLeastWithMoreMembers) {
  const auto certain_step = [](const std::string& text) {
    const auto scene = scene_of(text);
    const engine::NetworkDescription& network = scene->network;
    const plan::LiaisonGraph graph = plan::liaison_graph(network);
    return plan::certain_step_of(network, graph, plan::stability_of(network, graph));
  };
  std::string single = at_rate(kShot, "20000");
  single.replace(single.find("[[1.0], [1.5]]"), 14, "[[1.0]]");
  EXPECT_LT(certain_step(at_rate(kShot, "20000")), 1.001 * certain_step(single));
}

/// The shot has its energy before it meets a target.
TEST(SetEnergy, LetsGoBeforeABallMeetsASetTooFast) {
  for (const char* const rate : {"2000", "5000"}) {
    const auto loaded = loaded_scene_of(at_rate(kShot, rate));
    Simulation& simulation = loaded->simulation;
    const double start = simulation.world().energy().total();
    EventRoom events(64);
    while (simulation.passed_bound() == PassedBound::kNone && simulation.simulated_s() < 0.1)
      simulation.advance(1, events);
    EXPECT_EQ(simulation.passed_bound(), PassedBound::kNumber) << rate;
    EXPECT_LT(simulation.world().energy().total(), 1.1 * start) << "in time";
    EXPECT_NE(bound_text(*loaded).find("K' + 2 Z' came to 4"), std::string::npos);
  }
}

TEST(SetEnergy, LetsNothingGoWhereTheStepBearsIt) {
  for (const std::string& text : {at_rate(kShot, "30000"), at_rate(kDrop, "10000")}) {
    const auto loaded = loaded_scene_of(text);
    EventRoom events(64);
    while (loaded->simulation.simulated_s() < 3.5 && !loaded->simulation.failed())
      loaded->simulation.advance(1, events);
    EXPECT_FALSE(loaded->simulation.failed());
    EXPECT_EQ(loaded->simulation.passed_bound(), PassedBound::kNone);
  }
}

/// Atoms that nothing else moves: the motion of the two fastest counts, not that of all in one pair.
TEST(SetEnergy, OfAtomsAloneIsThatOfTheTwoFastest) {
  const std::string atoms = R"yaml(cordis: 1
name: atoms
space: 2
step: {rate_hz: <rate>}
matter:
  gas: {kind: lattice, structure: square, counts: [20, 20], corner_m: [0, 0], spacing_m: 0.013, mass_kg: 0.001, velocity_m_per_s: ["0.3*sin(index)", "0.3*cos(3*index)"]}
liaisons:
  atom: {elasticity: {kind: lennard_jones, depth_j: 1.0e-4, diameter_m: 0.01, cut_m: 0.025}}
links: [{liaison: atom, within: gas}]
)yaml";
  EXPECT_TRUE(loaded_scene_of(at_rate(atoms, "4000"))->is_certain);
}

}  // namespace
}  // namespace cordis::sim
