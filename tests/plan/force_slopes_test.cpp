// tests/plan/force_slopes_test.cpp -- what the plan makes of forces by place and velocity.
#include "sim_node/plan/stability/force_slopes.h"

#include <cmath>
#include <cstdint>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "sim_node/plan/plan.h"
#include "sim_node/plan/reference/reference_integrator.h"
#include "sim_node/plan/settle.h"
#include "tests/engine/programs.h"
#include "tests/engine/scenes.h"
#include "tests/support/test_seed.h"

namespace cordis::test {
namespace {

using engine::IntegratorKind;
using engine::TimeFunction;

Term coordinate(std::size_t axis) {
  return q(engine::kPlaceInForce[axis]);
}
Term rate(std::size_t axis) {
  return q(engine::kVelocityInForce[axis]);
}
Term seconds() {
  return q(Quantity::kAge);
}
Term asked(std::uint32_t number) {
  Term term(0.0);
  term.program.code = {{Operation::kVariable, Quantity::kDistance, 0.0, number}};
  return term;
}
Term quotient(Term u, const Term& v) {
  return two(Operation::kDivide, std::move(u), v);
}

/// A mass of 0.5 kg under a force along x and one along y; variables are its position and its state of time.
NetworkDescription under(const Term& x, const Term& y,
                         IntegratorKind integrator = IntegratorKind::kCordis) {
  NetworkDescription scene;
  scene.dimension = 2;
  scene.step = 1e-4;
  scene.integrator = integrator;
  scene.mats = {mass(0.5, Vec3(0.3, 0.2, 0))};
  engine::Variable position;
  position.quantity = engine::VariableKind::kPosition;
  position.direction = Vec3::UnitX();
  engine::Variable changes;
  changes.quantity = engine::VariableKind::kChanges;
  scene.variables = {position, changes};
  TimeFunction function;
  function.formula = {x.program, y.program, {}};
  scene.time_functions = {function};
  scene.drives = {{0, 0, true}};
  return scene;
}

plan::ForceSlopes slopes(const Term& x, const Term& y) {
  const NetworkDescription scene = under(x, y);
  return plan::SlopesOfForces(scene).of(scene.time_functions[0]);
}

TEST(ForceSlopes, OfAWellAreItsStiffness) {
  const plan::ForceSlopes found =
      slopes(Term(-5.0) * coordinate(0) - Term(0.25) * rate(0), Term(-3.0) * coordinate(1));
  EXPECT_EQ(found.uncertainty, "");
  EXPECT_DOUBLE_EQ(found.stiffness, 5.0);
  EXPECT_DOUBLE_EQ(found.viscosity, 0.25);
  EXPECT_DOUBLE_EQ(found.variation, 0.0);
  EXPECT_TRUE(found.brings_energy);
}

TEST(ForceSlopes, OfASoftenedCentreAreThoseAtItsMiddle) {
  // K(r) falls from 2 / e^3 along r, e = 0.1, to -0.54 of that where r^2 = 3/2 e^2.
  const Term square = coordinate(0) * coordinate(0) + coordinate(1) * coordinate(1) + Term(0.01);
  const Term cube = square * one(Operation::kSqrt, square);
  const plan::ForceSlopes found = slopes(quotient(Term(-2.0) * coordinate(0), cube),
                                         quotient(Term(-2.0) * coordinate(1), cube));
  EXPECT_EQ(found.uncertainty, "");
  EXPECT_GE(found.stiffness, 2000.0);
  EXPECT_LT(found.stiffness, 4000.0);
  EXPECT_GT(found.variation, 2000.0);
}

TEST(ForceSlopes, WithoutABoundAreNamed) {
  const Term square = coordinate(0) * coordinate(0) + coordinate(1) * coordinate(1);
  const Term cube = square * one(Operation::kSqrt, square);
  const auto uncertainty = [](const Term& x, const Term& y) { return slopes(x, y).uncertainty; };
  EXPECT_EQ(uncertainty(quotient(Term(-1.0) * coordinate(0), cube),
                        quotient(Term(-1.0) * coordinate(1), cube)),
            "no largest slope over all places and velocities is known");
  EXPECT_EQ(uncertainty(Term(-1.0) * coordinate(0) * coordinate(0) * coordinate(0), Term(0.0)),
            "no largest slope over all places and velocities is known");
  EXPECT_EQ(uncertainty((Term(0.0) - rate(0)) * (Term(0.1) + seconds()), Term(0.0)),
            "it asks for time_s, which nothing bounds");
  EXPECT_EQ(uncertainty((Term(0.0) - rate(0)) * asked(0), Term(0.0)),
            "it asks for a signal or a quantity, which nothing bounds");
  EXPECT_EQ(uncertainty((Term(0.0) - rate(0)) * (asked(1) + seconds()), Term(0.0)),
            "it asks for time_s and a signal or a quantity, which nothing bounds");
  EXPECT_EQ(uncertainty(Term(0.0) - coordinate(1), coordinate(0)),
            "it does work on closed ways, and nothing bounds the energy of that");
  EXPECT_EQ(uncertainty(Term(3.0) * coordinate(0), Term(0.0)),
            "it drives its MAT away ever harder");
  EXPECT_EQ(uncertainty(Term(0.2) * rate(0), Term(0.0)),
            "it may drive what moves, and nothing bounds the energy of that");
  EXPECT_EQ(uncertainty(Term(-9.0) * asked(0), Term(0.0)),
            "it asks for what masses move, and nothing bounds what that brings in");
}

TEST(ForceSlopes, OfAForceThatStepsAreNotCertain) {
  const Term x = coordinate(0);
  const Term y = coordinate(1);
  const Term apart = (x - 0.3) * (x - 0.3) + (y - 0.2) * (y - 0.2);
  for (const Term& force : {
           three(Operation::kSelect, x > 0.005, Term(-2e5) * x, 0.0),
           three(Operation::kSelect, apart < 1e-4, Term(-2e5) * x, 0.0),
           Term(-5.0) * x * three(Operation::kSelect, y > 1.0, 1.0, 2.0),
           Term(-5.0) * x - rate(0) * three(Operation::kSelect, rate(0) > 0.1, 1.0, 2.0),
           Term(-2e5) * x + Term(0.0) * one(Operation::kSqrt, x - 0.005),
           Term(-2e5) * x + Term(0.0) * one(Operation::kSqrt, y - 0.005),
           Term(-2e5) * x + Term(0.0) * one(Operation::kLog, x - 0.005),
           Term(-2e5) * x + Term(0.0) * one(Operation::kExp, Term(1e7) * (x - 0.004)),
       }) {
    EXPECT_EQ(slopes(force, Term(0.0)).uncertainty, "its force jumps");
  }
}

TEST(ForceSlopes, OfAForceThatTimeOrASignalChoosesAreTheLarger) {
  const Term late = seconds() > 1.0;
  const Term on = asked(1) > 3.0;
  for (const Term& choice : {late, on}) {
    const plan::ForceSlopes found = slopes(
        three(Operation::kSelect, choice, -2.0, -1.0) * coordinate(0), Term(-1.0) * coordinate(1));
    EXPECT_EQ(found.uncertainty, "");
    EXPECT_DOUBLE_EQ(found.stiffness, 2.0);
    EXPECT_DOUBLE_EQ(found.variation, 1.0);
  }
  const plan::ForceSlopes medium =
      slopes(three(Operation::kSelect, late, -0.01, -0.0005) * rate(0), Term(0.0));
  EXPECT_EQ(medium.uncertainty, "");
  EXPECT_DOUBLE_EQ(medium.viscosity, 0.01);
}

/// A wall that begins without a step, and a part that is finite everywhere.
TEST(ForceSlopes, OfWhatMeetsAreCertain) {
  const Term x = coordinate(0);
  const Term y = coordinate(1);
  for (const Term& force : {
           three(Operation::kSelect, x > 0.1, Term(-5.0) * (x - 0.1), 0.0),
           Term(-5.0) * x + Term(0.0) * one(Operation::kSqrt, x * x + y * y + 0.001),
       }) {
    const plan::ForceSlopes found = slopes(force, Term(-1.0) * y);
    EXPECT_EQ(found.uncertainty, "");
    EXPECT_DOUBLE_EQ(found.stiffness, 5.0);
  }
}

TEST(ForceSlopes, NameTheVariablesThatNothingBounds) {
  using Numbers = std::vector<std::uint32_t>;
  const auto variables = [](const Term& x, const Term& y) { return slopes(x, y).variables; };
  const Term clamped = two(Operation::kMin, two(Operation::kMax, asked(0), Term(0.0)), Term(1.0));
  EXPECT_EQ(variables((Term(0.0) - rate(0)) * asked(1), Term(0.0)), (Numbers{1}));
  EXPECT_EQ(variables((Term(0.0) - rate(0)) * clamped, (Term(0.0) - rate(1)) * asked(1)),
            (Numbers{1}))
      << "the other one is clamped";
  EXPECT_EQ(variables((Term(0.0) - rate(0)) * asked(1) * asked(0), Term(0.0)), (Numbers{1, 0}));
  EXPECT_EQ(variables(Term(-9.0) * asked(1) - asked(0), Term(0.0)), (Numbers{0}))
      << "the state of time moves with no mass";
  EXPECT_EQ(variables((Term(0.0) - rate(0)) * seconds(), Term(0.0)), (Numbers{}));

  NetworkDescription scene = under((Term(0.0) - rate(0)) * asked(1), Term(0.0));
  const plan::Stability stability = plan::stability_of(scene, plan::liaison_graph(scene));
  ASSERT_TRUE(stability.uncertainty);
  EXPECT_EQ(stability.uncertainty->variables, (Numbers{1}));
}

/// What is found once for equal formulas is that of the formula and of what its own variables lie within.
TEST(ForceSlopes, OfFunctionsThatAreNearlyAlikeAreTheirOwn) {
  NetworkDescription scene = under(Term(-5.0) * coordinate(0), Term(-3.0) * coordinate(1));
  scene.mats.push_back(fixed(Vec3(2, 0, 0)));
  scene.mats.push_back(fixed(Vec3(7, 0, 0)));
  for (const std::uint32_t mat : {1U, 2U, 0U}) {
    scene.variables.push_back(scene.variables[0]);
    scene.variables.back().index = mat;
  }
  const auto add = [&scene](const Term& x, const Term& y) {
    TimeFunction function;
    function.formula = {x.program, y.program, {}};
    scene.time_functions.push_back(function);
  };
  add(Term(-5.0) * coordinate(0), Term(-4.0) * coordinate(1));
  add(Term(-6.0) * coordinate(0), Term(-3.0) * coordinate(1));
  add(Term(-6.0) * coordinate(1), Term(-3.0) * coordinate(0));
  add((Term(0.0) - asked(2)) * coordinate(0), Term(0.0));
  add((Term(0.0) - asked(3)) * coordinate(0), Term(0.0));
  add((Term(0.0) - asked(4)) * coordinate(0), Term(0.0));
  add((Term(0.0) - asked(0)) * coordinate(0), Term(0.0));
  add((Term(0.0) - asked(3)) * coordinate(0), Term(0.0));
  plan::SlopesOfForces together(scene);
  std::vector<double> stiffness;
  for (const TimeFunction& function : scene.time_functions) {
    const plan::ForceSlopes found = together.of(function);
    const plan::ForceSlopes alone = plan::SlopesOfForces(scene).of(function);
    EXPECT_EQ(found.stiffness, alone.stiffness);
    EXPECT_EQ(found.variables, alone.variables);
    EXPECT_EQ(found.uncertainty, alone.uncertainty);
    stiffness.push_back(found.stiffness);
  }
  EXPECT_EQ(stiffness, (std::vector<double>{5, 5, 6, 6, 2, 7, 0, 0, 7}));
  EXPECT_EQ(together.of(scene.time_functions[6]).variables, std::vector<std::uint32_t>{4});
  EXPECT_EQ(together.of(scene.time_functions[7]).variables, std::vector<std::uint32_t>{0});
}

TEST(ForceSlopes, OfWhatIsBoundedAreCertain) {
  const Term clamped = two(Operation::kMax, Term(0.0), two(Operation::kMin, asked(0), Term(1.0)));
  const Term wave = Term(2.0) + one(Operation::kSin, seconds());
  const plan::ForceSlopes drag =
      slopes((Term(0.0) - rate(0)) * (Term(0.1) + clamped), (Term(0.0) - rate(1)) * Term(0.2));
  EXPECT_EQ(drag.uncertainty, "");
  EXPECT_DOUBLE_EQ(drag.viscosity, 1.1);
  EXPECT_FALSE(drag.brings_energy);
  const plan::ForceSlopes pumped = slopes((Term(0.0) - coordinate(0)) * wave, Term(0.0));
  EXPECT_EQ(pumped.uncertainty, "");
  EXPECT_DOUBLE_EQ(pumped.stiffness, 3.0);
  EXPECT_EQ(slopes(Term(-9.0) * asked(1), Term(0.0)).uncertainty, "");
  NetworkDescription led = under(Term(-9.0) * asked(0), Term(0.0));
  led.mats.push_back(port(Vec3(1, 0, 0)));
  led.variables[0].index = 1;  // what is led from outside
  EXPECT_EQ(plan::SlopesOfForces(led).of(led.time_functions[0]).uncertainty, "");
}

TEST(ForceSlopes, LimitTheStepAsASpringToTheGround) {
  for (const auto integrator : {IntegratorKind::kCordis, IntegratorKind::kLeapfrog}) {
    SCOPED_TRACE(to_string(integrator));
    NetworkDescription scene =
        under(Term(-200.0) * coordinate(0) - Term(0.5) * rate(0),
              Term(-200.0) * coordinate(1) - Term(0.5) * rate(1), integrator);
    const plan::Stability stability = plan::stability_of(scene, plan::liaison_graph(scene));
    ASSERT_FALSE(stability.uncertainty);
    ASSERT_TRUE(stability.certified.liaison);
    EXPECT_EQ(stability.certified.liaison->kind, engine::LiaisonKind::kForce);
    // 4 M - dt^2 K - w dt Z = 0 with w = 2 or 4
    const double damping = (integrator == IntegratorKind::kLeapfrog ? 4.0 : 2.0) * 0.5;
    const double exact = (std::sqrt(damping * damping + 16.0 * 0.5 * 200.0) - damping) / 400.0;
    EXPECT_NEAR(stability.certified.step, exact, 1e-9);
    scene.step = 0.98 * exact;
    EXPECT_LT(largest_excursion(scene, 20'000), 3.0);
    scene.step = 1.02 * exact;
    EXPECT_GT(largest_excursion(scene, 20'000), 1e6);
  }
}

TEST(ForceSlopes, JoinThoseOfLinksAtTheMass) {
  NetworkDescription scene = under(Term(-200.0) * coordinate(0), Term(-200.0) * coordinate(1));
  scene.mats.push_back(fixed(Vec3(0, 0.2, 0)));
  scene.links = {{1, 0, 100.0, 0.0, 0.3}};
  const plan::Stability stability = plan::stability_of(scene, plan::liaison_graph(scene));
  EXPECT_FALSE(stability.uncertainty);
  EXPECT_NEAR(stability.certified.step, 2.0 * std::sqrt(0.5 / 300.0), 1e-9);
}

TEST(ForceSlopes, OfRandomWellsKeepANetBounded) {
  std::mt19937 random(test_seed());
  std::uniform_real_distribution<double> share(0.0, 1.0);
  for (int scene_number = 0; scene_number < 60; ++scene_number) {
    SCOPED_TRACE(scene_number);
    const double along_x = 400.0 * share(random);
    const double along_y = 400.0 * share(random);
    const double across = 0.9 * std::sqrt(along_x * along_y) * (2.0 * share(random) - 1.0);
    const double drag = scene_number % 2 == 0 ? 0.0 : 0.5 * share(random);
    NetworkDescription scene =
        under(Term(-along_x) * coordinate(0) - Term(across) * coordinate(1) - Term(drag) * rate(0),
              Term(-across) * coordinate(0) - Term(along_y) * coordinate(1) - Term(drag) * rate(1),
              scene_number % 3 == 0 ? IntegratorKind::kLeapfrog : IntegratorKind::kCordis);
    for (std::uint32_t i = 1; i < 5; ++i) {
      scene.mats.push_back(mass(0.05 + share(random), Vec3(share(random), share(random), 0)));
      const double length = (scene.mats[i].position - scene.mats[i - 1].position).norm();
      scene.links.push_back({i - 1, i, 200.0 * share(random), 0.1 * share(random), 0.9 * length});
      if (share(random) < 0.7) scene.drives.push_back({i, 0, true});
    }
    const plan::Stability stability = plan::stability_of(scene, plan::liaison_graph(scene));
    ASSERT_FALSE(stability.uncertainty) << stability.uncertainty->why;
    scene.step = 0.98 * stability.certified.step;
    EXPECT_LT(largest_excursion(scene, 5000), 50.0);
  }
}

TEST(ForceSlopes, LeaveNoLawToAnEnergyThatNothingBounds) {
  NetworkDescription scene = under(Term(-2.0) * coordinate(0), Term(-2.0) * coordinate(1));
  scene.mats.push_back(fixed(Vec3(0, 0.2, 0)));
  StateMachine cubic;
  cubic.states.resize(1);
  cubic.states[0].elasticity = engine::Power{5e4, 1.5};
  scene.state_machines = {cubic};
  scene.state_links = {{1, 0, 0, 0.3}};
  const plan::Stability stability = plan::stability_of(scene, plan::liaison_graph(scene));
  ASSERT_TRUE(stability.uncertainty);
  EXPECT_EQ(stability.uncertainty->liaison.kind, engine::LiaisonKind::kForce);
  scene.drives.clear();
  EXPECT_FALSE(plan::stability_of(scene, plan::liaison_graph(scene)).uncertainty);
}

/// A spring of K' = 5 alone diverges; a force that pushes away leaves K' = 3 of it.
TEST(ForceSlopes, MakeNothingSurelyUnstable) {
  for (const double apart : {0.0, 1.0}) {  // share of the push
    NetworkDescription scene =
        under(Term(apart * 2e6) * coordinate(0), Term(apart * 2e6) * coordinate(1));
    scene.step = 1e-3;
    scene.mats[0].mass = 1.0;
    scene.mats[0].position = Vec3(0.001, 0, 0);
    scene.mats.push_back(fixed(Vec3::Zero()));
    scene.links = {{1, 0, 5e6, 0.0, 0.0}};
    if (apart == 0.0) scene.drives.clear();
    EXPECT_EQ(plan::stability_of(scene, plan::liaison_graph(scene)).diverges(), apart == 0.0);
    EXPECT_EQ(largest_excursion(scene, 2000) > 1.0, apart == 0.0);
  }
}

TEST(ForceSlopes, TheReferenceIntegratorFollowsTheEllipse) {
  const double w = std::sqrt(5.0 / 0.5);
  NetworkDescription scene = under(Term(-5.0) * coordinate(0), Term(-5.0) * coordinate(1));
  scene.mats[0].velocity = Vec3(0, 2, 0);
  plan::ReferenceIntegrator reference(scene);
  reference.advance_to(2.0);
  EXPECT_NEAR(reference.position(0).x(), 0.3 * std::cos(2.0 * w), 1e-12);
  EXPECT_NEAR(reference.position(0).y(), 0.2 * std::cos(2.0 * w) + 2.0 / w * std::sin(2.0 * w),
              1e-12);
  scene.time_functions[0].formula[0] = (seconds() * coordinate(0)).program;
  EXPECT_THROW(plan::ReferenceIntegrator{scene}, std::invalid_argument);
}

TEST(ForceSlopes, SettlesInAWell) {
  // Weight and well are at rest where K (y - 0.5) = -m g; the drag is left out.
  NetworkDescription scene =
      under(Term(-20.0) * coordinate(0) - rate(0), Term(-20.0) * (coordinate(1) - Term(0.5)));
  scene.gravity = Vec3(0, -10, 0);
  ASSERT_FALSE(plan::rest_is_open(scene));
  const plan::Settled rest = plan::settle(scene, {1e-9, 200'000});
  EXPECT_LT(rest.force, 1e-9);
  EXPECT_LT((rest.position[0] - Vec3(0, 0.5 - 0.5 * 10 / 20.0, 0)).norm(), 1e-9);
  scene.time_functions[0].formula[0] = asked(0).program;
  EXPECT_TRUE(plan::rest_is_open(scene));
}

}  // namespace
}  // namespace cordis::test
