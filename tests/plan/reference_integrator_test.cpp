// tests/plan/reference_integrator_test.cpp
#include "sim_node/plan/reference/reference_integrator.h"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/engine/programs.h"
#include "tests/plan/networks.h"
#include "tests/support/reference_data.h"

namespace cordis::test {
namespace {

using plan::ReferenceIntegrator;

TEST(ReferenceIntegrator, FollowsADampedOscillationToTheLastDigits) {
  const double w = 20.0;
  const double s = 1.5;  // Z / 2m
  ReferenceIntegrator reference_integrator(oscillator(0.5, 0.5 * w * w, s, 1.0, 0.0, 1e-3));
  const double wd = std::sqrt(w * w - s * s);
  for (const double t : {0.1, 1.0, 3.0}) {
    reference_integrator.advance_to(t);
    const double exact = std::exp(-s * t) * (std::cos(wd * t) + s / wd * std::sin(wd * t));
    EXPECT_NEAR(reference_integrator.position(1).x(), exact, 1e-12);
  }
}

TEST(ReferenceIntegrator, FollowsATieInEveryDirection) {
  // Along x a damped oscillation from 1 m, along y one that begins at 20 m/s.
  const double w = 20.0;
  const double s = 1.5;  // Z / 2m
  NetworkDescription scene = oscillator(0.5, 0.5 * w * w, s, 1.0, 0.0, 1e-3);
  scene.dimension = 2;
  scene.mats[1].velocity = Vec3(0, 20, 0);
  scene.links[0].isotropic = true;
  ReferenceIntegrator reference_integrator(scene);
  const double wd = std::sqrt(w * w - s * s);

  reference_integrator.advance_to(1.0);

  const double fading = std::exp(-s);
  EXPECT_NEAR(reference_integrator.position(1).x(), fading * (std::cos(wd) + s / wd * std::sin(wd)),
              1e-12);
  EXPECT_NEAR(reference_integrator.position(1).y(), fading * 20.0 / wd * std::sin(wd), 1e-12);
}

TEST(ReferenceIntegrator, LetsFallWhatHasWeight) {
  NetworkDescription scene = oscillator(0.5, 200.0, 0.0, 0.0, 0.0, 1e-3);
  scene.gravity.x() = -9.81;
  scene.mats[1].weightless = true;
  scene.mats.push_back(mass(0.5, Vec3(1, 0, 0)));
  ReferenceIntegrator reference_integrator(scene);
  reference_integrator.advance_to(1.0);
  EXPECT_EQ(reference_integrator.position(1).x(), 0.0);
  EXPECT_NEAR(reference_integrator.position(2).x(), 1.0 - 0.5 * 9.81, 1e-12);
}

TEST(ReferenceIntegrator, FollowsTwoBodiesAsTheReferenceDoes) {
  const nlohmann::json problem = reference("R06_two_bodies");
  const auto value = [&](const char* name) { return number(problem["params"][name]); };
  NetworkDescription scene;
  scene.dimension = 1;
  scene.step = 1e-3;
  scene.mats = {mass(value("m1"), Vec3(value("x1"), 0, 0), Vec3(value("v1"), 0, 0)),
                mass(value("m2"), Vec3(value("x2"), 0, 0), Vec3(value("v2"), 0, 0))};
  scene.links = {{0, 1, value("k"), value("z"), value("L0")}};
  ReferenceIntegrator reference_integrator(scene);
  for (const auto& row : problem["t_x1_x2_v1_v2"]) {
    reference_integrator.advance_to(number(row[0]));
    EXPECT_NEAR(reference_integrator.position(0).x(), number(row[1]), 1e-12);
    EXPECT_NEAR(reference_integrator.position(1).x(), number(row[2]), 1e-12);
    EXPECT_NEAR(reference_integrator.velocity(0).x(), number(row[3]), 1e-12);
    EXPECT_NEAR(reference_integrator.velocity(1).x(), number(row[4]), 1e-12);
  }
}

TEST(ReferenceIntegrator, FollowsACubicSpringAsTheReferenceDoes) {
  const nlohmann::json problem = reference("R07_duffing");
  NetworkDescription scene = oscillator(1.0, 1.0, 0.0, 2.0, 0.0, 1e-2);
  scene.links.clear();
  scene.state_machines.push_back(state_machine(1.0, engine::Power{0.5, 3.0}));
  scene.state_links = {{0, 1, 0, 0.0}};
  ReferenceIntegrator reference_integrator(scene);
  for (const auto& row : problem["t_x"]) {
    reference_integrator.advance_to(number(row[0]));
    EXPECT_NEAR(reference_integrator.position(1).x(), number(row[1]), 1e-10);
  }
}

/// touches below 0: a spring-damper that may pull until x = 0 again, as in R14.
NetworkDescription bouncing_ball(const nlohmann::json& params) {
  const auto value = [&](const char* name) { return number(params[name]); };
  NetworkDescription scene;
  scene.dimension = 1;
  scene.step = 1e-3;
  scene.gravity = Vec3(-value("g"), 0, 0);
  scene.mats = {fixed(Vec3::Zero()), mass(value("m"), Vec3(value("h0"), 0, 0))};
  const Term height = q(Quantity::kDistance);
  scene.state_machines = {Behaving()
                              .state(0.0)
                              .exit(height < 0.0, 1)
                              .state(value("K"), value("Z"))
                              .exit(height > 0.0, 0)
                              .state_machine};
  scene.state_links = {{0, 1, 0, 0.0}};
  return scene;
}

TEST(ReferenceIntegrator, FindsTheMomentOfEveryImpact) {
  // The ball is above the ground just before each impact of the reference, in it just after; and
  // between two impacts it reaches its apex.
  const nlohmann::json problem = reference("R14_bouncing_ball");
  ReferenceIntegrator reference_integrator(bouncing_ball(problem["params"]));
  const double g = number(problem["params"]["g"]);
  for (std::size_t i = 0; i < problem["impact_times"].size(); ++i) {
    const double impact = number(problem["impact_times"][i]);
    reference_integrator.advance_to(impact - 1e-9);
    EXPECT_EQ(reference_integrator.state_of(0), 0u) << i;
    // Free since the last bounce: the apex it came from.
    const double apex = reference_integrator.position(1).x() +
                        std::pow(reference_integrator.velocity(1).x(), 2) / (2.0 * g);
    if (i > 0) {
      EXPECT_NEAR(apex, number(problem["apex_heights"][i - 1]), 1e-9) << i;
    }
    reference_integrator.advance_to(impact + 1e-9);
    EXPECT_EQ(reference_integrator.state_of(0), 1u) << i;
  }
  EXPECT_EQ(reference_integrator.state_changes(), 2 * problem["impact_times"].size() - 1);
}

TEST(ReferenceIntegrator, RelaxesAMaxwellElementAsTheClosedFormDoes) {
  // A mass so heavy that it moves steadily: F = Z v (1 - e^(-K t / Z)).
  NetworkDescription scene = oscillator(1e6, 0.0, 0.0, 1.0, 0.5, 1e-3);
  scene.links.clear();
  scene.maxwell_links = {{0, 1, 300.0, 20.0}};
  ReferenceIntegrator reference_integrator(scene);
  reference_integrator.advance_to(0.1);

  // The force has slowed the mass by its impulse: Z v (t - (Z/K) (1 - e^(-K t / Z))) / m.
  const double share = 1.0 - std::exp(-300.0 * 0.1 / 20.0);
  const double slowed = 20.0 * 0.5 * (0.1 - 20.0 / 300.0 * share) / 1e6;
  EXPECT_NEAR((0.5 - reference_integrator.velocity(1).x()) / slowed, 1.0, 1e-5);
}

TEST(ReferenceIntegrator, BeginsWithTheStartForceOfAMaxwellElement) {
  // At rest, F = F(0) e^(-K t / Z) on a mass so heavy that it hardly moves.
  NetworkDescription scene = oscillator(1e6, 0.0, 0.0, 1.0, 0.0, 1e-3);
  scene.links.clear();
  scene.maxwell_links = {{0, 1, 300.0, 20.0, 8.0}};
  ReferenceIntegrator reference_integrator(scene);
  reference_integrator.advance_to(0.1);

  const double impulse = 8.0 * 20.0 / 300.0 * (1.0 - std::exp(-300.0 * 0.1 / 20.0));
  EXPECT_NEAR(-reference_integrator.velocity(1).x() * 1e6 / impulse, 1.0, 1e-5);
}

/// Two balls fly apart after they have pushed each other, once by a state link, once as a set.
NetworkDescription colliding_balls(bool as_set) {
  NetworkDescription scene;
  scene.dimension = 2;
  scene.step = 1e-3;
  scene.mats = {mass(0.1, Vec3(0, 0, 0), Vec3(1, 0, 0)), mass(0.3, Vec3(0.1, 0.01, 0))};
  scene.radius = {0.02, 0.02};
  scene.state_machines = {contact(500.0)};
  if (as_set) {
    scene.sets.push_back({0, {0, 1}, {}, 0.04, -1.0});
  } else {
    scene.state_links = {{0, 1, 0, 0.04}};
  }
  return scene;
}

TEST(ReferenceIntegrator, ASetOfTwoIsALinkBetweenThem) {
  ReferenceIntegrator set(colliding_balls(true));
  ReferenceIntegrator link(colliding_balls(false));
  set.advance_to(0.3);
  link.advance_to(0.3);
  EXPECT_NEAR(set.velocity(1).x(), link.velocity(1).x(), 1e-10);
  EXPECT_GT(set.velocity(1).x(), 0.3);  // they have met
  EXPECT_NEAR(0.1 * set.velocity(0).x() + 0.3 * set.velocity(1).x(), 0.1, 1e-12);
  EXPECT_NEAR(0.1 * set.velocity(0).squaredNorm() + 0.3 * set.velocity(1).squaredNorm(), 0.1, 1e-9);
}

TEST(ReferenceIntegrator, HoldsForcesAndMovesPorts) {
  // A mass of 2 kg under 3 N; a spring of 8 N/m to a port that leaves at 0.5 m/s drags it along.
  NetworkDescription scene = oscillator(2.0, 0.0, 0.0, 0.0, 0.0, 1e-3);
  ReferenceIntegrator pushed(scene);
  pushed.hold_force(1, Vec3(3.0, 0, 0));
  pushed.advance_to(2.0);
  EXPECT_NEAR(pushed.position(1).x(), 0.5 * 3.0 / 2.0 * 4.0, 1e-11);

  scene.mats[0] = port(Vec3::Zero());
  scene.links[0].stiffness = 8.0;
  ReferenceIntegrator dragged(scene);
  dragged.set_velocity(0, Vec3(0.5, 0, 0));
  dragged.advance_to(3.0);
  EXPECT_NEAR(dragged.position(1).x(), 0.5 * (3.0 - std::sin(2.0 * 3.0) / 2.0), 1e-11);
}

TEST(ReferenceIntegrator, FindsTheMomentAtWhichAValueFalls) {
  // x = cos t from 1 downwards: |x| < 0.5 and falling first holds at t = pi / 3; for the speed of
  // the link, -sin t, |v| > 0.5 and rising first holds at pi / 6.
  const auto asked = [](engine::Quantity quantity, engine::Operation compare,
                        engine::Operation trend) {
    engine::Program program;
    const engine::Instruction value{engine::Operation::kQuantity, quantity, 0.0, 0};
    const engine::Instruction absolute{engine::Operation::kAbs, quantity, 0.0, 0};
    program.code = {value,
                    absolute,
                    {engine::Operation::kConstant, quantity, 0.5, 0},
                    {compare, quantity, 0.0, 0},
                    value,
                    absolute,
                    {trend, quantity, 0.0, 0},
                    {engine::Operation::kAnd, quantity, 0.0, 0}};
    return program;
  };
  const auto moment = [&](const engine::Program& when) {
    NetworkDescription scene = oscillator(1.0, 1.0, 0.0, 1.0, 0.0, 1e-2);
    engine::StateMachine watch;
    watch.states.resize(2);
    watch.states[0].last_exit = watch.states[1].first_exit = watch.states[1].last_exit = 1;
    watch.exits.resize(1);
    watch.exits[0].when = when;
    watch.exits[0].target = 1;
    scene.state_machines = {watch};
    scene.state_links = {{0, 1, 0, 0.0}};
    ReferenceIntegrator reference_integrator(scene);
    double time = 0.0;
    while (reference_integrator.state_of(0) == 0 && time < 3.0)
      reference_integrator.advance_to(time += 1e-3);
    return time;
  };
  using engine::Operation;
  using engine::Quantity;
  EXPECT_NEAR(moment(asked(Quantity::kDistance, Operation::kLess, Operation::kFalling)),
              std::acos(0.5), 1.5e-3);
  EXPECT_NEAR(moment(asked(Quantity::kSpeed, Operation::kGreater, Operation::kRising)),
              std::asin(0.5), 1.5e-3);
}

TEST(ReferenceIntegrator, RefusesWhatItDoesNotKnow) {
  NetworkDescription scene = oscillator(1.0, 1.0, 0.0, 1.0, 0.0, 1e-3);
  scene.state_machines.push_back(contact(1.0));
  scene.state_machines[0].exits.resize(1);
  scene.state_machines[0].exits[0].when.code = {
      {engine::Operation::kQuantity, engine::Quantity::kImpulse, 0.0, 0}};
  EXPECT_THROW(ReferenceIntegrator{scene}, std::invalid_argument);
}

}  // namespace
}  // namespace cordis::test
