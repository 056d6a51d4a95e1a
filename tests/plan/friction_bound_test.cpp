// tests/plan/friction_bound_test.cpp -- the step that is certified for contacts that rub.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "sim_node/plan/plan.h"
#include "sim_node/plan/stability/liaison_graph.h"
#include "sim_node/plan/stability/step_bound.h"
#include "tests/engine/programs.h"
#include "tests/engine/surfaces.h"
#include "tests/support/rounds.h"

namespace cordis::test {
namespace {

using engine::Energy;
using engine::Friction;

StateMachine rubbing(double stiffness, double viscosity, const Friction& friction) {
  StateMachine state_machine = of_one_state(contact(stiffness, viscosity));
  state_machine.friction = friction;
  return state_machine;
}

TEST(FrictionBound, CountsTheStifferDirectionAndWhatFollowsThePush) {
  NetworkDescription scene;
  scene.dimension = 2;
  scene.step = 1e-5;
  scene.mats = {mass(0.2, Vec3(0.0, 0.049, 0.0))};
  scene.radius = {0.05};
  const std::uint32_t floor = add_surface(scene, plane(Vec3::UnitY()), Vec3::Zero());
  touch(scene, 1, rubbing(2000.0, 0.0, {0.5, 0.5, 500.0, 0.0}), 0.05, -1.0, {floor});
  const auto bound = [&] { return plan::certified_bound(scene, plan::liaison_graph(scene)).step; };
  EXPECT_NEAR(bound(), 2.0 * std::sqrt(0.2 / 3000.0), 1e-12);
  scene.state_machines[0].friction.stiffness = 7000.0;
  EXPECT_NEAR(bound(), 2.0 * std::sqrt(0.2 / 8000.0), 1e-12);
  scene.state_machines[0].friction = {};
  EXPECT_NEAR(bound(), 2.0 * std::sqrt(0.2 / 2000.0), 1e-12);
  engine::LinkState gripping = contact(2000.0, 0.0);
  gripping.friction = Friction{0.25, 0.1, 9500.0, 0.0};
  scene.state_machines[0].states.push_back(gripping);
  EXPECT_NEAR(bound(), 2.0 * std::sqrt(0.2 / 10000.0), 1e-12);
}

/// Random numbers of a seed.
struct Chance {
  explicit Chance(unsigned seed) : random(seed) {}
  double operator()(double low, double high) {
    return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
  }
  double decades(double low, double high) { return low * std::pow(high / low, (*this)(0.0, 1.0)); }

  std::mt19937 random;
};

/// Gives every liaison a second state of another friction, or of none, that begins and ends by slip.
void add_gripping_state(NetworkDescription& scene, Chance chance) {
  for (StateMachine& state_machine : scene.state_machines) {
    engine::LinkState second = state_machine.states[0];
    const double most = chance.decades(0.05, 1.5);
    second.friction = chance(0.0, 1.0) < 0.25
                          ? Friction{}
                          : Friction{most, most * chance(0.0, 1.0),
                                     state_machine.friction.stiffness * chance.decades(0.1, 10.0),
                                     chance.decades(0.1, 30.0)};
    const Friction first = state_machine.friction;
    state_machine = Behaving()
                        .state(state_machine.states[0])
                        .exit(q(engine::Quantity::kSlid) > chance.decades(1e-5, 1e-3), 1)
                        .state(second)
                        .exit(q(engine::Quantity::kSlip) < chance.decades(0.01, 0.3), 0)
                        .state_machine;
    state_machine.friction = first;
  }
}

/// Balls thrown into a corner, which rub at each other and at two planes.
NetworkDescription thrown_balls(Chance& chance, int dimension) {
  NetworkDescription scene;
  scene.dimension = dimension;
  const auto count = static_cast<std::uint32_t>(chance(1.0, 7.0));
  for (std::uint32_t i = 0; i < count; ++i) {
    Mat ball = mass(chance(0.5, 2.0), Vec3::Zero());
    for (int axis = 0; axis < dimension; ++axis) {
      ball.position[axis] = chance(0.0, 0.3);
      ball.velocity[axis] = chance(-1.0, 0.5);
    }
    scene.mats.push_back(ball);
    scene.radius.push_back(0.05);
  }
  const double stiffness = chance.decades(500.0, 50000.0);
  const double viscosity = chance(0.0, 1.0) < 0.5 ? 0.0 : chance.decades(0.1, 30.0);
  const double most = chance.decades(0.05, 1.5);
  const double kinetic = chance(0.0, 1.0) < 0.2 ? 0.0 : most * chance(0.3, 1.0);
  const Friction friction{most, kinetic, stiffness * chance.decades(0.1, 10.0),
                          chance(0.0, 1.0) < 0.5 ? 0.0 : chance.decades(0.1, 30.0)};
  std::vector<std::uint32_t> planes;
  for (int axis = 0; axis < 2; ++axis)
    planes.push_back(add_surface(scene, plane(Vec3::Unit(axis)), -0.05 * Vec3::Unit(axis)));
  touch(scene, count, rubbing(stiffness, viscosity, friction), 0.05, -1.0, planes);
  SetLiaison within;
  within.state_machine = 0;
  within.range = 0.1;
  within.rest_length = -1.0;
  for (std::uint32_t i = 0; i < count; ++i) within.set_p.push_back(i);
  if (count > 1) scene.sets.push_back(within);
  return scene;
}

/// The longest step whose plan is certain, to a tenth.
void take_certain_step(NetworkDescription& scene) {
  scene.step = 1e-5;
  scene.step = 0.99 * plan::plan_of(scene, 10.0).stability.certified.step;
  while (plan::plan_of(scene, 10.0).stability.uncertainty) scene.step *= 0.9;
}

TEST(FrictionBound, LetsNoContactGainEnergy) {
  for (unsigned seed = 1; seed <= 200; seed += kSeedStride) {
    Chance chance(seed);
    NetworkDescription scene = thrown_balls(chance, 2 + static_cast<int>(seed % 2));
    if (seed > 120) add_gripping_state(scene, chance);
    take_certain_step(scene);
    World world = make_world(scene);
    double most = 0.0;
    for (int n = 0; n < 5000; ++n) {
      world.step();
      const Energy energy = world.energy();
      ASSERT_NEAR(energy.residual(), 0.0, 1e-11 * energy.largest) << seed;
      most = std::max(most, energy.kinetic + energy.elastic);
    }
    const Energy end = world.energy();
    // The products of the account swing by K' / 4 of what is exchanged, at most.
    EXPECT_LT(most, 1.3 * end.initial) << seed;
    EXPECT_LT(end.kinetic + end.elastic, 1.02 * end.initial) << seed;
  }
}

/// A ball on a floor in weight, pushed along it by a force that stays, and shaken along the normal.
struct Shaken {
  Friction friction;
  double stiffness;
  double viscosity;
  double shake;  // of the weight
  double push;   // of static times the weight at its least
};

TEST(FrictionBound, LetsNothingCreepOrChatterThatIsHeld) {
  for (unsigned seed = 1; seed <= 8; seed += kSeedStride) {
    Chance chance(seed);
    const double stiffness = chance.decades(1e3, 1e5);
    const double most = chance(0.1, 1.2);
    const Friction friction{most, most * chance(0.4, 1.0), stiffness * chance.decades(0.1, 10.0),
                            chance.decades(1.0, 20.0)};
    const double shake = chance(0.0, 0.5);
    const double push = 0.95 * most * (1.0 - shake) * 9.81;
    NetworkDescription scene;
    scene.dimension = 3;
    scene.mats = {mass(1.0, Vec3(0.0, 0.05 - 9.81 / stiffness, 0.0))};
    scene.radius = {0.05};
    const std::uint32_t floor = add_surface(scene, plane(Vec3::UnitY()), Vec3::Zero());
    touch(scene, 1, rubbing(stiffness, 0.05 * std::sqrt(stiffness), friction), 0.05, -1.0, {floor});
    take_certain_step(scene);
    World world = make_world(scene);
    const int settle = static_cast<int>(20.0 / (friction.viscosity * scene.step));
    // Slow enough that the ball follows the force, and the load never falls below what was counted.
    const double slow = 0.02 * std::sqrt(std::min(stiffness, friction.stiffness));
    const auto step = [&](int n) {
      const double load =
          9.81 * (1.0 + shake * std::sin(slow * n * scene.step) * std::min(1.0, 2.0 * n / settle));
      const double along = push * std::min(1.0, 2.0 * n / settle);
      world.set_external_force(0, Vec3(0.6 * along, -load, 0.8 * along));
      world.step();
    };
    for (int n = 0; n < settle; ++n) step(n);
    const Vec3 rest = world.position(0);
    double farthest = 0.0;
    for (int n = settle; n < settle + rounds(1'000'000); ++n) {
      step(n);
      Vec3 away = world.position(0) - rest;
      away.y() = 0.0;
      farthest = std::max(farthest, away.norm());
    }
    EXPECT_LT(farthest, 1e-3 * push / friction.stiffness + 1e-12) << seed;
  }
}

}  // namespace
}  // namespace cordis::test
