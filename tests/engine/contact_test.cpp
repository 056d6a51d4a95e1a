// tests/engine/contact_test.cpp -- contacts that come and go, against their exact solutions.
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/engine/programs.h"
#include "tests/engine/scenes.h"
#include "tests/support/reference_data.h"

namespace cordis::test {
namespace {

/// Apart, no force; a spring-damper while the distance is below 0.
StateMachine contact(double stiffness, double viscosity, bool clamped) {
  LinkState touching;
  touching.stiffness = stiffness;
  touching.viscosity = viscosity;
  touching.pulls = !clamped;
  return Behaving()
      .state(0.0)
      .exit(q(Quantity::kElongation) < 0.0, 1)
      .state(touching)
      .exit(q(Quantity::kElongation) >= 0.0, 0)
      .state_machine;
}

/// A mass that comes to a wall at 0 with the speed of 1 m/s; 1 dimension.
NetworkDescription approach(StateMachine state_machine, double mass_kg, double step) {
  NetworkDescription scene;
  scene.dimension = 1;
  scene.step = step;
  // a third of a step before the wall in every resolution
  scene.mats = {fixed(Vec3::Zero()), mass(mass_kg, Vec3(7.3 * step, 0, 0), Vec3(-1, 0, 0))};
  scene.state_machines = {std::move(state_machine)};
  scene.state_links = {{0, 1, 0, 0.0}};
  return scene;
}

/// The speed with which it goes away.
double speed_after(World& world) {
  for (int n = 0; n < 10'000'000; ++n) {
    world.step();
    const bool away = world.velocity(1).x() > 0.0 && world.tension_of(0) == 0.0;
    if (away && world.position(1).x() > 0.0 && world.state_of(0) == 0) return world.velocity(1).x();
  }
  return 0.0;
}

class Restitution : public testing::TestWithParam<bool> {};

TEST_P(Restitution, IsThatOfTheExactSolution) {
  const bool clamped = GetParam();
  const nlohmann::json data = reference("R12_bounce_restitution");
  for (const auto& row : data["rows"]) {
    const double zeta = number(row[0]);
    const double expected = number(row[clamped ? 3 : 1]);
    if (expected == 0.0) continue;  // held back forever
    const auto error = [&](double step) {
      World world = make_world(approach(contact(1.0, 2.0 * zeta, clamped), 1.0, step));
      return std::abs(speed_after(world) - expected);
    };
    // first order in dt, with a factor that depends on where in a step it touches and leaves
    EXPECT_LT(error(1e-3), 4e-3 * (zeta + 0.1)) << "zeta = " << zeta;
    EXPECT_LT(error(1e-4), 4e-4 * (zeta + 0.1)) << "zeta = " << zeta;
  }
}

INSTANTIATE_TEST_SUITE_P(Clamped, Restitution, testing::Bool());

TEST(Contact, OfHertzGoesAsDeepAndLastsAsLongAsItMust) {
  const nlohmann::json data = reference("R13_hertz_bounce");
  LinkState touching;
  touching.elasticity = engine::Power{number(data["params"]["K"]), 1.5};
  touching.pulls = false;
  const double step = 1e-6;
  World world = make_world(
      approach(Behaving().state(touching).state_machine, number(data["params"]["m"]), step));
  double depth = 0.0;
  int steps_in_contact = 0;

  for (int n = 0; n < 20'000; ++n) {
    world.step();
    depth = std::max(depth, -world.position(1).x());
    steps_in_contact += world.position(1).x() < 0.0 ? 1 : 0;
  }

  EXPECT_NEAR(depth / number(data["d_max"]), 1.0, 1e-6);
  EXPECT_NEAR(steps_in_contact * step, number(data["t_c"]), 2.0 * step);
  EXPECT_NEAR(world.velocity(1).x(), 1.0, 1e-6);
}

TEST(Contact, OfABouncingBallKeepsItsHeightsAndTimes) {
  const nlohmann::json data = reference("R14_bouncing_ball");
  const auto& params = data["params"];
  for (const bool clamped : {false, true}) {
    const double step = 1e-5;
    NetworkDescription scene = approach(contact(number(params["K"]), number(params["Z"]), clamped),
                                        number(params["m"]), step);
    scene.gravity.x() = -number(params["g"]);
    scene.mats[1].position.x() = number(params["h0"]);
    scene.mats[1].velocity.x() = 0.0;
    World world = make_world(scene);
    std::vector<double> heights;
    std::vector<double> impacts;
    double highest = 0.0;

    while (heights.size() < 6) {
      world.step();
      highest = std::max(highest, world.position(1).x());
      if (world.events().empty()) continue;
      if (world.state_of(0) == 1) {
        impacts.push_back(static_cast<double>(world.step_count()) * step);
        if (impacts.size() > 1) heights.push_back(highest);
      }
      highest = 0.0;
    }

    for (std::size_t i = 0; i < 6; ++i) {
      const char* apex = clamped ? "apex_heights_clamped" : "apex_heights";
      const char* time = clamped ? "impact_times_clamped" : "impact_times";
      EXPECT_NEAR(heights[i] / number(data[apex][i]), 1.0, 2e-3) << "bounce " << i;
      EXPECT_NEAR(impacts[i], number(data[time][i]), 2e-3) << "bounce " << i;
    }
  }
}

TEST(Contact, OfTwoBallsKeepsTheirMomentumAndRestitution) {
  const nlohmann::json data = reference("R19_collisions")["case"];
  NetworkDescription scene;
  scene.dimension = 1;
  scene.step = 1e-6;
  scene.mats = {mass(number(data["m1"]), Vec3(-1.23e-5, 0, 0), Vec3(number(data["v1"]), 0, 0)),
                mass(number(data["m2"]), Vec3::Zero(), Vec3(number(data["v2"]), 0, 0))};
  scene.state_machines = {contact(number(data["K"]), number(data["Z"]), false)};
  scene.state_links = {{0, 1, 0, 0.0}};
  World world = make_world(scene);
  const double momentum = world.momentum().x();

  run(world, 20'000);

  EXPECT_EQ(world.change_count(0, 0, 1), 1U);
  EXPECT_EQ(world.change_count(0, 1, 0), 1U);
  EXPECT_NEAR(world.velocity(0).x(), number(data["v1p"]), 1e-4);
  EXPECT_NEAR(world.velocity(1).x(), number(data["v2p"]), 1e-4);
  EXPECT_NEAR(world.momentum().x(), momentum, 1e-11);  // rounding of positions / dt
}

TEST(Contact, ChangesTheEnergyOfABounceByTheFormulaOfItsPhases) {
  // undamped, K' = K dt^2 / m: e^2 = (1 - K' phi (1 - phi)) / (1 - K' psi (1 - psi)), phi and psi
  // the fractions of a step at which the line of flight crosses the wall on the way in and out
  const double k = 0.81;
  NetworkDescription scene = approach(contact(k, 0.0, false), 1.0, 1.0);
  scene.mats[1].velocity.x() = -1.0;
  for (const double start : {5.0, 5.2, 5.4, 5.55, 5.7, 5.9}) {
    scene.mats[1].position.x() = start;
    World world = make_world(scene);
    std::vector<double> path{start};
    const double v = speed_after(world);
    world = make_world(scene);
    while (world.velocity(1).x() < 0.0 || path.back() < 0.0) {
      world.step();
      path.push_back(world.position(1).x());
    }
    const double phi = std::ceil(start) - start;
    const double psi = path.back() / v;

    EXPECT_NEAR(v * v, (1.0 - k * phi * (1.0 - phi)) / (1.0 - k * psi * (1.0 - psi)), 1e-12);
    world.step();  // in which it lets go
    const engine::Energy energy = world.energy();
    EXPECT_EQ(world.state_of(0), 0U);
    EXPECT_NEAR(energy.kinetic, energy.initial + energy.switching, 1e-14)
        << "and the account says where it came from";
  }
}

}  // namespace
}  // namespace cordis::test
