// tests/engine/friction_of_states_test.cpp -- states of a contact with a friction of their own.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "tests/engine/programs.h"
#include "tests/engine/rubbing.h"
#include "tests/engine/surfaces.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/rounds.h"

namespace cordis::test {
namespace {

using engine::Energy;
using engine::Friction;
using engine::Snapshot;

constexpr double kBallStiffness = 1e5;
constexpr double kBallViscosity = 100.0;

LinkState rough(const Friction& friction) {
  LinkState state = contact(kBallStiffness, kBallViscosity);
  state.friction = friction;
  return state;
}

/// A ball pressed with 20 N that two states hold, the second one once its spring is stretched by 1e-4 m.
NetworkDescription gripped(const Friction& holding, const Friction& sliding) {
  NetworkDescription scene = pressed_ball(20.0, holding, kBallStiffness, kBallViscosity, 1e-4);
  scene.state_machines[0] = Behaving()
                                .state(rough(holding))
                                .exit(q(Quantity::kSlid) > 1e-4, 1)
                                .state(rough(sliding))
                                .state_machine;
  return scene;
}

TEST(FrictionOfStates, HoldsByThatOfTheStateAndSlidesByThatOfTheNext) {
  World world =
      make_world(gripped({10.0, 10.0, kBallStiffness, 300.0}, {0.2, 0.2, kBallStiffness, 300.0}));
  double farthest = 0.0;
  double draw = 0.0;
  for (int n = 0; world.total_change_count() == 0; ++n) {
    ASSERT_LT(n, 40000);
    farthest = std::max(farthest, world.position(0).x());
    draw = 12.0 * n / 20000.0;
    world.set_external_force(0, Vec3(draw, -20.0, 0.0));
    world.step();
  }
  // The condition sees the spring of the step before: both give way by F / K.
  EXPECT_NEAR(farthest, 1e-4, 1e-6);
  EXPECT_NEAR(draw, 10.0, 0.02);
  EXPECT_EQ(world.events()[0].quantity, Quantity::kSlid);
  EXPECT_GT(world.events()[0].value, 1e-4);
  EXPECT_LT(world.events()[0].value, 1.001e-4);

  run(world, 1000);
  EXPECT_NEAR(world.link_force(0).x(), -0.2 * 20.0, 1e-9);
  const double before = world.velocity(0).x();
  run(world, 1000);
  EXPECT_NEAR(world.velocity(0).x() - before, 0.1 * (draw - 4.0), 1e-9);
}

TEST(FrictionOfStates, LetsGoInAStateWithoutFriction) {
  const double angle = std::atan(0.5);
  NetworkDescription scene = block_on_incline(angle, {});
  scene.state_machines[0] = Behaving()
                                .state(rough({0.8, 0.7, kBallStiffness, 300.0}))
                                .exit(q(Quantity::kAge) > 0.1, 1)
                                .state(rough({}))
                                .exit(q(Quantity::kAge) > 0.1, 0)
                                .state_machine;
  World world = make_world(scene);
  run(world, 1100);
  ASSERT_EQ(world.total_change_count(), 1u);
  const double before = world.velocity(0).x();
  run(world, 800);
  EXPECT_NEAR(world.velocity(0).x() - before, 0.08 * kGravity * std::sin(angle), 1e-9);
  EXPECT_EQ(world.link_force(0).x(), 0.0);
  // and it is held again, by a spring that begins at 0 and gives way
  run(world, 200);
  ASSERT_EQ(world.total_change_count(), 2u);
  const double sliding = world.velocity(0).x();
  run(world, 500);
  const double slower = kGravity * (0.7 * std::cos(angle) - std::sin(angle));
  EXPECT_NEAR(sliding - world.velocity(0).x(), 0.05 * slower, 1e-9);
}

TEST(FrictionOfStates, KeepsTheForceOfASpringThatComesToAStifferOne) {
  for (const double stiffer : {3.0, 0.25}) {
    NetworkDescription scene =
        gripped({10.0, 10.0, kBallStiffness, 300.0}, {10.0, 10.0, stiffer * kBallStiffness, 300.0});
    World world = make_world(scene);
    int n = 0;
    double force = 0.0;
    for (; world.total_change_count() == 0; ++n) {
      ASSERT_LT(n, 40000);
      force = world.link_force(0).x();
      world.set_external_force(0, Vec3(12.0 * n / 20000.0, -20.0, 0.0));
      world.step();
    }
    const double kept = std::min(1.0, stiffer);
    EXPECT_NEAR(world.link_force(0).x(), kept * force, 0.02) << stiffer;
    const Energy energy = world.energy();
    EXPECT_NEAR(energy.residual(), 0.0, 1e-12 * energy.largest) << stiffer;
    EXPECT_GT(energy.dissipated, 0.0) << stiffer;
  }
}

/// A cloud whose pairs change between three states of different friction.
NetworkDescription changing_cloud(int dimension, unsigned seed) {
  NetworkDescription scene = rubbing_cloud(dimension, seed);
  LinkState soft = contact(200.0, 0.02);
  soft.friction = Friction{0.9, 0.2, 700.0, 0.05};
  LinkState bare = contact(300.0, 0.05);
  bare.friction = Friction{};
  scene.state_machines[0] = Behaving()
                                .state(contact(300.0, 0.05))
                                .exit(q(Quantity::kSlid) > 2e-3, 1)
                                .exit(q(Quantity::kForce) < -1.0, 2)
                                .state(soft)
                                .exit(q(Quantity::kSlip) < 0.05, 0)
                                .exit(q(Quantity::kAge) > 0.01, 2)
                                .state(bare)
                                .exit(q(Quantity::kAge) > 0.005, 0)
                                .state_machine;
  scene.state_machines[0].friction = {0.7, 0.4, 200.0, 0.1};
  return scene;
}

TEST(FrictionOfStates, ClosesTheAccountAndOnlyTakesEnergy) {
  for (unsigned seed = 1; seed <= 12; seed += kSeedStride) {
    World world = make_world(changing_cloud(2 + static_cast<int>(seed % 2), seed));
    double taken = 0.0;
    for (int n = 0; n < 4000; ++n) {
      world.step();
      const Energy energy = world.energy();
      ASSERT_NEAR(energy.residual(), 0.0, 1e-12 * energy.largest) << seed << " step " << n;
      ASSERT_GT(energy.dissipated, taken - 1e-3 * energy.initial) << seed << " step " << n;
      taken = std::max(taken, energy.dissipated);
    }
    EXPECT_GT(world.total_change_count(), 100u) << seed;
  }
}

TEST(FrictionOfStates, IsTheSameBitsAtEveryVectorWidth) {
  std::vector<std::uint64_t> hashes;
  for (const VectorWidth width : engine::supported_vector_widths()) {
    World world = make_world(changing_cloud(3, 3), width);
    run(world, 2000);
    hashes.push_back(world.state_hash());
  }
  for (const std::uint64_t hash : hashes) EXPECT_EQ(hash, hashes[0]);
}

TEST(FrictionOfStates, GoesOnFromASnapshot) {
  World world = make_world(changing_cloud(3, 7));
  run(world, 1000);
  const Snapshot snapshot = world.snapshot();
  World other = make_world(changing_cloud(3, 7));
  other.restore(snapshot);
  EXPECT_EQ(other.energy().elastic, world.energy().elastic);
  for (int n = 0; n < 500; ++n) {
    world.step();
    other.step();
    ASSERT_EQ(other.state_hash(), world.state_hash()) << n;
  }
  EXPECT_EQ(other.energy().dissipated, world.energy().dissipated);
}

TEST(FrictionOfStates, TakesOtherParametersBetweenTwoSteps) {
  NetworkDescription scene = changing_cloud(2, 4);
  World world = make_world(scene);
  run(world, 500);
  StateMachine other = scene.state_machines[0];
  other.states[1].friction->stiffness *= 2.0;
  other.friction.static_coefficient = 1.5;
  world.replace_state_machine(0, other);
  run(world, 500);
  const Energy energy = world.energy();
  EXPECT_NEAR(energy.residual(), 0.0, 1e-12 * energy.largest);
  for (LinkState& state : other.states) state.friction = Friction{};
  EXPECT_THROW(world.replace_state_machine(0, other), std::invalid_argument);
}

TEST(FrictionOfStates, StepsWithoutAllocating) {
  World world = make_world(changing_cloud(3, 9));
  run(world, 3);
  const AllocationGuard guard;
  run(world, 200);
  EXPECT_EQ(guard.count(), 0u);
}

}  // namespace
}  // namespace cordis::test
