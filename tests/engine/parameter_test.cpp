// tests/engine/parameter_test.cpp -- laws whose parameters change.
#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "tests/engine/programs.h"
#include "tests/engine/scenes.h"
#include "tests/support/allocation_guard.h"

namespace cordis::test {
namespace {

using engine::Energy;
using engine::IntegratorKind;
using engine::Variable;
using engine::VariableKind;

constexpr std::uint32_t kTimeSlot = 0;
constexpr std::uint32_t kPlaceSlot = 1;

Term variable(std::uint32_t slot) {
  Term term(0.0);
  term.program.code = {{Operation::kVariable, Quantity::kDistance, 0.0, slot}};
  return term;
}

/// Asks for the time, and for the x of MAT 1.
std::vector<Variable> time_and_place() {
  Variable time;
  time.quantity = VariableKind::kTime;
  Variable place;
  place.quantity = VariableKind::kPosition;
  place.index = 1;
  place.direction = Vec3::UnitX();
  return {time, place};
}

StateMachine elastic(const Term& tension) {
  StateMachine machine;
  machine.states.emplace_back();
  machine.states[0].elasticity = engine::Expression{tension.program};
  return machine;
}

/// A mass of 1 kg at x0 with the speed v0, on a spring to a fixed point whose stiffness is a term.
NetworkDescription led_by(const Term& stiffness, double x0, double v0, double step) {
  NetworkDescription scene = oscillator(1.0, 0.0, 0.0, x0, v0, step);
  scene.links.clear();
  scene.variables = time_and_place();
  scene.state_machines = {elastic(stiffness * q(Quantity::kElongation))};
  scene.state_links = {{0, 1, 0, 0.0}};
  return scene;
}

int steps_in(double seconds, double step) {
  return static_cast<int>(std::lround(seconds / step));
}

TEST(Parameter, OfTimeFollowsTheAiryFunction) {
  // x'' + (1 + t) x = 0 has the solution Ai(-(1 + t)). [Abramowitz and Stegun, table 10.11]
  constexpr double kPeriod = 1e-3;
  World world = make_world(
      led_by(Term(1.0) + variable(kTimeSlot), 0.535560883292352, 0.0101605671166452, kPeriod));

  run(world, steps_in(4.0, kPeriod));
  EXPECT_NEAR(world.position(1).x(), 0.350761009024114, 2e-6);  // Ai(-5)
  run(world, steps_in(5.0, kPeriod));
  EXPECT_NEAR(world.position(1).x(), 0.0402412384864432, 8e-6);  // Ai(-10); of order step^2
}

/// x'' + (1 + 0.2 cos 2t) x = 0: pumped at twice its natural frequency.
Term pump() {
  return Term(1.0) + Term(0.2) * one(Operation::kCos, Term(2.0) * variable(kTimeSlot));
}

TEST(Parameter, PumpedAtTwiceTheFrequencyGrowsAsMathieuHasIt) {
  // The Floquet exponent of Mathieu's equation, to second order in the depth 0.2, is 0.2 / 4. [Nayfeh and Mook 1979]
  constexpr double kPeriod = 2e-3;
  World world = make_world(led_by(pump(), 1.0, 0.0, kPeriod));
  run(world, steps_in(60.0, kPeriod));
  const double early = world.energy().total();
  run(world, steps_in(40.0, kPeriod));
  const double late = world.energy().total();

  EXPECT_NEAR(std::log(late / early) / (2.0 * 40.0), 0.05, 0.002);
}

/// What the account of a scene leaves over after some time, over the largest energy in it.
double relative_error_of(NetworkDescription scene, double seconds, Energy* last = nullptr) {
  World world = make_world(std::move(scene));
  double largest = 0.0;
  double error = 0.0;
  const int steps = steps_in(seconds, world.network().step());
  for (int n = 0; n < steps; ++n) {
    world.step();
    const Energy energy = world.energy();
    largest = std::max(largest, energy.largest);
    error = std::max(error, std::abs(energy.integration_error()));
  }
  if (last != nullptr) *last = world.energy();
  return error / largest;
}

class ChangingParameter : public testing::TestWithParam<IntegratorKind> {};

TEST_P(ChangingParameter, LeavesAnErrorOfSecondOrderInTheAccount) {
  const auto error_at = [&](double step) {
    NetworkDescription scene = led_by(pump(), 1.0, 0.0, step);
    scene.integrator = GetParam();
    return relative_error_of(std::move(scene), 30.0);
  };
  const double coarse = error_at(0.02);
  const double fine = error_at(0.01);

  EXPECT_LT(fine, 2e-4);
  EXPECT_NEAR(coarse / fine, 4.0, 0.8);
}

TEST_P(ChangingParameter, DoesTheWorkThatTheMotionGains) {
  NetworkDescription scene = led_by(pump(), 1.0, 0.0, 0.005);
  scene.integrator = GetParam();
  Energy last;
  EXPECT_LT(relative_error_of(std::move(scene), 60.0, &last), 1e-4);

  EXPECT_GT(last.total(), 50.0 * last.initial);
  EXPECT_NEAR(last.switching, last.total() - last.initial, 1e-3 * last.total());
  EXPECT_EQ(last.dissipated, 0.0);
}

INSTANTIATE_TEST_SUITE_P(Integrators, ChangingParameter,
                         testing::Values(IntegratorKind::kCordis, IntegratorKind::kLeapfrog));

TEST(Parameter, OfAVariableIsAnotherPotentialOfThePlace) {
  // K = 10 + 40 x of the mass itself: the force 10 x + 40 x^2 has the potential 5 x^2 + 40/3 x^3.
  constexpr double kPeriod = 1e-4;
  World world =
      make_world(led_by(Term(10.0) + Term(40.0) * variable(kPlaceSlot), 0.1, 0.0, kPeriod));
  const auto potential = [](double x) { return 5.0 * x * x + 40.0 / 3.0 * x * x * x; };

  for (int n = 0; n < 20000; ++n) {
    world.step();
    const double x =
        0.5 * (world.position(1).x() + world.position(1).x() - kPeriod * world.velocity(1).x());
    const double v = world.velocity(1).x();
    ASSERT_NEAR(0.5 * v * v + potential(x), potential(0.1), 1e-7) << n;  // of order step^2
  }
  EXPECT_LT(std::abs(world.energy().integration_error()), 1e-7);
}

TEST(Parameter, OfAForceOverTheSpeedIsDissipated) {
  // x'' + t x' = 0 has the speed exp(-t^2 / 2).
  constexpr double kPeriod = 1e-4;
  NetworkDescription scene = led_by(Term(0.0), 0.0, 1.0, kPeriod);
  scene.state_machines[0].states[0].elasticity = engine::NoLaw{};
  scene.state_machines[0].states[0].dissipation =
      engine::Expression{(variable(kTimeSlot) * q(Quantity::kSpeed)).program};
  World world = make_world(std::move(scene));
  run(world, steps_in(1.5, kPeriod));

  const double speed = world.velocity(1).x();
  EXPECT_NEAR(speed, std::exp(-0.5 * 1.5 * 1.5),
              2e-4);  // of order step: the viscosity is that of x(n) - x(n-1)
  const Energy energy = world.energy();
  EXPECT_NEAR(energy.dissipated, 0.5 - 0.5 * speed * speed, 1e-4);
  EXPECT_EQ(energy.switching, 0.0);
}

/// Masses in 3 dimensions that are joined all around, by a law of time, place, distance and speed.
NetworkDescription pulsing_cluster() {
  NetworkDescription scene = free_cluster(20, 61, 0.0);
  scene.variables = time_and_place();
  const Term pulse =
      Term(40.0) + Term(30.0) * one(Operation::kSin, Term(50.0) * variable(kTimeSlot));
  const Term rest = Term(0.1) + Term(0.2) * variable(kPlaceSlot);
  scene.state_machines = {
      elastic(pulse * (q(Quantity::kDistance) - rest)),
      elastic(pulse * q(Quantity::kElongation) * one(Operation::kExp, q(Quantity::kDistance)))};
  scene.state_machines[1].states[0].dissipation = engine::Expression{
      (one(Operation::kAbs, variable(kPlaceSlot)) * q(Quantity::kSpeed)).program};
  std::uint32_t machine = 0;
  for (const Link& link : scene.links) {
    scene.state_links.push_back({link.mat_a, link.mat_b, machine++ % 2, link.rest_length});
  }
  scene.links.clear();
  return scene;
}

TEST(Parameter, StepsToTheSameBitsOnEveryWidth) {
  World narrow = make_world(pulsing_cluster(), VectorWidth::kSse2);
  run(narrow, 500);
  const Energy of_narrow = narrow.energy();
  for (const VectorWidth width : engine::supported_vector_widths()) {
    World world = make_world(pulsing_cluster(), width);
    run(world, 500);
    EXPECT_EQ(world.state_hash(), narrow.state_hash()) << to_string(width);
    EXPECT_EQ(world.energy().switching, of_narrow.switching) << to_string(width);
  }
}

TEST(Parameter, ComesBackWithASnapshot) {
  World world = make_world(pulsing_cluster());
  run(world, 300);
  const engine::Snapshot snapshot = world.snapshot();
  const Energy then = world.energy();
  run(world, 200);

  World other = make_world(pulsing_cluster());
  other.restore(snapshot);
  EXPECT_EQ(other.energy().elastic_error, then.elastic_error);
  run(other, 200);
  EXPECT_EQ(other.state_hash(), world.state_hash());
  EXPECT_EQ(other.energy().switching, world.energy().switching);
  EXPECT_EQ(other.energy().total(), world.energy().total());
}

TEST(Parameter, StepsWithoutAllocating) {
  World world = make_world(pulsing_cluster());
  run(world, 2);
  const AllocationGuard guard;
  run(world, 10);
  EXPECT_EQ(guard.count(), 0u);
}

TEST(Parameter, AsksForNoVariableThatIsNotThere) {
  NetworkDescription scene = pulsing_cluster();
  scene.variables.pop_back();
  EXPECT_THROW(make_world(scene), std::invalid_argument);
}

TEST(Parameter, KeepsTheMassesOfItsLinksAwake) {
  NetworkDescription scene = led_by(Term(0.0) * variable(kTimeSlot) + Term(100.0), 0.0, 0.0, 1e-3);
  scene.freeze_tolerance = 1e-3;
  World world = make_world(std::move(scene));
  run(world, 5000);
  EXPECT_EQ(world.asleep_count(), 0u);
}

}  // namespace
}  // namespace cordis::test
