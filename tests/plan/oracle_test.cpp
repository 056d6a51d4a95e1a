#include "sim_node/plan/oracle.h"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/engine/reference_data.h"
#include "tests/plan/networks.h"

namespace cordis::test {
namespace {

using plan::Oracle;

TEST(Oracle, FollowsADampedOscillationToTheLastDigits) {
  const double w = 20.0;
  const double s = 1.5;  // Z / 2m
  Oracle oracle(oscillator(0.5, 0.5 * w * w, s, 1.0, 0.0, 1e-3));
  const double wd = std::sqrt(w * w - s * s);
  for (const double t : {0.1, 1.0, 3.0}) {
    oracle.advance_to(t);
    const double exact = std::exp(-s * t) * (std::cos(wd * t) + s / wd * std::sin(wd * t));
    EXPECT_NEAR(oracle.position(1).x(), exact, 1e-12);
  }
}

TEST(Oracle, FollowsTwoBodiesAsTheReferenceDoes) {
  const nlohmann::json problem = reference("R06_two_bodies");
  const auto value = [&](const char* name) { return number(problem["params"][name]); };
  NetworkDescription scene;
  scene.dimension = 1;
  scene.step = 1e-3;
  scene.mats = {mass(value("m1"), Vec3(value("x1"), 0, 0), Vec3(value("v1"), 0, 0)),
                mass(value("m2"), Vec3(value("x2"), 0, 0), Vec3(value("v2"), 0, 0))};
  scene.links = {{0, 1, value("k"), value("z"), value("L0")}};
  Oracle oracle(scene);
  for (const auto& row : problem["t_x1_x2_v1_v2"]) {
    oracle.advance_to(number(row[0]));
    EXPECT_NEAR(oracle.position(0).x(), number(row[1]), 1e-12);
    EXPECT_NEAR(oracle.position(1).x(), number(row[2]), 1e-12);
    EXPECT_NEAR(oracle.velocity(0).x(), number(row[3]), 1e-12);
    EXPECT_NEAR(oracle.velocity(1).x(), number(row[4]), 1e-12);
  }
}

TEST(Oracle, FollowsACubicSpringAsTheReferenceDoes) {
  const nlohmann::json problem = reference("R07_duffing");
  NetworkDescription scene = oscillator(1.0, 1.0, 0.0, 2.0, 0.0, 1e-2);
  engine::Law cubic;
  cubic.kind = engine::Law::Kind::kPower;
  cubic.coefficient = 0.5;
  cubic.exponent = 3.0;
  scene.links.clear();
  scene.behaviours.push_back(behaviour(1.0, cubic));
  scene.state_links = {{0, 1, 0, 0.0}};
  Oracle oracle(scene);
  for (const auto& row : problem["t_x"]) {
    oracle.advance_to(number(row[0]));
    EXPECT_NEAR(oracle.position(1).x(), number(row[1]), 1e-10);
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
  engine::Behaviour ground;
  ground.states.resize(2);
  ground.states[1].stiffness = value("K");
  ground.states[1].viscosity = value("Z");
  const auto compare = [](engine::Operation operation) {
    engine::Program program;
    program.code = {{engine::Operation::kQuantity, engine::Quantity::kDistance, 0.0, 0},
                    {engine::Operation::kConstant, engine::Quantity::kDistance, 0.0, 0},
                    {operation, engine::Quantity::kDistance, 0.0, 0}};
    return program;
  };
  ground.exits.resize(2);
  ground.exits[0].when = compare(engine::Operation::kLess);
  ground.exits[0].target = 1;
  ground.exits[1].when = compare(engine::Operation::kGreater);
  ground.exits[1].target = 0;
  ground.states[0].first_exit = 0;
  ground.states[0].last_exit = 1;
  ground.states[1].first_exit = 1;
  ground.states[1].last_exit = 2;
  scene.behaviours = {ground};
  scene.state_links = {{0, 1, 0, 0.0}};
  return scene;
}

TEST(Oracle, FindsTheMomentOfEveryImpact) {
  // The ball is above the ground just before each impact of the reference, in it just after; and
  // between two impacts it reaches its apex.
  const nlohmann::json problem = reference("R14_bouncing_ball");
  Oracle oracle(bouncing_ball(problem["params"]));
  const double g = number(problem["params"]["g"]);
  for (std::size_t i = 0; i < problem["impact_times"].size(); ++i) {
    const double impact = number(problem["impact_times"][i]);
    oracle.advance_to(impact - 1e-9);
    EXPECT_EQ(oracle.state_of(0), 0u) << i;
    // Free since the last bounce: the apex it came from.
    const double apex = oracle.position(1).x() + std::pow(oracle.velocity(1).x(), 2) / (2.0 * g);
    if (i > 0) {
      EXPECT_NEAR(apex, number(problem["apex_heights"][i - 1]), 1e-9) << i;
    }
    oracle.advance_to(impact + 1e-9);
    EXPECT_EQ(oracle.state_of(0), 1u) << i;
  }
  EXPECT_EQ(oracle.state_changes(), 2 * problem["impact_times"].size() - 1);
}

TEST(Oracle, RelaxesAMaxwellElementAsTheClosedFormDoes) {
  // A mass so heavy that it moves steadily: F = Z v (1 - e^(-K t / Z)).
  NetworkDescription scene = oscillator(1e6, 0.0, 0.0, 1.0, 0.5, 1e-3);
  scene.links.clear();
  scene.maxwell_links = {{0, 1, 300.0, 20.0}};
  Oracle oracle(scene);
  oracle.advance_to(0.1);

  // The force has slowed the mass by its impulse: Z v (t - (Z/K) (1 - e^(-K t / Z))) / m.
  const double share = 1.0 - std::exp(-300.0 * 0.1 / 20.0);
  const double slowed = 20.0 * 0.5 * (0.1 - 20.0 / 300.0 * share) / 1e6;
  EXPECT_NEAR((0.5 - oracle.velocity(1).x()) / slowed, 1.0, 1e-5);
}

TEST(Oracle, RefusesWhatItDoesNotKnow) {
  NetworkDescription scene = oscillator(1.0, 1.0, 0.0, 1.0, 0.0, 1e-3);
  scene.behaviours.push_back(contact(1.0));
  scene.sets.push_back({0, {1}, {}, 1.0, 0.5});
  EXPECT_THROW(Oracle{scene}, std::invalid_argument);
}

}  // namespace
}  // namespace cordis::test
