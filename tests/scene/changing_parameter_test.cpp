// tests/scene/changing_parameter_test.cpp -- parameters of liaisons as formulas.
#include <cmath>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "sim_node/engine/world.h"
#include "sim_node/scene/parameters.h"
#include "tests/scene/bad_scene.h"

namespace cordis::scene {
namespace {

engine::World moving(const Scene& scene) {
  return engine::World(std::make_shared<const engine::Network>(scene.network));
}

/// A mass of 1 kg at 0.5 m from a fixed point, on a liaison, in 1 dimension.
std::string held_by(const std::string& liaison) {
  return "liaisons:\n  t: " + liaison + R"(
matter:
  a: {kind: fixed, at_m: 0}
  b: {kind: mass, mass_kg: 1, at_m: 0.5}
links:
  - {liaison: t, between: [a, b], name: l}
signals:
  x: {of: b, quantity: position}
)";
}

std::uint64_t hash_after(const std::string& liaison, int steps = 500) {
  const Scene scene = sound_scene(1, held_by(liaison));
  engine::World world = moving(scene);
  for (int n = 0; n < steps; ++n) world.step();
  return world.state_hash();
}

TEST(ChangingParameter, IsWhatItsLawWouldBe) {
  EXPECT_EQ(
      hash_after("{kind: spring, rest_m: 0.1, stiffness_n_per_m: 100 + 50 * sin(9 * time_s)}"),
      hash_after("{rest_m: 0.1, elasticity: (100 + 50 * sin(9 * time_s)) * elongation_m}"));
  EXPECT_EQ(hash_after("{kind: damper, viscosity_n_s_per_m: 2 + x}"),
            hash_after("{dissipation: (2 + x) * speed_m_per_s}"));
  EXPECT_EQ(hash_after("{kind: spring, stiffness_n_per_m: 90, rest_m: 0.2 * x}"),
            hash_after("{elasticity: 90 * (distance_m - 0.2 * b.position_m)}"));
  EXPECT_EQ(
      hash_after("{stiffness_n_per_m: 70 + time_s, rest_m: 0.3, elasticity: elongation_m ^ 3}"),
      hash_after("{rest_m: 0.3, elasticity: (70 + time_s) * elongation_m + elongation_m ^ 3}"));
}

TEST(ChangingParameter, OfARestLengthLeadsTheMass) {
  // x'' = -w^2 (x - 0.5 - v t) from rest at 0.5 is x = 0.5 + v t - v / w sin w t.
  const Scene scene =
      sound_scene(1, held_by("{kind: spring, stiffness_n_per_m: 400, rest_m: 0.5 + 0.3 * time_s}"));
  engine::World world = moving(scene);
  const double step = scene.network.step;
  for (int n = 1; n <= 1000; ++n) {
    world.step();
    const double t = n * step;
    ASSERT_NEAR(world.position(1).x(), 0.5 + 0.3 * t - 0.3 / 20.0 * std::sin(20.0 * t), 5e-5)
        << n;  // of order step^2
  }
  EXPECT_LT(std::abs(world.energy().integration_error()), 1e-4 * world.energy().largest);
}

TEST(ChangingParameter, IsSetToANumberWhileARunGoesOn) {
  const Scene scene = sound_scene(
      1, held_by("{kind: spring_damper, rest_m: 0.1, parameters: {swing: 50}, "
                 "stiffness_n_per_m: 100 + swing * sin(9 * time_s), viscosity_n_s_per_m: 1 + x}"));
  Parameters parameters(std::make_shared<const Scene>(scene));
  ASSERT_EQ(parameters.get("t").entries.size(), 1u);
  EXPECT_EQ(parameters.get("t").entries[0].first, "t.swing");

  const Parameters::Outcome outcome = parameters.set("t", "stiffness_n_per_m", 300.0);
  ASSERT_EQ(outcome.problem, "");
  ASSERT_EQ(outcome.changes.size(), 1u);
  engine::World world = moving(scene);
  world.step();
  world.replace_state_machine(outcome.changes[0].first, outcome.changes[0].state_machine);
  EXPECT_TRUE(world.step().has_energy);
  const engine::LinkState& state = outcome.changes[0].state_machine.states[0];
  EXPECT_EQ(state.stiffness, 300.0);
  EXPECT_TRUE(is_none(state.elasticity));
  std::uint32_t asked = 0;  // of the viscosity, which still follows x
  for (const engine::Instruction& word :
       std::get<engine::Expression>(state.dissipation).program.code) {
    if (word.operation != engine::Operation::kVariable) continue;
    ++asked;
    EXPECT_EQ(scene.network.variables[word.slot].quantity, engine::VariableKind::kPosition);
  }
  EXPECT_EQ(asked, 1u);
  EXPECT_TRUE(parameters.set("l", "swing", 20.0).problem.empty());
}

INSTANTIATE_TEST_SUITE_P(
    ChangingParameters, BadScenes,
    testing::Values(
        BadScene{kHead2,
                 R"(liaisons:
  l: {kind: spring, stiffness_n_per_m: "3 * ^tim_s"}
matter:
  m: {kind: mass, mass_kg: 1, at_m: [0, 0]}
)",
                 "'stiffness_n_per_m' in liaison 'l' names 'tim_s', which is no quantity and no "
                 "parameter",
                 "did you mean 'time_s'?"},
        BadScene{kHead2,
                 R"(liaisons:
  l: {kind: spring, stiffness_n_per_m: "time_s * ^elongation_m"}
matter:
  m: {kind: mass, mass_kg: 1, at_m: [0, 0]}
)",
                 "'stiffness_n_per_m' in liaison 'l' is fixed before the run and cannot ask for "
                 "'elongation_m'",
                 ""},
        BadScene{kHead2,
                 R"(liaisons:
  l: {elasticity: elongation_m * (m.position_x_m + ^m.positon_y_m)}
matter:
  f: {kind: fixed, at_m: [1, 0]}
  m: {kind: mass, mass_kg: 1, at_m: [0, 0]}
links:
  - {liaison: l, between: [f, m]}
)",
                 "a MAT has no quantity 'positon_y_m' that others may ask for",
                 "did you mean 'position_y_m'?"},
        BadScene{kHead2,
                 R"(liaisons:
  l: {kind: spring, stiffness_n_per_m: 2, rest_m: "0.1 * time_s"}
matter:
  m: {kind: mass, mass_kg: 1, at_m: [[0, 0], [1, 0]]}
links:
  - {liaison: l, between: ["m[0]", "m[1]"], rest_m: ^0.2}
)",
                 "the rest length of this liaison follows a formula, and a link gives it no other",
                 "leave it out, or use a liaison with a rest_m that is a number"}));

}  // namespace
}  // namespace cordis::scene
