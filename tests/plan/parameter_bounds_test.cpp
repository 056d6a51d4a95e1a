// tests/plan/parameter_bounds_test.cpp -- what parameters that follow variables lie within.
#include "sim_node/plan/stability/parameter_bounds.h"

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/engine/programs.h"
#include "tests/engine/scenes.h"

namespace cordis::plan {
namespace {

using engine::Operation;
using engine::Parameter;
using engine::Quantity;
using test::expression_law;
using test::one;
using test::q;
using test::Term;

Term variable(std::uint32_t slot) {
  Term term(0.0);
  term.program.code = {{Operation::kVariable, {}, 0.0, slot}};
  return term;
}

/// Variables within 0 and 1, and within 2 and infinity.
Reach reach_of_variables() {
  Reach reach;
  reach.variables = std::make_shared<const std::vector<Interval>>(
      std::vector<Interval>{{0.0, 1.0}, {2.0, INFINITY}});
  return reach;
}

void expect(const Interval& bounds, double low, double high) {
  EXPECT_EQ(bounds.low, low);
  EXPECT_EQ(bounds.high, high);
}

/// K from 100 to 104 N/m, Z from 0.5 to 3.5 N s/m.
engine::LinkState changing() {
  engine::LinkState state;
  state.stiffness = 100.0;
  state.viscosity = 0.5;
  state.elasticity = expression_law(Term(4.0) * variable(0) * q(Quantity::kElongation));
  state.dissipation = expression_law(Term(3.0) * variable(0) * q(Quantity::kSpeed));
  return state;
}

TEST(ParameterBounds, OfALinearStateAreItsNumberAndWhatItsFactorsAdd) {
  const LinearBounds bounds = linear_bounds(changing(), reach_of_variables());
  expect(bounds.stiffness, 100.0, 104.0);
  expect(bounds.viscosity, 0.5, 3.5);

  engine::LinkState unbounded = changing();
  unbounded.elasticity = expression_law(variable(1) * q(Quantity::kElongation));
  expect(linear_bounds(unbounded, reach_of_variables()).stiffness, -INFINITY, INFINITY);
  engine::LinkState no_product = changing();
  no_product.elasticity = expression_law(q(Quantity::kElongation) * variable(0));
  expect(linear_bounds(no_product, reach_of_variables()).stiffness, 100.0, 100.0);
}

TEST(ParameterBounds, OfAFormulaThatStepsAreItsTwoValues) {
  engine::LinkState state;
  const Term late = variable(1) > 3.0;
  state.elasticity = expression_law(test::three(Operation::kSelect, late, 200.0, 100.0) *
                                    q(Quantity::kElongation));
  state.dissipation =
      expression_law((Term(2.0) + one(Operation::kSign, variable(0) - 0.5)) * q(Quantity::kSpeed));
  const LinearBounds bounds = linear_bounds(state, reach_of_variables());
  expect(bounds.stiffness, 100.0, 200.0);
  expect(bounds.viscosity, 1.0, 3.0);
}

TEST(ParameterBounds, OfABendAreThoseOfAllItsStates) {
  engine::NetworkDescription network;
  engine::Bend bend;
  bend.stiffness = 7.0;
  bend.viscosity = 0.25;
  LinearBounds bounds = linear_bounds(network, bend, reach_of_variables());
  expect(bounds.stiffness, 7.0, 7.0);
  expect(bounds.viscosity, 0.25, 0.25);

  test::Behaving two_states;
  two_states.state(changing()).state(20.0, 9.0);
  network.state_machines = {two_states.state_machine};
  bend.state_machine = 0;
  bounds = linear_bounds(network, bend, reach_of_variables());
  expect(bounds.stiffness, 20.0, 104.0);
  expect(bounds.viscosity, 0.5, 9.0);
}

TEST(ParameterBounds, OfAMaxwellElementAreNeverBelow0) {
  engine::NetworkDescription network;
  engine::MaxwellLink link;
  link.stiffness = 7.0;
  link.viscosity = 0.25;
  expect(linear_bounds(network, link, reach_of_variables()).stiffness, 7.0, 7.0);

  engine::LinkState state = changing();
  state.stiffness = -3.0;
  test::Behaving machine;
  machine.state(state);
  network.state_machines = {machine.state_machine};
  link.state_machine = 0;
  const LinearBounds bounds = linear_bounds(network, link, reach_of_variables());
  expect(bounds.stiffness, 0.0, 1.0);
  expect(bounds.viscosity, 0.5, 3.5);
}

TEST(ParameterBounds, OfWhatIsStoredAreTheForceTimesTheElongation) {
  test::Behaving machine;
  engine::LinkState state = changing();
  machine.state(state);
  engine::LawPoint point{};
  point.distance = 1.5;
  point.elongation = -0.5;
  // 104 N/m at 0.5 m
  EXPECT_NEAR(max_stored_in(machine.state_machine, point, reach_of_variables()), 26.0, 1e-9);

  machine.state_machine.states[0].elasticity =
      expression_law(variable(1) * q(Quantity::kElongation));
  EXPECT_EQ(max_stored_in(machine.state_machine, point, reach_of_variables()), 0.0);
  machine.state_machine.states[0].elasticity = {};
  EXPECT_EQ(max_stored_in(machine.state_machine, point, reach_of_variables()),
            0.5 * 100.0 * 0.5 * 0.5);
}

TEST(ParameterBounds, AStateMachineIsFedByItsElasticityItsDepthAndItsRestAngleAlone) {
  test::Behaving machine;
  machine.state(100.0, 1.0);
  engine::LinkState& state = machine.state_machine.states[0];
  EXPECT_FALSE(is_fed(machine.state_machine));
  state.dissipation = expression_law(variable(0) * q(Quantity::kSpeed));
  EXPECT_FALSE(is_fed(machine.state_machine)) << "what only takes energy brings none in";
  for (const Parameter parameter : {Parameter::kStaticFriction, Parameter::kKineticFriction}) {
    state.formulas = {{parameter, variable(0).program}};
    EXPECT_FALSE(is_fed(machine.state_machine));
  }
  for (const Parameter parameter : {Parameter::kDepth, Parameter::kRestAngle}) {
    state.formulas = {{parameter, variable(0).program}};
    EXPECT_TRUE(is_fed(machine.state_machine));
  }
  state.formulas = {};
  state.elasticity = expression_law(variable(0) * q(Quantity::kElongation));
  EXPECT_TRUE(is_fed(machine.state_machine));
}

/// Asks for the speed of a MAT, which is at least 0, and for a share of what is awake, within 0 and 1.
engine::NetworkDescription asking_network(const engine::LinkState& state) {
  engine::NetworkDescription network;
  network.dimension = 2;
  network.step = 1e-3;
  network.mats = {test::mass(1.0, engine::Vec3::Zero())};
  network.variables.resize(2);
  network.variables[0].quantity = engine::VariableKind::kAwake;
  network.variables[1].quantity = engine::VariableKind::kSpeed;
  test::Behaving machine;
  machine.state(state);
  network.state_machines = {machine.state_machine};
  return network;
}

TEST(ParameterBounds, OfFrictionAreTheLargestThatItsFormulasGive) {
  engine::LinkState state;
  state.stiffness = 100.0;
  state.friction = engine::Friction{0.0, 0.0, 50.0, 1.0};
  state.formulas = {{Parameter::kStaticFriction, (Term(0.25) + Term(0.5) * variable(0)).program},
                    {Parameter::kKineticFriction, (Term(0.125) + Term(2.0) * variable(0)).program}};
  const engine::NetworkDescription network = asking_network(state);
  EXPECT_TRUE(has_formulas(network));

  const LargestParameters largest = largest_parameters(network);

  const engine::LinkState& found = largest.network.state_machines[0].states[0];
  ASSERT_TRUE(found.friction.has_value());
  EXPECT_EQ(found.friction->static_coefficient, 0.75);
  EXPECT_EQ(found.friction->kinetic_coefficient, 0.75) << "never above the static one";
  EXPECT_EQ(found.friction->stiffness, 50.0);
  EXPECT_EQ(found.formulas.size(), 2u) << "they stay";
  EXPECT_FALSE(largest.is_unbounded[0]);
}

TEST(ParameterBounds, WhatNothingBoundsIs0AndSaid) {
  engine::LinkState state;
  state.stiffness = 100.0;
  state.friction = engine::Friction{0.5, 0.25, 50.0, 1.0};
  state.formulas = {{Parameter::kStaticFriction, variable(1).program}};
  const LargestParameters largest = largest_parameters(asking_network(state));
  EXPECT_TRUE(largest.is_unbounded[0]);
  const engine::LinkState& found = largest.network.state_machines[0].states[0];
  EXPECT_EQ(found.friction->static_coefficient, 0.0);
  EXPECT_EQ(found.friction->kinetic_coefficient, 0.0);
}

TEST(ParameterBounds, OfADepthAreTheLargestAndNeverBelow0) {
  engine::LinkState state;
  state.elasticity = engine::LennardJones{0.0, 0.1};
  const auto depth = [&](const Term& formula) {
    state.formulas = {{Parameter::kDepth, formula.program}};
    const LargestParameters largest = largest_parameters(asking_network(state));
    return std::get<engine::LennardJones>(largest.network.state_machines[0].states[0].elasticity)
        .well_depth;
  };
  EXPECT_EQ(depth(Term(0.5) + Term(0.25) * variable(0)), 0.75);
  EXPECT_EQ(depth(Term(-0.5) - variable(0)), 0.0);
  state.formulas = {{Parameter::kRestAngle, variable(1).program}};
  state.elasticity = {};
  const LargestParameters of_angle = largest_parameters(asking_network(state));
  EXPECT_FALSE(of_angle.is_unbounded[0]) << "an angle is no coefficient";
  EXPECT_FALSE(of_angle.network.state_machines[0].states[0].friction.has_value());
}

}  // namespace
}  // namespace cordis::plan
