// tests/plan/entry_test.cpp -- laws without a largest slope that a change of state enters.
#include "sim_node/plan/stability/entry.h"

#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "sim_node/engine/world.h"
#include "sim_node/plan/plan.h"
#include "sim_node/plan/stability/liaison_graph.h"
#include "tests/engine/programs.h"
#include "tests/engine/scenes.h"

namespace cordis::test {
namespace {

const Term kStretched =
    q(Quantity::kElongation);         // NOLINT(cert-err58-cpp): the test would not start
const Term kOld = q(Quantity::kAge);  // NOLINT(cert-err58-cpp)

LinkState cubic(double coefficient) {
  LinkState state;
  state.elasticity = engine::Power{coefficient, 3.0};
  return state;
}

/// 1 g on a law with states, 0.1 m from a fixed point and at its rest length, at 0.5 m/s.
NetworkDescription thrown(StateMachine machine) {
  NetworkDescription scene;
  scene.dimension = 1;
  scene.step = 1e-3;
  scene.mats = {fixed(Vec3::Zero()), mass(0.001, Vec3(0.1, 0, 0))};
  scene.mats[1].velocity = Vec3(0.5, 0, 0);
  scene.state_machines = {std::move(machine)};
  scene.state_links = {{0, 1, 0, 0.1}};
  return scene;
}

plan::Stability promised(const NetworkDescription& scene) {
  return plan::stability_of(scene, plan::liaison_graph(scene));
}

bool may_begin_steep(const NetworkDescription& scene) {
  const plan::Stability stability = promised(scene);
  return stability.uncertainty &&
         std::string(stability.uncertainty->why).find("begin it where it is steep") !=
             std::string::npos;
}

/// How far the mass comes from where it began [m]; a huge number where the run diverges.
double farthest_in(const NetworkDescription& scene, int steps) {
  engine::World world(std::make_shared<const engine::Network>(scene));
  double farthest = 0.0;
  for (int n = 0; n < steps; ++n) {
    world.step();
    const double away = std::abs(world.position(1).x() - scene.mats[1].position.x());
    if (!std::isfinite(away)) return 1e300;
    farthest = std::max(farthest, away);
  }
  return farthest;
}

TEST(EntryOfAPower, IsNotCertainWhereNothingHoldsTheStateBefore) {
  Term energy(0.0);
  energy.program.code = {{Operation::kVariable, Quantity::kDistance, 0.0, 0}};
  const Term rises = one(Operation::kRising, kStretched > 0.08);
  for (const Term& when : {kOld > 0.16, q(Quantity::kSpeed) > 0.4, energy > 1.0, rises}) {
    NetworkDescription scene =
        thrown(Behaving().state(0.0).exit(when, 1).state(cubic(3e6)).state_machine);
    scene.variables = {engine::Variable{}};
    EXPECT_TRUE(may_begin_steep(scene));
  }
}

TEST(EntryOfAPower, IsCertainAtAStepForWhereItsConditionBegins) {
  NetworkDescription scene =
      thrown(Behaving().state(0.0).exit(kStretched > 0.08, 1).state(cubic(3e6)).state_machine);
  EXPECT_FALSE(promised(scene).holds()) << "at 0.08 m it has K' = 58";
  EXPECT_GT(farthest_in(scene, 2000), 10.0) << "and so it diverges";
  scene.step = 1e-5;
  ASSERT_TRUE(promised(scene).holds());
  EXPECT_LT(promised(scene).certified.step, 2e-3 / std::sqrt(9e3 * 0.08 * 0.08));
  scene.step = 1e-4;
  ASSERT_TRUE(promised(scene).holds()) << promised(scene).certified.step;
  EXPECT_LT(farthest_in(scene, 20000), 0.3);
}

TEST(EntryOfAPower, IsCertainAsFarAsTheStateBeforeGivesWay) {
  // 10 mJ stretch 1000 N/m by 4.5 mm and 1 N/m by 0.14 m; the mass comes to 0.06 m.
  const auto after = [](double stiffness) {
    NetworkDescription scene =
        thrown(Behaving().state(stiffness).exit(kOld > 0.04, 1).state(cubic(1e6)).state_machine);
    scene.mats[1].velocity = Vec3(2.0, 0, 0);
    return scene;
  };
  EXPECT_TRUE(promised(after(1000.0)).holds());
  EXPECT_FALSE(promised(after(1.0)).holds());
  EXPECT_GT(farthest_in(after(1.0), 4000), 10.0);
}

TEST(EntryOfAPower, IsNotCertainOnceARestLengthWasMovedInAStateBefore) {
  const auto then_cubic = [](Behaving law) {
    return thrown(law.state(1000.0).exit(kOld > 0.01, 2).state(cubic(3e5)).state_machine);
  };
  const auto moved_to = [](const Term& rest) {
    return Behaving().state(1.0).exit_to_rest(kOld > 0.01, 1, rest);
  };
  const NetworkDescription here =
      then_cubic(Behaving().state(1.0).exit(kOld > 0.01, 1, RestRule::kHere));
  EXPECT_TRUE(may_begin_steep(then_cubic(moved_to(q(Quantity::kSpeed)))));
  EXPECT_FALSE(may_begin_steep(here));
  EXPECT_TRUE(promised(here).holds());
  // A length that is known brings in 5 J, and is certain at the step for that.
  NetworkDescription known = then_cubic(moved_to(Term(0.0)));
  EXPECT_FALSE(may_begin_steep(known));
  EXPECT_FALSE(promised(known).holds());
  known.step = 0.98 * promised(known).certified.step;
  EXPECT_LT(farthest_in(known, 20000), 0.5);
}

TEST(EntryOfAPower, IsNotCertainWhereEveryRoundBringsInMore) {
  const NetworkDescription scene = thrown(Behaving()
                                              .state(10.0)
                                              .exit(kOld > 0.05, 1)
                                              .state(cubic(3e5))
                                              .exit(kOld > 0.05, 0)
                                              .state_machine);
  EXPECT_TRUE(may_begin_steep(scene));
}

/// In a plane what pulls at distance 0 turns there without a limit: so does a spring of a negative rest length.
TEST(EntryWithAnotherRest, IsNotCertainWhereItMayBeNegativeAndTheStateHolds) {
  const auto is_certain = [](const Term& rest, bool ends) {
    Behaving law;
    law.state(50.0).exit_to_rest(kOld > 0.1, 1, rest).state(50.0);
    if (ends) law.exit_to_rest(kStretched < -0.01, 1, rest);
    NetworkDescription scene = thrown(law.state_machine);
    scene.dimension = 2;
    const plan::Stability stability = promised(scene);
    EXPECT_EQ(stability.holds(), !stability.uncertainty);
    return stability.holds();
  };
  EXPECT_FALSE(is_certain(Term(-0.05), false));
  EXPECT_TRUE(is_certain(Term(0.05), false));
  EXPECT_TRUE(is_certain(q(Quantity::kRestLength) + Term(0.01), false));
  EXPECT_FALSE(is_certain(q(Quantity::kRestLength) - Term(0.01), false));
  EXPECT_FALSE(is_certain(q(Quantity::kDistance) - Term(0.01), false));
  EXPECT_TRUE(is_certain(q(Quantity::kDistance) - Term(0.01), true)) << "it yields before";
}

TEST(EntryOfAPower, OfAContactIsCertainAsThatOfOneWithoutStates) {
  LinkState pushing;
  pushing.elasticity = engine::Power{1e4, 1.5};
  pushing.pulls = false;
  NetworkDescription states = thrown(Behaving()
                                         .state(0.0)
                                         .exit(kStretched < 0.0, 1)
                                         .state(pushing)
                                         .exit(kStretched >= 0.0, 0)
                                         .state_machine);
  states.state_links[0].rest_length = 0.05;
  states.mats[1].velocity = Vec3(-0.5, 0, 0);
  NetworkDescription one = states;
  one.state_machines = {Behaving().state(pushing).state_machine};
  ASSERT_TRUE(promised(states).holds());
  EXPECT_NEAR(promised(states).certified.step, promised(one).certified.step,
              1e-9 * promised(one).certified.step);
  // Where it begins within the contact, the first change of state lets it begin there.
  states.state_links[0].rest_length = 0.15;
  // 2.2 J there: 1.5e4 N/m^1.5 * 0.05^0.5 = 3400 N/m.
  const plan::Stability within = promised(states);
  EXPECT_FALSE(may_begin_steep(states));
  EXPECT_LT(within.certified.step, 2.0 * std::sqrt(0.001 / 3350.0));
  EXPECT_GT(within.certified.step, 0.9 * std::sqrt(0.001 / 3400.0));
}

TEST(EntryOfAPower, BringsInNothingFromAStateThatStoresAsMuch) {
  const StateMachine machine =
      Behaving().state(cubic(3e5)).exit(kOld > 0.05, 1).state(cubic(3e5)).state_machine;
  plan::Reach reach;
  reach.brought = 0.001;
  reach.elongation = 0.1;
  const auto entries = plan::entries_of(machine, 0.1, plan::kAnyNumber, reach);
  EXPECT_FALSE(entries[0].by_a_change);
  EXPECT_TRUE(entries[1].by_a_change);
  EXPECT_EQ(entries[1].brought, 0.0);
  // From half as stiff: it takes 1.01 mJ, so that it is 1.01 mJ less than what the other one has there.
  const StateMachine harder =
      Behaving().state(cubic(1.5e5)).exit(kOld > 0.05, 1).state(cubic(3e5)).state_machine;
  const double brought = plan::entries_of(harder, 0.1, plan::kAnyNumber, reach)[1].brought;
  EXPECT_GT(brought, 0.00101);
  EXPECT_LT(brought, 0.00125);
}

/// Ends without mass gain no speed of the energy: no step carries them beyond the threshold, where the spring has more.
TEST(EntryOfAState, BetweenEndsWithoutMassBringsInWhatItHasAtItsThreshold) {
  const StateMachine machine =
      Behaving().state(0.0).exit(kStretched > 0.08, 1).state(1000.0).state_machine;
  plan::Reach reach;
  reach.brought = 0.001;
  reach.elongation = 0.1;
  const double brought = plan::entries_of(machine, 0.1, plan::kAnyNumber, reach)[1].brought;
  const double at_threshold = 0.5 * 1000.0 * 0.08 * 0.08;
  EXPECT_NEAR(brought, at_threshold, 1e-3 * at_threshold);
}

}  // namespace
}  // namespace cordis::test
