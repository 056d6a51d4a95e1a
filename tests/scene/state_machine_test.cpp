// tests/scene/state_machine_test.cpp
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "sim_node/engine/world.h"
#include "tests/scene/scene_text.h"

namespace cordis::scene {
namespace {

constexpr const char* kTwo =
    R"(matter:
  wall: {kind: fixed, at_m: [0, 0]}
  bob: {kind: mass, mass_kg: 1, at_m: [1, 0]}
)";

engine::NetworkDescription network_of(const std::string& liaisons, const std::string& links) {
  return sound_scene(2, kTwo + ("liaisons:\n" + liaisons) + "links:\n" + links).network;
}

constexpr const char* kCollophane =
    R"yaml(  collophane:
    parameters: {stiffness_n_per_m: 400, hold_m: 0.002, slow_m_per_s: hold_m * 5}
    start: unhooked
    states:
      hooked:
        stiffness_n_per_m: stiffness_n_per_m
        viscosity_n_s_per_m: 0.8
        exits: [{to: unhooked, when: abs(elongation_m) > hold_m}]
      unhooked:
        viscosity_n_s_per_m: 2 * 0.025
        exits:
          - to: hooked
            when: "abs(speed_m_per_s) < slow_m_per_s and falling(abs(speed_m_per_s))"
            rest: here
)yaml";

TEST(StateMachine, HasItsStatesExitsAndParametersPutToValues) {
  const engine::NetworkDescription network =
      network_of(kCollophane, "  - {liaison: collophane, between: [wall, bob], rest_m: 0.9}\n");

  ASSERT_EQ(network.state_machines.size(), 1u);
  const engine::StateMachine& state_machine = network.state_machines[0];
  ASSERT_EQ(state_machine.states.size(), 2u);
  EXPECT_EQ(state_machine.start, 1u);
  EXPECT_EQ(state_machine.states[0].name, "hooked");
  EXPECT_EQ(state_machine.states[0].stiffness, 400.0);
  EXPECT_EQ(state_machine.states[0].viscosity, 0.8);
  EXPECT_EQ(state_machine.states[1].viscosity, 0.05);
  ASSERT_EQ(state_machine.exits.size(), 2u);
  EXPECT_EQ(state_machine.exits[0].target, 1u);
  EXPECT_EQ(state_machine.exits[0].triggered, engine::Quantity::kElongation);
  EXPECT_EQ(state_machine.exits[0].rest, engine::RestRule::kKeep);
  EXPECT_EQ(state_machine.exits[1].target, 0u);
  EXPECT_EQ(state_machine.exits[1].triggered, engine::Quantity::kSpeed);
  EXPECT_EQ(state_machine.exits[1].rest, engine::RestRule::kHere);
  EXPECT_EQ(state_machine.exits[1].when.code[2].constant, 0.01);  // slow, after hold
  ASSERT_EQ(network.state_links.size(), 1u);
  EXPECT_EQ(network.state_links[0].rest_length, 0.9);
}

TEST(StateMachine, IsOneForEachDistinctSetOfParameters) {
  const engine::NetworkDescription network =
      network_of(kCollophane,
                 R"(  - {liaison: collophane, between: [wall, bob]}
  - {liaison: collophane, between: [bob, wall]}
  - {liaison: collophane, between: [wall, bob], hold_m: 0.004}
  - {liaison: collophane, between: [wall, bob], hold_m: 0.004}
  - {liaison: collophane, between: [wall, bob], hold_m: 0.004, name: own}
)");
  ASSERT_EQ(network.state_links.size(), 5u);
  const auto machine_of = [&](std::size_t link) { return network.state_links[link].state_machine; };
  EXPECT_EQ(network.state_machines.size(), 3u);
  EXPECT_EQ(machine_of(0), machine_of(1));
  EXPECT_NE(machine_of(0), machine_of(2));
  EXPECT_EQ(machine_of(2), machine_of(3));
  EXPECT_NE(machine_of(2),
            machine_of(4));  // of its own, for it has a name by which it can be changed
  const engine::StateMachine& held = network.state_machines[machine_of(2)];
  EXPECT_EQ(held.exits[0].when.code[2].constant, 0.004);
  EXPECT_EQ(held.exits[1].when.code[2].constant, 0.02);  // what depends on it follows
}

TEST(StateMachine, LikeAnotherHasWhatItDoesNotSayItself) {
  const engine::NetworkDescription network = network_of(
      std::string("  rosin: {like: collophane, parameters: {hold_m: 0.003}}\n") + kCollophane +
          R"(  wet:
    like: rosin
    states: {hooked: {viscosity_n_s_per_m: 7}}
)",
      "  - {liaison: wet, between: [wall, bob]}\n");
  const engine::StateMachine& wet = network.state_machines.at(0);
  EXPECT_EQ(wet.states.size(), 2u);
  EXPECT_EQ(wet.start, 1u);
  EXPECT_EQ(wet.states[0].viscosity, 7.0);
  EXPECT_EQ(wet.states[0].stiffness, 400.0);
  EXPECT_EQ(wet.exits[0].when.code[2].constant, 0.003);
}

TEST(StateMachine, OfOneStateNeedsNoStates) {
  const engine::NetworkDescription network = network_of(
      R"(  clay:
    viscosity_n_s_per_m: 0.02
    elasticity: {kind: lennard_jones, depth_j: 1.0e-5, diameter_m: 0.008, cut_m: 0.02}
    dissipation: {kind: table, at_m_per_s: [-1, 0, 1], force_n: [-2, 0, 3]}
    force_limit_n: 5
    pulls: false
)",
      "  - {liaison: clay, between: [wall, bob], viscosity_n_s_per_m: 0.03}\n");
  const engine::StateMachine& clay = network.state_machines.at(0);
  ASSERT_TRUE(clay.is_stateless());
  const engine::LinkState& state = clay.states[0];
  EXPECT_EQ(state.viscosity, 0.03);
  const auto ball = std::get<engine::LennardJones>(state.elasticity);
  EXPECT_EQ(ball.well_depth, 1.0e-5);
  EXPECT_EQ(ball.diameter, 0.008);
  EXPECT_EQ(ball.cutoff, 0.02);
  EXPECT_EQ(std::get<engine::Table>(state.dissipation).value(),
            (std::vector<double>{-2.0, 0.0, 3.0}));
  EXPECT_EQ(state.force_limit, 5.0);
  EXPECT_FALSE(state.pulls);
  EXPECT_TRUE(state.pushes);
}

TEST(Condition, AsksForEveryQuantityByItsName) {
  // Two masses too heavy to be drawn together, 5 m apart in the third step, in which the link has
  // pulled with 10 N since 2 ms: the value of the event is that of the first quantity named.
  constexpr double kAge = 0.002;
  const engine::Vec3 velocity(0.5, -0.25, 2.0);
  const double speed = velocity.dot(engine::Vec3(0.6, 0.8, 0.0));
  const std::vector<std::pair<std::string, double>> values{
      {"distance_m", 5.0},      {"elongation_m", 1.0},
      {"rest_m", 4.0},          {"speed_m_per_s", speed},
      {"speed_x_m_per_s", 0.5}, {"speed_y_m_per_s", -0.25},
      {"speed_z_m_per_s", 2.0}, {"slip_m_per_s", std::sqrt(4.3125 - speed * speed)},
      {"force_n", 10.0},        {"impulse_n_s", 10.0 * kAge},
      {"age_s", kAge},          {"mass_a_kg", 3.0e6},
      {"mass_b_kg", 2.0e6}};
  const auto place = [&](int axis) {
    return std::to_string((axis == 2 ? 0 : axis + 3) - kAge * velocity[axis]);
  };
  for (const auto& [word, value] : values) {
    const Scene scene = sound_scene(3,
                                    R"(matter:
  a: {kind: mass, mass_kg: 3e6, at_m: [0, 0, 0]}
  b: {kind: mass, mass_kg: 2e6, at_m: [)" +
                                        place(0) + ", " + place(1) + ", " + place(2) +
                                        R"(], velocity_m_per_s: [0.5, -0.25, 2]}
liaisons:
  l: {states: {x: {stiffness_n_per_m: 10, exits: [{to: y, when: )" +
                                        word +
                                        R"( > -1e9 and age_s > 0.0015}]}, y: {}}}
links:
  - {liaison: l, between: [a, b], rest_m: 4}
)");
    engine::World world(std::make_shared<const engine::Network>(scene.network));
    for (int n = 0; n < 3; ++n) world.step();
    ASSERT_EQ(world.events().size(), 1u) << word;
    EXPECT_NEAR(world.events()[0].value, value, 1e-3 * std::abs(value)) << word;
  }
}

TEST(StateMachine, MayHaveALimitOfItsForceThatALinkGives) {
  const engine::NetworkDescription network = network_of(
      R"(  clutch:
    parameters: {slip_n: 3}
    states: {on: {stiffness_n_per_m: 9, force_limit_n: slip_n, final: true}}
  rubber: {stiffness_n_per_m: 9, force_limit_n: 4}
)",
      R"(  - {liaison: clutch, between: [wall, bob]}
  - {liaison: clutch, between: [wall, bob], slip_n: 0.5}
  - {liaison: rubber, between: [wall, bob], force_limit_n: 2}
)");
  const auto limit_of = [&](std::size_t link) {
    return network.state_machines.at(network.state_links.at(link).state_machine)
        .states[0]
        .force_limit;
  };
  EXPECT_EQ(limit_of(0), 3.0);
  EXPECT_EQ(limit_of(1), 0.5);
  EXPECT_EQ(limit_of(2), 2.0);
}

TEST(Law, OfEveryKindIsRead) {
  const auto law = [](const std::string& text) {
    return network_of("  l: {elasticity: " + text + "}\n",
                      "  - {liaison: l, between: [wall, bob]}\n")
        .state_machines.at(0)
        .states[0]
        .elasticity;
  };
  const auto table =
      std::get<engine::Table>(law("{kind: table, at_m: [-1, 0, 2], force_n: [-5, 0, 1]}"));
  EXPECT_EQ(table.argument(), (std::vector<double>{-1.0, 0.0, 2.0}));
  const auto power = std::get<engine::Power>(law("{kind: power, coefficient: 3e4, exponent: 1.5}"));
  EXPECT_EQ(power.coefficient, 3e4);
  EXPECT_EQ(power.exponent, 1.5);
  const auto rings = std::get<engine::Rings>(
      law("{kind: rings, rings: [{stiffness_n_per_m: 5, radius_m: 0.1}, {stiffness_n_per_m: -1, "
          "radius_m: 0.2}]}"));
  ASSERT_EQ(rings.rings.size(), 2u);
  EXPECT_EQ(rings.rings[1].stiffness, -1.0);
  EXPECT_EQ(rings.rings[1].radius, 0.2);
}

TEST(Law, OfAFreeExpressionIsItsValue) {
  const engine::NetworkDescription network = network_of(
      R"yaml(  l:
    parameters: {k: 500}
    elasticity: "k * elongation_m + 2e6 * elongation_m^3 - if(distance_m > 2, 1, 0)"
    dissipation: 3 * speed_m_per_s * mass_a_kg
)yaml",
      "  - {liaison: l, between: [wall, bob]}\n");
  const engine::LinkState& state = network.state_machines.at(0).states[0];
  ASSERT_TRUE(std::holds_alternative<engine::Expression>(state.elasticity));
  const auto tension = [&](double distance, double elongation) {
    return elastic_tension(state.elasticity, {distance, elongation});
  };
  EXPECT_NEAR(tension(1.0, 0.1), 500 * 0.1 + 2e6 * 0.001, 1e-9);
  EXPECT_NEAR(tension(3.0, 0.1), 500 * 0.1 + 2e6 * 0.001 - 1.0, 1e-9);
  EXPECT_EQ(viscous_tension(state.dissipation, {1.0, 0.1, 2.0, 4.0}), 24.0);
}

/// The tension of an expression at a distance of 2 m, an elongation of 0.5 m and a speed of -3 m/s.
double tension_of_text(const std::string& text, const std::string& parameters = "{}") {
  const engine::NetworkDescription network =
      network_of("  l:\n    parameters: " + parameters + "\n    elasticity: \"" + text + "\"\n",
                 "  - {liaison: l, between: [wall, bob]}\n");
  return elastic_tension(network.state_machines.at(0).states[0].elasticity, {2.0, 0.5, -3.0, 7.0});
}

TEST(Law, KnowsPowersChoicesAndFunctions) {
  const std::vector<std::pair<std::string, double>> expected{
      {"-distance_m^2", -4.0},
      {"distance_m^3^2", 512.0},
      {"(distance_m^3)^2", 64.0},
      {"distance_m^-2", 0.25},
      {"2 * distance_m^-3 * 4", 1.0},
      {"4^elongation_m", 2.0},
      {"4^0.5 * distance_m", 4.0},
      {"elongation_m^1.5", std::pow(0.5, 1.5)},
      {"2^3 * mass_a_kg", 56.0},
      {"if(speed_m_per_s > 0, 1, 2) * distance_m", 4.0},
      {"if(speed_m_per_s < 0 and not distance_m > 5, 4, 3)", 4.0},
      {"sign(speed_m_per_s) * 4", -4.0},
      {"exp(elongation_m)", std::exp(0.5)},
      {"log(distance_m)", std::log(2.0)},
      {"sin(speed_m_per_s)", std::sin(-3.0)},
      {"cos(speed_m_per_s)", std::cos(-3.0)},
      {"tanh(elongation_m)", std::tanh(0.5)},
      {"min(distance_m, 4, speed_m_per_s)", -3.0},
      {"max(distance_m, 4) + abs(speed_m_per_s) + sqrt(4)", 9.0},
      {"log(speed_m_per_s)", 0.0},
      {"1 / (distance_m - 2)", 0.0},
  };
  for (const auto& [text, tension] : expected)
    EXPECT_DOUBLE_EQ(tension_of_text(text), tension) << text;
  EXPECT_DOUBLE_EQ(tension_of_text("p^elongation_m * distance_m^n", "{p: 4, n: 3}"), 16.0);
}

TEST(Law, IsPartOfTheFingerprint) {
  const auto fingerprint = [](const std::string& text) {
    return engine::Network(network_of("  l: {elasticity: \"" + text + "\"}\n",
                                      "  - {liaison: l, between: [wall, bob]}\n"))
        .fingerprint();
  };
  EXPECT_EQ(fingerprint("3 * elongation_m"), fingerprint("3*elongation_m"));
  EXPECT_NE(fingerprint("3 * elongation_m"), fingerprint("3.5 * elongation_m"));
  EXPECT_NE(fingerprint("3 * elongation_m"), fingerprint("3 + elongation_m"));
  EXPECT_NE(fingerprint("elongation_m^2"), fingerprint("elongation_m^3"));
}

TEST(Liaison, MayBeAMaxwellElement) {
  const engine::NetworkDescription network =
      network_of("  creep: {kind: maxwell, stiffness_n_per_m: 100, viscosity_n_s_per_m: 5}\n",
                 R"(  - {liaison: creep, between: [wall, bob]}
  - {liaison: creep, between: [wall, bob], stiffness_n_per_m: 50}
)");
  ASSERT_EQ(network.maxwell_links.size(), 2u);
  EXPECT_EQ(network.maxwell_links[0].stiffness, 100.0);
  EXPECT_EQ(network.maxwell_links[0].viscosity, 5.0);
  EXPECT_EQ(network.maxwell_links[1].stiffness, 50.0);
}

TEST(Liaison, OfAMaxwellElementMayHaveAStartForce) {
  const engine::NetworkDescription network = network_of(
      R"(  creep:
    parameters: {load_n: 3}
    kind: maxwell
    stiffness_n_per_m: 100
    viscosity_n_s_per_m: 5
    start_force_n: -2 * load_n
)",
      R"(  - {liaison: creep, between: [wall, bob]}
  - {liaison: creep, between: [wall, bob], load_n: 4}
)");
  ASSERT_EQ(network.maxwell_links.size(), 2u);
  EXPECT_EQ(network.maxwell_links[0].start_force, -6.0);
  EXPECT_EQ(network.maxwell_links[1].start_force, -8.0);
}

TEST(Liaison, OfSeveralInParallelMakesALinkOfEach) {
  const Scene scene = sound_scene(2, kTwo + std::string(R"(liaisons:
  soft: {kind: spring, stiffness_n_per_m: 3}
  solid:
    parameters: {late_n_per_m: 7}
    parallel: [soft, {kind: maxwell, stiffness_n_per_m: late_n_per_m, viscosity_n_s_per_m: 1}]
links:
  - {liaison: solid, between: [wall, bob], rest_m: 2}
  - {liaison: solid, between: [wall, bob], late_n_per_m: 9, name: n}
)"));
  ASSERT_EQ(scene.network.links.size(), 2u);
  ASSERT_EQ(scene.network.maxwell_links.size(), 2u);
  EXPECT_EQ(scene.network.links[0].rest_length, 2.0);
  EXPECT_EQ(scene.network.links[1].rest_length, 1.0);
  EXPECT_EQ(scene.network.maxwell_links[0].stiffness, 7.0);
  EXPECT_EQ(scene.network.maxwell_links[1].stiffness, 9.0);
  std::string names;
  for (const NamedRange& range : scene.links) {
    names +=
        range.name + " " + std::to_string(range.first) + " " + std::to_string(range.count) + ", ";
  }
  EXPECT_EQ(names, "solid.soft 0 1, n.soft 1 1, solid.maxwell 2 1, n.maxwell 3 1, ");
}

TEST(SetLiaison, WithinASetReachesAsFarAsItsLaw) {
  const Scene scene = sound_scene(2,
                                  R"(liaisons:
  clay: {viscosity_n_s_per_m: 0.02, elasticity: {kind: lennard_jones, depth_j: 1.0e-5,
        diameter_m: 0.008, cut_m: 0.02}}
  touch: {stiffness_n_per_m: 90, pulls: false, range: rest}
matter:
  paste: {kind: mass, ball: {mass_kg: 1, radius_m: 0.01}, at_m: [[0, 0], [1, 0], [2, 0]]}
  grit: {kind: mass, ball: {mass_kg: 1, radius_m: 0.02}, at_m: [[0, 1], [1, 1]]}
links:
  - {liaison: clay, within: paste}
  - {liaison: clay, within: "paste[0..1]", range_m: 0.03}
  - {liaison: touch, between_sets: [paste, grit], name: rub}
  - {liaison: touch, within: grit, rest_m: 0.5}
)");
  const auto& sets = scene.network.sets;
  ASSERT_EQ(sets.size(), 4u);
  EXPECT_EQ(sets[0].set_p, (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_TRUE(sets[0].set_q.empty());
  EXPECT_EQ(sets[0].range, 0.02);
  EXPECT_EQ(sets[0].state_machine, sets[1].state_machine);
  EXPECT_EQ(sets[1].range, 0.03);
  EXPECT_EQ(sets[2].set_q, (std::vector<std::uint32_t>{3, 4}));
  EXPECT_EQ(sets[2].range, 0.03);  // the radii of two balls
  EXPECT_LT(sets[2].rest_length, 0.0);
  EXPECT_EQ(sets[3].range, 0.5);
  EXPECT_EQ(sets[3].rest_length, 0.5);
  EXPECT_EQ(scene.set_names, (std::vector<std::string>{"clay", "clay", "rub", "touch"}));
}

TEST(SetLiaison, MayBeLinear) {
  const Scene scene = sound_scene(2,
                                  R"(liaisons:
  s: {kind: spring_damper, stiffness_n_per_m: 3, viscosity_n_s_per_m: 4, rest_m: 1}
matter:
  a: {kind: mass, mass_kg: 1, at_m: [[0, 0], [1, 0]]}
links:
  - {liaison: s, within: a, range_m: 2}
)");
  const engine::StateMachine& pair =
      scene.network.state_machines.at(scene.network.sets.at(0).state_machine);
  EXPECT_TRUE(pair.is_stateless());
  EXPECT_EQ(pair.states[0].stiffness, 3.0);
  EXPECT_EQ(pair.states[0].viscosity, 4.0);
  EXPECT_EQ(scene.network.sets[0].rest_length, 1.0);
}

TEST(Matter, MayBeJoinedByLinksWithStates) {
  const Scene scene = sound_scene(2,
                                  R"(liaisons:
  brittle:
    parameters: {length_m: 0.1}
    states:
      whole: {stiffness_n_per_m: 10, exits: [{to: broken, when: elongation_m > length_m}]}
      broken: {}
matter:
  bar: {kind: string, count: 4, mass_kg: 1, from_m: [0, 0], to_m: [3, 0], liaison: brittle, length_m: 0.2}
signals:
  s: {of: "bar.links[2]", quantity: state}
  r: {of: "bar.links[2]", quantity: rest_length}
  n: {quantity: changes}
)");
  ASSERT_EQ(scene.network.state_links.size(), 3u);
  EXPECT_EQ(scene.network.state_machines.at(0).exits[0].when.code[1].constant, 0.2);
  engine::World world(std::make_shared<const engine::Network>(scene.network));
  world.force_state(2, 1);
  world.step();
  double values[3] = {};
  scene.signals.read(world, values);
  EXPECT_EQ(values[0], 1.0);
  EXPECT_EQ(values[1], 1.0);
  EXPECT_EQ(values[2], 1.0);
}

}  // namespace
}  // namespace cordis::scene
