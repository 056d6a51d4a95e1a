// tests/plan/start_tangent_test.cpp
#include "sim_node/plan/stability/start_tangent.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "sim_node/plan/stability/step_bound.h"
#include "tests/engine/programs.h"
#include "tests/plan/networks.h"

namespace cordis::test {
namespace {

using plan::StartTangent;

class RandomNetwork : public testing::TestWithParam<unsigned> {};

TEST_P(RandomNetwork, DivergesWhereItsLimitSaysToWithinHalfAPercent) {
  NetworkDescription scene = random_network(GetParam());
  const double limit = StartTangent(scene).diverging_step();

  scene.step = 0.995 * limit;
  EXPECT_LT(largest_excursion(scene, 4000), 1e3);
  // Past the limit an eigenvalue below -1 grows; 0.5 % beyond it that is at least 1e-3 a step.
  scene.step = 1.005 * limit;
  EXPECT_GT(largest_excursion(scene, 60000), 1e6);
}

INSTANTIATE_TEST_SUITE_P(Forty, RandomNetwork, testing::Range(0u, 40u));

TEST(StartTangent, IsExactForAChainBetweenFixedEnds) {
  // w_j^2 = 4 K / m sin^2(j pi / 2 (N + 1)); stable while w dt < 2.
  NetworkDescription scene = string_in_space(20, 0.0, 1e-4);
  scene.dimension = 1;
  for (Mat& mat : scene.mats) mat.position.y() = 0.0;
  const double limit = std::sqrt(0.001 / 400.0) / std::sin(20.0 * M_PI / 42.0);

  EXPECT_NEAR(StartTangent(scene).diverging_step(), limit, 1e-6 * limit);
}

TEST(StartTangent, TakesThePoseOfASceneInSpaceAsItIs) {
  // One mass on two springs at a right angle: each pulls along its own direction, K alone decides,
  // while the graph, which knows no pose, adds the two.
  NetworkDescription scene;
  scene.dimension = 3;
  scene.step = 1e-3;
  scene.mats = {fixed(Vec3(1, 0, 0)), fixed(Vec3(0, 1, 0)), mass(0.1, Vec3::Zero())};
  scene.links = {{0, 2, 1000.0, 0.0, 1.0}, {1, 2, 1000.0, 0.0, 1.0}};

  EXPECT_NEAR(StartTangent(scene).diverging_step(), 2.0 * std::sqrt(0.1 / 1000.0), 1e-8);
  EXPECT_NEAR(plan::certified_bound(scene, plan::liaison_graph(scene)).step,
              2.0 * std::sqrt(0.1 / 2000.0), 1e-8);
}

TEST(StartTangent, KnowsTheLimitOfAMassOnAMaxwellElement) {
  // Z' tanh(K' / 2 Z') < 2, by bisection
  NetworkDescription scene = oscillator(0.1, 0.0, 0.0, 1.0, 0.0, 1e-3);
  scene.links.clear();
  scene.maxwell_links = {{0, 1, 4000.0, 3.0}};
  double low = 0.0;
  double high = 1.0;
  for (int n = 0; n < 60; ++n) {
    const double h = 0.5 * (low + high);
    (3.0 * h / 0.1 * std::tanh(4000.0 * h / 6.0) < 2.0 ? low : high) = h;
  }

  EXPECT_NEAR(StartTangent(scene).diverging_step(), low, 1e-6 * low);
  EXPECT_NEAR(plan::certified_bound(scene, plan::liaison_graph(scene)).step, low, 1e-3 * low);
}

TEST(StartTangent, IsNotSureWhereFrictionThatIsSolvedHoldsTheStart) {
  // A root of the speed is steeper than any number at rest. `leapfrog` solves it, so that it sticks there.
  NetworkDescription scene = oscillator(0.1, 1000.0, 0.0, 1.0, 0.0, 1e-3);
  scene.state_machines = {state_machine(0.0)};
  scene.state_machines[0].states[0].dissipation = engine::Power{0.1, 0.5};
  scene.state_links = {{0, 1, 0, 0.0}};
  EXPECT_NEAR(StartTangent(scene).diverging_step(), 0.02, 1e-6);

  scene.integrator = engine::IntegratorKind::kLeapfrog;
  EXPECT_TRUE(std::isinf(StartTangent(scene).diverging_step()));

  // One that only pushes and just touches sticks on one side.
  scene.state_machines[0].states[0].stiffness = 10.0;
  scene.state_machines[0].states[0].pulls = false;
  const double distance = scene.mats[1].position.x() - scene.mats[0].position.x();
  scene.state_links[0].rest_length = distance;
  EXPECT_TRUE(std::isinf(StartTangent(scene).diverging_step()));

  scene.state_links[0].rest_length = 0.9 * distance;  // it is away
  EXPECT_NEAR(StartTangent(scene).diverging_step(), 0.02, 1e-6);

  scene.state_machines[0] = state_machine(0.0);
  scene.state_machines[0].states[0].dissipation = engine::Power{-0.1, 0.5};  // it drives
  EXPECT_NEAR(StartTangent(scene).diverging_step(), 0.02, 1e-6);
}

TEST(StartTangent, KnowsThatATieTakesEveryDirectionAlike) {
  NetworkDescription line = random_network(3);
  NetworkDescription space = line;
  space.dimension = 3;
  for (Link& link : space.links) link.isotropic = true;
  const double limit = StartTangent(line).diverging_step();

  EXPECT_NEAR(StartTangent(space).diverging_step(), limit, 1e-3 * limit);
  EXPECT_EQ(plan::certified_bound(space, plan::liaison_graph(space)).step,
            plan::certified_bound(line, plan::liaison_graph(line)).step);
}

/// A mass on a spring and a damper, and on a liaison of one state beside them.
NetworkDescription mass_on_two(double stiffness, double viscosity, const engine::LinkState& state) {
  NetworkDescription scene = oscillator(0.03, stiffness, viscosity, 1e-3, 0.0, 1e-3);
  scene.state_machines.emplace_back();
  scene.state_machines[0].states = {state};
  scene.state_links = {{0, 1, 0, 0.0}};
  return scene;
}

TEST(StartTangent, CountsTheFallOfALaw) {
  engine::LinkState falling;
  falling.elasticity = engine::Table({-1.0, 1.0}, {40.0, -40.0});
  const NetworkDescription scene = mass_on_two(100.0, 0.0, falling);

  const double limit = 2.0 * std::sqrt(0.03 / 60.0);
  EXPECT_NEAR(StartTangent(scene).diverging_step(), limit, 1e-4 * limit);
}

TEST(StartTangent, IsNotSureOfWhatImplicitSpringsHold) {
  // 4 m + dt^2 (K - 28) + 2 dt (Z - 1.6) is above 0 for every step.
  engine::LinkState damped;
  damped.stiffness = 28.0;
  damped.viscosity = 1.6;
  NetworkDescription scene = mass_on_two(220.0, 1.2, damped);
  scene.integrator = engine::IntegratorKind::kImplicit;

  EXPECT_EQ(StartTangent(scene).diverging_step(), std::numeric_limits<double>::infinity());
  scene.step = 0.16;
  EXPECT_LT(largest_excursion(scene, 4000), 1.0);
  scene.links[0].stiffness = 0.0;
  const double sure = StartTangent(scene).diverging_step();
  ASSERT_LT(sure, 1.0);
  scene.step = 1.02 * sure;
  EXPECT_GT(largest_excursion(scene, 4000), 1e6);
}

/// What drives the motion, beside what else the state has.
engine::LinkState driving(double viscosity) {
  engine::LinkState state;
  state.dissipation = expression_law(-viscosity * q(engine::Quantity::kSpeed));
  return state;
}

TEST(StartTangent, IsNotSureOfWhatALawDrivesBesideImplicitDampers) {
  NetworkDescription scene = mass_on_two(93.0, 1.5, {});
  scene.mats[1].mass = 0.0028;
  scene.integrator = engine::IntegratorKind::kLeapfrog;
  scene.step = 0.015;
  const double damped = StartTangent(scene).diverging_step();
  scene.step = 1.25 * damped;
  EXPECT_GT(largest_excursion(scene, 4000), 1e6);

  scene.state_machines[0].states = {driving(0.14)};
  EXPECT_LT(largest_excursion(scene, 4000), 1.0) << "the driving law holds it";
  EXPECT_TRUE(std::isinf(StartTangent(scene).diverging_step()));
  scene.mats.push_back(mass(0.0028, Vec3(2, 0, 0)));  // as if the first mass were held
  scene.links.push_back({1, 2, 1000.0, 1.5, 1.0});
  EXPECT_LT(StartTangent(scene).diverging_step(), scene.step);
}

/// One mass on a spring or a damper among many that a law drives away: nearly every direction falls.
NetworkDescription one_among_many(double stiffness, double viscosity,
                                  const engine::LinkState& drives) {
  NetworkDescription scene;
  scene.dimension = 1;
  scene.step = 1e-3;
  scene.mats = {fixed(Vec3::Zero()), mass(1.0, Vec3(1, 0, 0))};
  scene.links = {{0, 1, stiffness, viscosity, 1.0}};
  scene.state_machines.emplace_back();
  scene.state_machines[0].states = {drives};
  for (std::uint32_t i = 2; i < 40; ++i) {
    scene.mats.push_back(mass(1.0, Vec3(1, 0, 0)));
    scene.state_links.push_back({0, i, 0, 1.0});
  }
  return scene;
}

TEST(StartTangent, FindsTheOneDirectionThatIsStiff) {
  engine::LinkState falling;
  falling.elasticity = engine::Table({-1.0, 0.0, 1.0}, {400.0, 0.0, -400.0});
  const double stiff = 0.2;  // dt^2 100 = 4
  EXPECT_NEAR(StartTangent(one_among_many(100.0, 0.0, falling)).diverging_step(), stiff, 1e-6);
  const double viscous = 0.2;  // 2 dt 10 = 4
  EXPECT_NEAR(StartTangent(one_among_many(0.0, 10.0, driving(40.0))).diverging_step(), viscous,
              1e-6);
  EXPECT_TRUE(std::isinf(StartTangent(one_among_many(0.0, 0.0, falling)).diverging_step()));
}

TEST(StartTangent, CountsTheFallOfALawThatJustTouches) {
  engine::LinkState falling;
  falling.elasticity = engine::Table({-1.0, 0.0, 1.0}, {40.0, 0.0, 3.0});
  falling.pushes = false;
  NetworkDescription scene = mass_on_two(100.0, 0.0, falling);
  scene.state_links[0].rest_length = scene.mats[1].position.x();
  const double limit = 2.0 * std::sqrt(0.03 / 60.0);
  EXPECT_NEAR(StartTangent(scene).diverging_step(), limit, 1e-4 * limit);

  scene.state_machines[0].states = {driving(0.5)};
  scene.state_machines[0].states[0].pulls = false;
  const double driven = plan::limit_step(100.0 / 0.03, -0.5 / 0.03);
  EXPECT_NEAR(StartTangent(scene).diverging_step(), driven, 1e-4 * driven);
}

TEST(StartTangent, CountsThatCompressedImplicitLinksGiveWayAcross) {
  // Two links of 0.5 N/m are pressed from 6.1 m to 0.1 m: each takes 0.5 * 6 / 0.1 = 30 N/m from 100 N/m.
  NetworkDescription scene;
  scene.dimension = 2;
  scene.step = 1e-3;
  scene.integrator = engine::IntegratorKind::kImplicit;
  scene.mats = {fixed(Vec3(-1, 0, 0)), fixed(Vec3(0, -0.1, 0)), fixed(Vec3(0, 0.1, 0)),
                mass(0.03, Vec3(1e-6, 0, 0))};
  scene.links = {{1, 3, 0.5, 0.0, 6.1}, {2, 3, 0.5, 0.0, 6.1}};
  scene.state_machines = {state_machine(100.0)};
  scene.state_links = {{0, 3, 0, 1.0}};
  const auto grows_by = [](const NetworkDescription& network) {
    World world = make_world(network);
    double largest = 0.0;
    for (int n = 0; n < 4000; ++n) {
      world.step();
      largest = std::max(largest, std::abs(world.position(3).x()));
    }
    return largest / 1e-6;
  };

  const double limit = 2.0 * std::sqrt(0.03 / 40.0);
  const double sure = StartTangent(scene).diverging_step();
  EXPECT_NEAR(sure, limit, 1e-6 * limit);
  scene.step = 0.98 * limit;
  EXPECT_LT(grows_by(scene), 10.0);
  scene.step = 1.02 * limit;
  EXPECT_GT(grows_by(scene), 1e3);
}

/// Adds the pair of two MATs as a set, with the first state machine.
void add_pair(NetworkDescription& scene, std::uint32_t p, std::uint32_t q, double range,
              double rest_length) {
  engine::SetLiaison set;
  set.set_p = {p};
  set.set_q = {q};
  set.range = range;
  set.rest_length = rest_length;
  scene.sets.push_back(set);
}

TEST(StartTangent, IsNotSureOfAPairWhoseViscosityActsAlone) {
  // Within range and touched by no force: a set that only pushes lets go in every other step.
  NetworkDescription scene;
  scene.dimension = 1;
  scene.step = 1e-3;
  scene.mats = {fixed(Vec3::Zero()), mass(0.1, Vec3::UnitX())};
  scene.radius = {0.0, 0.0};
  engine::LinkState state;
  state.viscosity = 1.0;
  state.pulls = false;
  scene.state_machines.emplace_back();
  scene.state_machines[0].states = {state};
  add_pair(scene, 0, 1, 2.0, 0.0);

  EXPECT_TRUE(std::isinf(StartTangent(scene).diverging_step()));
  scene.state_machines[0].states[0].pulls = true;
  EXPECT_NEAR(StartTangent(scene).diverging_step(), 0.2, 1e-9);  // 2 Z dt / m = 4
}

TEST(StartTangent, KnowsTheMassesOfExpressions) {
  // 1000 (0.04 - m) e on a mass of 0.03 kg: 10 N/m, while no mass would have 40.
  engine::LinkState state;
  state.elasticity = expression_law(1000.0 * (0.04 - q(engine::Quantity::kMassB)) *
                                    q(engine::Quantity::kElongation));
  const NetworkDescription link = mass_on_two(0.0, 0.0, state);
  const double limit = 2.0 * std::sqrt(0.03 / 10.0);
  EXPECT_NEAR(StartTangent(link).diverging_step(), limit, 1e-4 * limit);

  NetworkDescription pair = link;
  pair.state_links.clear();
  pair.radius = {0.0, 0.0};
  add_pair(pair, 0, 1, 10.0, 0.0);
  EXPECT_NEAR(StartTangent(pair).diverging_step(), limit, 1e-4 * limit);
}

TEST(StartTangent, KnowsThatAPairPressedToItsLimitGivesWayAcross) {
  // A spring of 100 N/m along x, and along y a pair that pushes with 4 N over 0.1 m: 60 N/m along x.
  NetworkDescription scene;
  scene.dimension = 2;
  scene.step = 1e-3;
  scene.mats = {fixed(Vec3(-1, 0, 0)), fixed(Vec3(0, -0.1, 0)), mass(0.03, Vec3::Zero())};
  scene.links = {{0, 2, 100.0, 0.0, 1.0}};
  engine::LinkState state;
  state.stiffness = 1000.0;
  state.force_limit = 4.0;
  scene.state_machines.emplace_back();
  scene.state_machines[0].states = {state};
  add_pair(scene, 1, 2, 0.3, 0.2);

  const double limit = 2.0 * std::sqrt(0.03 / 60.0);
  EXPECT_NEAR(StartTangent(scene).diverging_step(), limit, 1e-6 * limit);
}

TEST(StartTangent, TakesAPowerAtItsRestForFlat) {
  engine::LinkState power;
  power.elasticity = engine::Power{.coefficient = 5800.0, .exponent = 1.5};
  NetworkDescription scene = mass_on_two(60.0, 0.0, power);
  scene.state_links[0].rest_length = scene.mats[1].position.x() - scene.mats[0].position.x();

  const double limit = 2.0 * std::sqrt(0.03 / 60.0);
  EXPECT_NEAR(StartTangent(scene).diverging_step(), limit, 1e-2 * limit);
}

TEST(StartTangent, CountsTheFallOfARootAndNotItsRise) {
  engine::LinkState root;
  root.elasticity = engine::Power{.coefficient = -6.0, .exponent = 0.5};
  NetworkDescription scene = mass_on_two(60.0, 0.0, root);
  const double distance = scene.mats[1].position.x() - scene.mats[0].position.x();
  scene.state_links[0].rest_length = distance - 0.01;  // it falls by 3 / sqrt(0.01) = 30 N/m there
  const double limit = 2.0 * std::sqrt(0.03 / 30.0);
  EXPECT_NEAR(StartTangent(scene).diverging_step(), limit, 1e-3 * limit);

  scene.state_machines[0].states[0].elasticity = engine::Power{.coefficient = 6.0, .exponent = 0.5};
  const double of_spring = 2.0 * std::sqrt(0.03 / 60.0);
  EXPECT_NEAR(StartTangent(scene).diverging_step(), of_spring, 1e-3 * of_spring);
}

/// A ball that 200 N press along a line against a contact of 1000 N/m, which begins to push at 1 m: it is in balance
/// at 0.8 m. A spring of 2000 N/m across that line holds it.
NetworkDescription pressed_ball(const Vec3& touched, const Vec3& outwards) {
  const Vec3 across(outwards.y(), -outwards.x(), 0);
  const Vec3 place = touched + 0.8 * outwards;
  NetworkDescription scene;
  scene.dimension = 2;
  scene.step = 1e-3;
  scene.mats = {fixed(Vec3::Zero()), mass(0.03, place), fixed(place + 100.0 * across),
                fixed(place - 100.0 * outwards)};
  scene.links = {{1, 2, 2000.0, 0.0, 100.0},
                 {1, 3, 10.0, 0.0, 80.0}};  // 200 N at 100 m: 2 N/m across
  scene.surfaces.emplace_back();
  scene.surfaces[0].kind = engine::SurfaceKind::kBox;
  scene.surfaces[0].half_size = Vec3(0.1, 0.1, std::numeric_limits<double>::infinity());
  scene.state_machines = {contact(1000.0)};
  add_pair(scene, 0, 1, 1.0, 1.0);
  return scene;
}

/// The largest way of that ball across, in 2000 steps from 1 um beside its place, over that 1 um.
double growth_across(NetworkDescription scene, double step) {
  constexpr double kAside = 1e-6;
  const Vec3 place = scene.mats[1].position;
  const Vec3 across = (scene.mats[2].position - place).normalized();
  scene.step = step;
  scene.mats[1].position += kAside * across;
  World world = make_world(scene);
  double largest = 0.0;
  for (int n = 0; n < 2000; ++n) {
    world.step();
    largest = std::max(largest, std::abs((world.position(1) - place).dot(across)));
  }
  return largest / kAside;
}

TEST(StartTangent, KnowsThatABallPressedAgainstACornerGivesWayAcross) {
  const double diagonal = 1.0 / std::sqrt(2.0);
  // About a corner 200 N take 200 / 0.8 N/m, on a face nothing.
  const NetworkDescription at_corner = pressed_ball(Vec3(0.1, 0.1, 0), Vec3(diagonal, diagonal, 0));
  const double of_corner = 2.0 * std::sqrt(0.03 / 1752.0);
  EXPECT_NEAR(StartTangent(at_corner).diverging_step(), of_corner, 1e-6 * of_corner);
  EXPECT_LT(growth_across(at_corner, 0.98 * of_corner), 10.0);
  EXPECT_GT(growth_across(at_corner, 1.02 * of_corner), 1e3);

  const NetworkDescription at_face = pressed_ball(Vec3(0.1, 0, 0), Vec3::UnitX());
  const double of_face = 2.0 * std::sqrt(0.03 / 2002.0);
  EXPECT_GE(StartTangent(at_face).diverging_step(), of_face) << "not sure too soon";
  EXPECT_LT(growth_across(at_face, 0.98 * of_face), 10.0);
}

TEST(StartTangent, NeverEndsWhereNothingPulls) {
  NetworkDescription scene = oscillator(1.0, 0.0, 0.0, 1.0, 0.0, 1.0);

  EXPECT_TRUE(std::isinf(StartTangent(scene).diverging_step()));
}

}  // namespace
}  // namespace cordis::test
