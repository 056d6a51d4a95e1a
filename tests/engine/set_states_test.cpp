// tests/engine/set_states_test.cpp -- pairs of a set with states of their own.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "tests/engine/balls.h"
#include "tests/support/allocation_guard.h"

namespace cordis::test {
namespace {

using engine::Energy;
using engine::Instruction;
using engine::LinkEvent;
using engine::Operation;
using engine::Program;
using engine::Quantity;
using engine::RestRule;
using engine::Transition;

Instruction constant(double value) {
  return {Operation::kConstant, Quantity::kDistance, value, 0};
}
Instruction quantity(Quantity what) {
  return {Operation::kQuantity, what, 0.0, 0};
}
Instruction operation(Operation what, std::uint32_t slot = 0) {
  return {what, Quantity::kDistance, 0.0, slot};
}

/// quantity compared with a constant
Program compare(Quantity what, Operation how, double with) {
  return {{quantity(what), constant(with), operation(how)}};
}

constexpr std::uint32_t kFree = 0;
constexpr std::uint32_t kBound = 1;

/// Free balls touch, stick where they met, and tear off again when they are pulled too far.
StateMachine sticking(double stiffness, double viscosity, double reach) {
  StateMachine state_machine;
  state_machine.name = "stick";
  LinkState free_state;
  free_state.name = "free";
  free_state.first_exit = 0;
  free_state.last_exit = 1;
  LinkState bound;
  bound.name = "bound";
  bound.stiffness = stiffness;
  bound.viscosity = viscosity;
  bound.first_exit = 1;
  bound.last_exit = 2;
  state_machine.states = {free_state, bound};
  Transition touch{compare(Quantity::kElongation, Operation::kLess, 0.0),
                   kBound,
                   RestRule::kHere,
                   {},
                   Quantity::kElongation};
  Transition tear{compare(Quantity::kElongation, Operation::kGreater, reach),
                  kFree,
                  RestRule::kKeep,
                  {},
                  Quantity::kElongation};
  state_machine.exits = {touch, tear};
  return state_machine;
}

/// Three states that ask for everything a pair remembers.
StateMachine forgetful() {
  StateMachine state_machine = sticking(60.0, 0.05, 0.03);
  state_machine.states[kBound].last_exit = 4;
  state_machine.states[kBound].dissipation =
      engine::Table({-1.0, -0.1, 0.0, 0.1, 1.0}, {-0.1, -0.03, 0.0, 0.03, 0.1});
  LinkState worn = state_machine.states[kBound];
  worn.name = "worn";
  worn.stiffness = 20.0;
  worn.viscosity = 0.2;
  worn.first_exit = 4;
  worn.last_exit = 6;
  state_machine.states.push_back(worn);
  state_machine.exits.push_back(
      {compare(Quantity::kAge, Operation::kGreater, 0.05),
       2,
       RestRule::kExpression,
       {{quantity(Quantity::kRestLength), quantity(Quantity::kElongation), constant(0.5),
         operation(Operation::kMultiply), operation(Operation::kAdd)}},
       Quantity::kAge});
  state_machine.exits.push_back({compare(Quantity::kSlip, Operation::kGreater, 0.9),
                                 2,
                                 RestRule::kKeep,
                                 {},
                                 Quantity::kSlip});
  state_machine.exits.push_back({compare(Quantity::kImpulse, Operation::kLess, -0.02),
                                 kFree,
                                 RestRule::kKeep,
                                 {},
                                 Quantity::kImpulse});
  state_machine.exits.push_back({{{quantity(Quantity::kForce), operation(Operation::kRising, 3),
                                   quantity(Quantity::kElongation), constant(0.008),
                                   operation(Operation::kGreater), operation(Operation::kAnd)}},
                                 kFree,
                                 RestRule::kKeep,
                                 {},
                                 Quantity::kForce});
  return state_machine;
}

NetworkDescription with_set(NetworkDescription scene, const StateMachine& state_machine,
                            double range, double rest_length) {
  add_set(scene, LinkState{}, range, rest_length, 1'000'000);
  scene.state_machines.back() = state_machine;
  return scene;
}

/// Adds the liaison as one state link for each pair.
NetworkDescription with_links(NetworkDescription scene, const StateMachine& state_machine,
                              double rest_length) {
  scene.state_machines = {state_machine};
  for (std::uint32_t a = 0; a < scene.mats.size(); ++a) {
    for (std::uint32_t b = a + 1; b < scene.mats.size(); ++b) {
      scene.state_links.push_back({a, b, 0, rest_length});
    }
  }
  return scene;
}

TEST(SetStates, AreThoseOfALinkForEachPair) {
  for (const int dimension : {2, 3}) {
    const NetworkDescription balls = cloud(12, 0.3, 0.6, dimension);
    World set = make_world(with_set(balls, forgetful(), 1e3, 0.06));
    World links = make_world(with_links(balls, forgetful(), 0.06));
    std::size_t changes = 0;

    for (int n = 0; n < 1000; ++n) {
      set.step();
      links.step();
      ASSERT_EQ(set.events().size(), links.events().size()) << "step " << n;
      for (std::size_t e = 0; e < set.events().size(); ++e) {
        const LinkEvent& event = set.events()[e];
        const LinkEvent& other = links.events()[e];
        EXPECT_EQ(event.link, engine::kNoLink);
        EXPECT_EQ(event.step, other.step);
        EXPECT_EQ(event.mat_a, other.mat_a);
        EXPECT_EQ(event.mat_b, other.mat_b);
        EXPECT_EQ(event.from, other.from);
        EXPECT_EQ(event.to, other.to);
        EXPECT_EQ(event.quantity, other.quantity);
        EXPECT_NEAR(event.value, other.value, 1e-7);
        EXPECT_NEAR(event.energy, other.energy, 1e-7);
      }
      changes += set.events().size();
      for (std::uint32_t i = 0; i < 12; ++i) {
        // the order of the sums differs; what is bound shakes, and rounding grows with it
        ASSERT_LT((set.position(i) - links.position(i)).norm(), 1e-9) << "step " << n;
      }
    }

    EXPECT_GT(changes, 10U);
    EXPECT_GT(set.change_count(0, kBound, kFree) + set.change_count(0, kBound, 2), 0U);
    for (std::uint32_t source = 0; source < 3; ++source) {
      for (std::uint32_t target = 0; target < 3; ++target) {
        EXPECT_EQ(set.change_count(0, source, target), links.change_count(0, source, target));
      }
    }
    EXPECT_NEAR(set.energy().switching, links.energy().switching, 1e-8);
  }
}

TEST(SetStates, OfABoundPairAreKeptBeyondTheRange) {
  NetworkDescription scene = cloud(0, 0.0, 0.0, 3);
  scene.mats = {mass(1.0, Vec3::Zero(), Vec3(0.5, 0, 0)), mass(1.0, Vec3(0.055, 0, 0))};
  scene.radius = {0.03, 0.03};
  // the knock of 0.5 m/s needs 0.05 N/m * x^2 / 2 = 0.0625 J: 0.25 m, far beyond the range
  World world = make_world(with_set(scene, sticking(2.0, 0.0, 1.0), 0.065, -1.0));

  double farthest = 0.0;
  for (int n = 0; n < 3000; ++n) {
    world.step();
    farthest = std::max(farthest, (world.position(1) - world.position(0)).norm());
  }

  EXPECT_EQ(world.change_count(0, kFree, kBound), 1U);
  EXPECT_EQ(world.change_count(0, kBound, kFree), 0U);
  EXPECT_GT(farthest, 0.2);
  const std::vector<engine::BoundPair> bound = world.bound_pairs(0);
  ASSERT_EQ(bound.size(), 1U);
  EXPECT_EQ(bound[0].mat_a, 0U);
  EXPECT_EQ(bound[0].mat_b, 1U);
  EXPECT_EQ(bound[0].state, kBound);
  EXPECT_LT(std::abs(world.energy().residual()), 1e-11 * world.energy().largest);
}

TEST(SetStates, OfAPairThatIsFreeAgainBeyondTheRangeHaveNoForce) {
  NetworkDescription scene = cloud(0, 0.0, 0.0, 3);
  scene.mats = {mass(1.0, Vec3::Zero(), Vec3(0.5, 0, 0)), mass(1.0, Vec3(0.055, 0, 0))};
  scene.radius = {0.03, 0.03};
  StateMachine state_machine =
      sticking(2.0, 0.0, 0.1);  // torn at 0.16 m, more than twice the range
  state_machine.states[kFree].stiffness = 50.0;
  World world = make_world(with_set(scene, state_machine, 0.065, -1.0));
  Vec3 velocity = Vec3::Zero();
  int torn_for = 0;

  for (int n = 0; n < 3000 && torn_for < 100; ++n) {
    world.step();
    if (world.change_count(0, kBound, kFree) == 0) continue;
    if (++torn_for == 1) {
      ASSERT_GT((world.position(1) - world.position(0)).norm(), 0.13);
      velocity = world.velocity(0);
    }
    EXPECT_LT((world.velocity(0) - velocity).norm(), 1e-12) << torn_for;
  }

  EXPECT_EQ(torn_for, 100);
}

TEST(SetStates, OfABallThatIsNoLongerFiniteAreForgottenAndItIsReported) {
  NetworkDescription scene = cloud(0, 0.0, 0.0, 3);
  for (int i = 0; i < 12; ++i) scene.mats.push_back(mass(1.0, Vec3(0.055 * i, 0, 0)));
  scene.radius.assign(12, 0.03);
  scene.mats[5].mass = 1e-300;  // any push flings it out of all numbers
  for (const VectorWidth width : engine::supported_vector_widths()) {
    World world = make_world(with_set(scene, sticking(2.0, 0.0, 1.0), 0.065, -1.0), width);
    EXPECT_EQ(world.step().non_finite_mats, 0U);  // all touch in the first step, at rest
    EXPECT_EQ(world.bound_pairs(0).size(), 11U);
    world.set_external_force(5, Vec3(1e10, 0, 0));

    std::uint32_t lost = 0;
    for (int n = 0; n < 200; ++n) lost = world.step().non_finite_mats;

    EXPECT_EQ(lost, 1U);
    EXPECT_EQ(world.bound_pairs(0).size(), 9U);
    for (std::uint32_t i = 0; i < 12; ++i) EXPECT_EQ(world.position(i).allFinite(), i != 5) << i;
  }
}

TEST(SetStates, BeginAnewWhenAFreePairComesBackIntoRange) {
  // free at 0.05 s of age in range counts as touched; the pair leaves for a while and comes back
  StateMachine state_machine = sticking(1.0, 0.0, 10.0);
  state_machine.exits[0].when = compare(Quantity::kAge, Operation::kGreater, 0.05);
  NetworkDescription scene = cloud(0, 0.0, 0.0, 1);
  scene.mats = {{MatKind::kPort, 0.0, Vec3::Zero(), Vec3::Zero()}, fixed(Vec3::Zero())};
  World world = make_world(with_set(scene, state_machine, 0.1, 0.0));

  std::uint64_t bound_at = 0;
  for (std::uint64_t n = 0; n < 200 && bound_at == 0; ++n) {
    const bool away = n % 40 >= 30 && n < 100;  // in range for 30 steps of 1 ms at a time
    world.impose_position(0, Vec3(away ? 0.2 : 0.01, 0, 0));
    world.step();
    if (!world.events().empty()) bound_at = n;
  }

  EXPECT_EQ(bound_at, 80U + 51U);  // it is in range for good from step 80 on
}

TEST(SetStates, AreTheSameBitsForEveryWidthAndAfterASnapshot) {
  const NetworkDescription scene = with_set(cloud(60, 0.45, 0.6, 3), forgetful(), 0.12, -1.0);
  World narrow = make_world(scene, VectorWidth::kSse2);
  run(narrow, 400);
  const engine::Snapshot snapshot = narrow.snapshot();
  run(narrow, 400);
  EXPECT_GT(narrow.change_count(0, kFree, kBound), 20U);

  for (const VectorWidth width : engine::supported_vector_widths()) {
    World world = make_world(scene, width);
    run(world, 800);
    EXPECT_EQ(world.state_hash(), narrow.state_hash()) << engine::to_string(width);
    EXPECT_EQ(world.energy().switching, narrow.energy().switching);

    World other = make_world(scene, width);
    run(other, 50);
    other.restore(snapshot);
    run(other, 400);
    EXPECT_EQ(other.state_hash(), narrow.state_hash()) << engine::to_string(width);
    EXPECT_EQ(other.energy().elastic, narrow.energy().elastic);
  }
}

TEST(SetStates, AreInTheHash) {
  // two fixed points: nothing but the state of their pair changes
  NetworkDescription scene = cloud(0, 0.0, 0.0, 3);
  scene.mats = {fixed(Vec3::Zero()), fixed(Vec3(0.01, 0, 0)), mass(1.0, Vec3(5, 0, 0))};
  StateMachine never = sticking(1.0, 0.0, 10.0);
  never.exits[0].when = compare(Quantity::kElongation, Operation::kLess, -1.0);
  World sticks = make_world(with_set(scene, sticking(1.0, 0.0, 10.0), 0.1, 0.05));
  World stays = make_world(with_set(scene, never, 0.1, 0.05));

  sticks.step();
  stays.step();

  EXPECT_NE(sticks.state_hash(), stays.state_hash());
}

TEST(SetStates, KeepMomentumAndCloseTheAccount) {
  for (const int dimension : {1, 2, 3}) {
    World world = make_world(
        with_set(cloud(60, dimension == 1 ? 3.0 : 0.5, 0.6, dimension), forgetful(), 0.12, -1.0));
    const Vec3 before = world.momentum();
    for (int n = 0; n < 10'000; ++n) {
      world.step();
      if (n % 100 != 0) continue;
      const Energy energy = world.energy();
      ASSERT_LT(std::abs(energy.residual()), 1e-10 * energy.largest) << "step " << n;
    }
    EXPECT_LT((world.momentum() - before).norm(), 5e-13 * std::sqrt(10'000 * 60.0));
    EXPECT_GT(std::abs(world.energy().switching), 1e-3);
    EXPECT_GT(world.energy().dissipated, 1e-3);
  }
}

TEST(SetStates, StepWithoutAllocating) {
  World world = make_world(with_set(cloud(60, 0.45, 0.6, 3), forgetful(), 0.12, -1.0));
  const AllocationGuard guard;
  run(world, 500);
  EXPECT_EQ(guard.count(), 0U);
  EXPECT_GT(world.change_count(0, kFree, kBound), 0U);
}

/// A cube of balls that fly together; all meet after 100 steps, and stick where they come near.
NetworkDescription balls_that_fly_together(std::uint32_t side, double spacing) {
  NetworkDescription scene;
  scene.step = 1e-3;
  engine::SetLiaison set;
  set.rest_length = 0.1;
  set.range = 0.1;
  const double middle = 0.5 * (side - 1);
  for (std::uint32_t i = 0; i < side * side * side; ++i) {
    const Vec3 place =
        spacing * Vec3(i % side - middle, i / side % side - middle, i / side / side - middle);
    scene.mats.push_back(mass(0.001, place, -place / (100 * scene.step)));
    set.set_p.push_back(i);
  }
  scene.state_machines = {sticking(1e-6, 0.0, 1e3)};
  scene.sets = {set};
  return scene;
}

TEST(SetStates, OfTwoSetsAreNotRestoredWithAPairOfOneSide) {
  NetworkDescription scene = cloud(4, 0.0, 0.0, 3);
  for (std::uint32_t i = 0; i < 4; ++i) scene.mats[i].position = Vec3(i % 2, 0.01 * (i / 2), 0);
  scene.state_machines = {sticking(10.0, 0.0, 1.0)};
  SetLiaison set;
  set.set_p = {0, 1};
  set.set_q = {2, 3};
  set.range = 0.1;
  set.rest_length = 0.05;
  scene.sets = {set};
  World world = make_world(scene);
  world.step();
  ASSERT_EQ(world.bound_pairs(0).size(), 2U);  // 0 and 2, 1 and 3

  engine::Snapshot snapshot = world.snapshot();
  EXPECT_NO_THROW(world.restore(snapshot));
  const auto is_member_2 = [](double value) { return value == 4.0 * 2.0; };
  ASSERT_EQ(std::count_if(snapshot.state.begin(), snapshot.state.end(), is_member_2), 1);
  *std::find_if(snapshot.state.begin(), snapshot.state.end(), is_member_2) = 4.0 * 1.0;
  EXPECT_THROW(world.restore(snapshot), std::invalid_argument) << "0 and 1 are of one set";
}

TEST(SetStates, NeverForgetABondThoughAllPairsBindAtOnce) {
  World world = make_world(balls_that_fly_together(9, 0.001));
  const engine::StepReport report = world.step();
  EXPECT_EQ(report.forgotten_pairs, 0u);
  EXPECT_EQ(world.bound_pairs(0).size(), std::size_t{729 * 728 / 2});
}

TEST(SetStates, KeepAllBondsOfAStepInWhichAllBallsMeet) {
  World world = make_world(balls_that_fly_together(9, 9.0));
  std::size_t largest = 0;
  std::size_t before = 0;
  for (int n = 0; n < 110; ++n) {
    const engine::StepReport report = world.step();
    ASSERT_EQ(report.forgotten_pairs, 0u) << "step " << n;
    if (report.wants_room) world.make_room();
    const std::size_t bound = world.bound_pairs(0).size();
    largest = std::max(largest, bound - std::min(bound, before));
    before = bound;
  }
  EXPECT_GT(largest, 200000u) << "bonds of one step";
  EXPECT_EQ(world.bound_pairs(0).size(), std::size_t{729 * 728 / 2});
}

TEST(SetStates, MakeRoomBetweenStepsForAllBonds) {
  const NetworkDescription scene = balls_that_fly_together(9, 0.05);
  World world = make_world(scene);
  std::uint32_t growths = 0;
  for (int n = 0; n < 110; ++n) {
    const engine::StepReport report = world.step();
    ASSERT_EQ(report.forgotten_pairs, 0u) << "step " << n;
    if (!report.wants_room) continue;
    ++growths;
    world.make_room();
  }
  EXPECT_GT(growths, 0u);
  EXPECT_EQ(world.bound_pairs(0).size(), std::size_t{729 * 728 / 2});

  World again = make_world(scene);
  again.restore(world.snapshot());
  EXPECT_EQ(again.state_hash(), world.state_hash()) << "room is made for what was saved";
  World other = make_world(scene);
  std::vector<double> room;
  EXPECT_TRUE(other.take_over(world, room));
  EXPECT_EQ(other.bound_pairs(0).size(), world.bound_pairs(0).size());
}

}  // namespace
}  // namespace cordis::test
