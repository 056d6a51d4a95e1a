// tests/engine/state_link_test.cpp -- links that change state.
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "sim_node/engine/links/state_links.h"
#include "tests/engine/led_link.h"
#include "tests/engine/programs.h"
#include "tests/engine/scenes.h"
#include "tests/support/allocation_guard.h"

namespace cordis::test {
namespace {

using engine::LinkEvent;

class StateLinks : public testing::TestWithParam<VectorWidth> {
 protected:
  static World make(const NetworkDescription& scene) { return make_world(scene, GetParam()); }
};

INSTANTIATE_TEST_SUITE_P(Widths, StateLinks, testing::ValuesIn(engine::supported_vector_widths()),
                         [](const auto& width) { return engine::to_string(width.param); });

TEST_P(StateLinks, OfOneStateArePlainLinks) {
  for (const int dimension : {1, 2, 3}) {
    NetworkDescription linear = free_cluster(20, 61, 0.2, dimension);
    NetworkDescription with_states = linear;
    with_states.links.clear();
    for (const Link& link : linear.links) {
      with_states.state_links.push_back(
          {link.mat_a, link.mat_b, static_cast<std::uint32_t>(with_states.state_machines.size()),
           link.rest_length});
      with_states.state_machines.push_back(
          Behaving().state(link.stiffness, link.viscosity).state_machine);
    }
    World expected = make(linear);
    World world = make(with_states);

    run(expected, 300);
    run(world, 300);

    for (std::uint32_t i = 0; i < 20; ++i) {
      EXPECT_LT((world.position(i) - expected.position(i)).norm(), 1e-12);
      EXPECT_LT((world.link_force(i) - expected.link_force(i)).norm(), 1e-9);
    }
    EXPECT_NEAR(world.energy().dissipated, expected.energy().dissipated, 1e-9);
    const engine::Energy energy = world.energy();
    EXPECT_LT(std::abs(energy.residual()), 1e-12 * energy.largest);
    EXPECT_NEAR(energy.elastic, expected.energy().elastic, 1e-9);
    EXPECT_NEAR(energy.elastic_error, expected.energy().elastic_error, 1e-9);
  }
}

TEST_P(StateLinks, ChangeByTheFirstExitThatHolds) {
  World world = make(led_link(Behaving()
                                  .state(1.0)
                                  .exit(q(Quantity::kElongation) > 5.0, 1)
                                  .exit(q(Quantity::kElongation) > 2.0, 2)
                                  .exit(q(Quantity::kElongation) > 1.0, 3)
                                  .state(10.0)
                                  .state(20.0)
                                  .state(30.0)
                                  .state_machine,
                              0.0, 0.0));

  lead(world, 0.5);
  EXPECT_EQ(world.state_of(0), 0U);
  EXPECT_TRUE(world.events().empty());
  lead(world, 3.0);

  EXPECT_EQ(world.state_of(0), 2U);
  EXPECT_EQ(world.tension_of(0), 60.0);
  ASSERT_EQ(world.events().size(), 1U);
  const LinkEvent& event = world.events()[0];
  EXPECT_EQ(event.step, 1U);
  EXPECT_EQ(event.link, 0U);
  EXPECT_EQ(event.mat_a, 0U);
  EXPECT_EQ(event.mat_b, 1U);
  EXPECT_EQ(event.state_machine, 0U);
  EXPECT_EQ(event.from, 0U);
  EXPECT_EQ(event.to, 2U);
  EXPECT_EQ(event.quantity, Quantity::kElongation);
  EXPECT_EQ(event.value, 3.0);
  EXPECT_EQ(world.change_count(0, 0, 2), 1U);
  EXPECT_EQ(world.change_count(0, 0, 1), 0U);
  lead(world, 3.0);
  EXPECT_TRUE(world.events().empty()) << "events are those of the last step";
  EXPECT_EQ(world.change_count(0, 0, 2), 1U);
}

TEST_P(StateLinks, ChangeAtMostOnceAStep) {
  World world = make(led_link(Behaving()
                                  .state(1.0)
                                  .exit(1.0, 1)
                                  .state(2.0)
                                  .exit(1.0, 2)
                                  .state(3.0)
                                  .exit(1.0, 0)
                                  .state_machine,
                              1.0, 0.0));
  std::vector<std::uint32_t> states;
  for (int n = 0; n < 5; ++n) {
    world.step();
    states.push_back(world.state_of(0));
    EXPECT_EQ(world.tension_of(0), 1.0 + world.state_of(0))
        << "the tension of the state it is in then";
  }
  EXPECT_EQ(states, (std::vector<std::uint32_t>{1, 2, 0, 1, 2}));
}

TEST_P(StateLinks, StartInTheStartStateAndTestItsExitsInTheFirstStep) {
  StateMachine state_machine =
      Behaving().state(1.0).state(2.0).exit(q(Quantity::kDistance) > 0.0, 0).state_machine;
  state_machine.start = 1;
  World world = make(led_link(state_machine, 1.0, 0.0));
  EXPECT_EQ(world.state_of(0), 1U);
  EXPECT_EQ(world.tension_of(0), 0.0);

  world.step();

  EXPECT_EQ(world.state_of(0), 0U);
}

TEST_P(StateLinks, KeepTheirRestLengthOrTakeAnother) {
  const auto rest_after = [](RestRule rule, const Term& expression) {
    Behaving behaving;
    behaving.state(1.0);
    if (rule == RestRule::kExpression) {
      behaving.exit_to_rest(q(Quantity::kElongation) > 1.0, 0, expression);
    } else {
      behaving.exit(q(Quantity::kElongation) > 1.0, 0, rule);
    }
    World world = make(led_link(behaving.state_machine, 0.0, 0.25));
    EXPECT_EQ(world.rest_length_of(0), 0.25);
    lead(world, 2.0);
    return world.rest_length_of(0);
  };
  EXPECT_EQ(rest_after(RestRule::kKeep, 0.0), 0.25);
  EXPECT_EQ(rest_after(RestRule::kHere, 0.0), 2.0);
  EXPECT_EQ(
      rest_after(RestRule::kExpression, q(Quantity::kRestLength) + q(Quantity::kElongation) * 0.5),
      0.25 + 0.875);
}

TEST_P(StateLinks, FlowPlasticallyAtTheirYieldPoint) {
  // past the elongation of 0.1 m the rest length follows, so that the tension stays K * 0.1 m
  const Term yielding = q(Quantity::kElongation) > 0.1;
  const Term flowed = q(Quantity::kRestLength) + q(Quantity::kElongation) - 0.1;
  World world = make(
      led_link(Behaving().state(50.0).exit_to_rest(yielding, 0, flowed).state_machine, 1.0, 1.0));

  for (int n = 1; n <= 100; ++n) {
    lead(world, 1.0 + 0.005 * n);
    ASSERT_NEAR(world.tension_of(0), n <= 20 ? 50.0 * 0.005 * n : 5.0, 1e-12) << "step " << n;
  }
  EXPECT_NEAR(world.rest_length_of(0), 1.4, 1e-12);
  lead(world, 1.4);
  EXPECT_NEAR(world.tension_of(0), 0.0, 1e-12) << "the remanent length";
}

TEST_P(StateLinks, DampWithoutASpikeOnEntry) {
  // the damper of a state does not answer to what moved before it was entered
  World world = make(led_link(
      Behaving().state(0.0).exit(q(Quantity::kDistance) > 0.5, 1).state(0.0, 7.0).state_machine,
      0.0, 0.0));

  lead(world, 1.0);
  EXPECT_EQ(world.state_of(0), 1U);
  EXPECT_EQ(world.tension_of(0), 0.0);
  lead(world, 1.5);
  EXPECT_NEAR(world.tension_of(0), 7.0 * 0.5 / 0.01, 1e-9);
}

TEST_P(StateLinks, DampOnlyOthersWhenOneOfABatchIsEntered) {
  NetworkDescription scene = led_link(
      Behaving().state(0.0, 7.0).exit(q(Quantity::kRestLength) > 0.5, 0).state_machine, 0.0, 0.0);
  scene.state_links.push_back({0, 1, 0, 1.0});  // leaves in every step
  World world = make(scene);

  lead(world, 0.25);

  EXPECT_NEAR(world.tension_of(0), 7.0 * 0.25 / 0.01, 1e-9);
  EXPECT_EQ(world.tension_of(1), 0.0);
}

TEST_P(StateLinks, DoNotPullWhenClamped) {
  LinkState clamped;
  clamped.stiffness = 10.0;
  clamped.viscosity = 0.5;
  clamped.pulls = false;
  World world = make(led_link(Behaving().state(clamped).state_machine, 0.9, 1.0));

  lead(world, 0.9);
  EXPECT_NEAR(world.tension_of(0), -1.0, 1e-12);
  lead(world, 0.95);  // the damper alone would pull with 2.5 N, the spring pushes with 0.5 N
  EXPECT_EQ(world.tension_of(0), 0.0);
  lead(world, 1.2);
  EXPECT_EQ(world.tension_of(0), 0.0);
  lead(world, 1.1);  // approaching: the damper wants 5 N of push, the spring 1 N of tension
  EXPECT_NEAR(world.tension_of(0), -4.0, 1e-12);
}

TEST_P(StateLinks, DoNotPushWhenTheyAreThreads) {
  LinkState thread;
  thread.stiffness = 10.0;
  thread.pushes = false;
  World world = make(led_link(Behaving().state(thread).state_machine, 1.0, 1.0));

  lead(world, 0.5);
  EXPECT_EQ(world.tension_of(0), 0.0);
  lead(world, 1.5);
  EXPECT_NEAR(world.tension_of(0), 5.0, 1e-12);
}

TEST_P(StateLinks, NeverGoBeyondTheirForceLimit) {
  LinkState limited;
  limited.stiffness = 10.0;
  limited.viscosity = 0.3;
  limited.force_limit = 2.0;
  World world = make(led_link(Behaving().state(limited).state_machine, 1.0, 1.0));

  lead(world, 1.1);
  EXPECT_EQ(world.tension_of(0), 2.0);
  lead(world, 0.1);
  EXPECT_EQ(world.tension_of(0), -2.0);
  lead(world, 0.1);
  EXPECT_EQ(world.tension_of(0), -2.0);
  lead(world, 0.9);
  EXPECT_EQ(world.tension_of(0), 2.0);
  lead(world, 0.9);
  EXPECT_NEAR(world.tension_of(0), -1.0, 1e-12);
}

TEST_P(StateLinks, AreForcedIntoAState) {
  World world = make(led_link(Behaving()
                                  .state(1.0)
                                  .exit(q(Quantity::kDistance) > 0.0, 1)
                                  .state(2.0)
                                  .state(3.0)
                                  .state_machine,
                              1.0, 0.25));
  world.force_state(0, 2);
  EXPECT_EQ(world.state_of(0), 0U) << "a change of the next step";

  world.step();

  EXPECT_EQ(world.state_of(0), 2U);
  EXPECT_EQ(world.rest_length_of(0), 0.25);
  ASSERT_EQ(world.events().size(), 1U);
  EXPECT_EQ(world.events()[0].quantity, Quantity::kNone);
  EXPECT_EQ(world.events()[0].value, 0.0);
  EXPECT_EQ(world.change_count(0, 0, 2), 1U);
  world.step();
  EXPECT_TRUE(world.events().empty());
}

TEST_P(StateLinks, StandInParallelBetweenTheSameEnds) {
  NetworkDescription scene = led_link(Behaving().state(3.0).state_machine, 1.0, 0.5);
  scene.state_machines.push_back(Behaving().state(0.0).exit(1.0, 1).state(5.0).state_machine);
  for (int l = 0; l < 12; ++l) scene.state_links.push_back({0, 1, l % 2 == 0 ? 1U : 0U, 0.5});
  scene.state_links.push_back({1, 0, 0, 0.5});  // the other way round: b - a = -1, rest = 0.5
  World world = make(scene);

  world.step();

  EXPECT_NEAR(world.link_force(0).x(), 7 * 1.5 + 6 * 2.5 + 4.5, 1e-12);
  EXPECT_EQ(world.link_force(1).x(), -world.link_force(0).x());
}

TEST_P(StateLinks, HaveNoForceWhileTheirLengthIsZero) {
  NetworkDescription scene;
  scene.step = 1e-3;
  scene.mats = {mass(0.1, Vec3(1, 2, 3)), mass(0.1, Vec3(1, 2, 3))};
  LinkState state;
  state.stiffness = 100.0;
  state.viscosity = 2.0;
  state.elasticity = engine::LennardJones{1e-3, 0.1};
  scene.state_machines = {Behaving().state(state).state_machine};
  scene.state_links = {{0, 1, 0, 0.5}};
  World world = make(scene);

  run(world, 10);

  EXPECT_EQ(world.position(0), Vec3(1, 2, 3));
  EXPECT_EQ(world.tension_of(0), 0.0);
  EXPECT_TRUE(std::isfinite(world.energy().residual()));
}

TEST_P(StateLinks, HaveRoomForAnEventEach) {
  NetworkDescription scene = led_link(Behaving().state(1.0).exit(1.0, 0).state_machine, 1.0, 0.0);
  for (int l = 1; l < 1500; ++l) scene.state_links.push_back({0, 1, 0, 0.0});
  World world = make(scene);

  EXPECT_EQ(world.step().lost_events, 0U);

  EXPECT_EQ(world.events().size(), 1500U);
  EXPECT_EQ(world.events()[1499].link, 1499U);
  EXPECT_EQ(world.change_count(0, 0, 0), 1500U);
}

TEST(EventLog, CountsWhatFindsNoRoom) {
  const engine::StateTable table({Behaving().state(1.0).state(2.0).state_machine}, 0.01);
  engine::EventLog log(table, 3);

  for (std::uint32_t l = 0; l < 5; ++l) {
    LinkEvent event;
    event.link = l;
    event.to = 1;
    log.add(event);
  }

  EXPECT_EQ(log.events().size(), 3U);
  EXPECT_EQ(log.events()[2].link, 2U);
  EXPECT_EQ(log.lost(), 2U);
  EXPECT_EQ(log.change_count(0, 0, 1), 5U);
  log.begin_step();
  EXPECT_TRUE(log.events().empty());
  EXPECT_EQ(log.lost(), 0U);
}

TEST_P(StateLinks, AreSteppedWithoutAllocating) {
  NetworkDescription scene = free_cluster(30, 0, 0.0);
  scene.state_machines = {
      Behaving()
          .state(40.0, 0.2)
          .exit(either(q(Quantity::kSpeed) > 0.2, one(Operation::kRising, q(Quantity::kSlip))), 1)
          .state(10.0)
          .exit(q(Quantity::kImpulse) > 0.001, 0, RestRule::kHere)
          .exit(q(Quantity::kAge) > 0.003, 0)
          .state_machine};
  for (std::uint32_t l = 0; l < 100; ++l) {
    scene.state_links.push_back(
        {l % 30, (l * 7 + 1) % 30 == l % 30 ? (l + 1) % 30 : (l * 7 + 1) % 30, 0, 0.3});
  }
  World world = make(scene);
  std::size_t changes = 0;

  const AllocationGuard guard;
  for (int n = 0; n < 50; ++n) {
    if (n == 10) world.force_state(5, 1);
    world.step();
    changes += world.events().size();
  }
  const double energy = world.energy().total();
  const std::uint64_t hash = world.state_hash();

  EXPECT_EQ(guard.count(), 0U);
  EXPECT_GT(changes, 50U);
  EXPECT_TRUE(std::isfinite(energy));
  EXPECT_NE(hash, 0U);
}

TEST_P(StateLinks, TakeOtherParametersBetweenTwoSteps) {
  World world = make(
      led_link(Behaving().state(1.0).exit(q(Quantity::kDistance) > 0.5, 1).state(2.0).state_machine,
               1.0, 0.0));
  world.step();
  ASSERT_EQ(world.state_of(0), 1U);
  const double switched = world.energy().switching;

  world.replace_state_machine(
      0, Behaving().state(1.0).exit(q(Quantity::kDistance) > 0.5, 1).state(6.0).state_machine);

  EXPECT_EQ(world.state_of(0), 1U);
  EXPECT_NEAR(world.energy().switching - switched, 0.5 * (6.0 - 2.0), 1e-12);
  world.step();
  EXPECT_EQ(world.tension_of(0), 6.0);
  EXPECT_LT(std::abs(world.energy().residual()), 1e-12);
}

TEST_P(StateLinks, RefuseStateMachinesThatDoNotFit) {
  World world = make(led_link(Behaving().state(1.0).state(2.0).state_machine, 1.0, 0.0));
  const StateMachine good = Behaving().state(1.0).state(2.0).state_machine;
  StateMachine bad = good;
  bad.states[0].stiffness = -1.0;
  StateMachine heavy = good;
  heavy.states[0].viscosity = std::numeric_limits<double>::max();

  EXPECT_THROW(world.replace_state_machine(1, good), std::invalid_argument);
  EXPECT_THROW(world.replace_state_machine(0, bad), std::invalid_argument);
  EXPECT_THROW(world.replace_state_machine(0, heavy), std::invalid_argument);
  EXPECT_THROW(world.replace_state_machine(0, Behaving().state(1.0).state_machine),
               std::invalid_argument);
  EXPECT_NO_THROW(world.replace_state_machine(0, good));
}

}  // namespace
}  // namespace cordis::test
