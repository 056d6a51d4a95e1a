// tests/plan/lasting_force_test.cpp -- a law without a largest slope under a force that lasts.
#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "sim_node/engine/world.h"
#include "sim_node/plan/plan.h"
#include "sim_node/plan/reach_limit.h"
#include "sim_node/plan/stability/liaison_graph.h"
#include "tests/engine/programs.h"
#include "tests/engine/scenes.h"

namespace cordis::test {
namespace {

/// 1 g at the place of a fixed point, on 1e5 N/m^3.
NetworkDescription unstretched() {
  NetworkDescription scene;
  scene.dimension = 1;
  scene.step = 1e-3;
  scene.mats = {fixed(Vec3::Zero()), mass(0.001, Vec3::Zero())};
  StateMachine law = Behaving().state(0.0).state_machine;
  law.states[0].elasticity = engine::Power{1e5, 3.0};
  scene.state_machines = {law};
  scene.state_links = {{0, 1, 0, 0.0}};
  return scene;
}

NetworkDescription driven_by(const Term& force) {
  NetworkDescription scene = unstretched();
  engine::TimeFunction function;
  function.formula[0] = force.program;
  scene.time_functions.push_back(function);
  engine::Drive drive;
  drive.mat = 1;
  drive.is_force = true;
  scene.drives = {drive};
  return scene;
}

plan::Stability kept_by(const NetworkDescription& scene) {
  return plan::stability_of(scene, plan::liaison_graph(scene));
}

double farthest_under(const NetworkDescription& scene, int steps) {
  engine::World world(std::make_shared<const engine::Network>(scene));
  double farthest = 0.0;
  for (int n = 0; n < steps; ++n) {
    world.step();
    const double away = std::abs(world.position(1).x());
    if (!std::isfinite(away)) return 1e300;
    farthest = std::max(farthest, away);
  }
  return farthest;
}

const Term kTime = q(Quantity::kAge);  // NOLINT(cert-err58-cpp): the test would not start

TEST(LastingForce, IsFollowedToWhereALawHoldsIt) {
  // 1e5 x^3 = 200 N at 0.126 m, where K' = 4.8.
  for (const Term& force : {Term(200.0), two(Operation::kMin, 200.0, 100.0 * kTime),
                            two(Operation::kMax, 0.0, 500.0 - 1e6 * size(kTime - 3.002))}) {
    EXPECT_FALSE(kept_by(driven_by(force)).holds());
  }
  EXPECT_GT(farthest_under(driven_by(Term(200.0)), 100), 10.0) << "it diverges indeed";
}

TEST(LastingForce, IsFollowedByAnExpressionToo) {
  NetworkDescription scene = driven_by(200.0 * one(Operation::kSin, 40.0 * kTime));
  const Term e = q(Quantity::kElongation);
  scene.state_machines[0].states[0].elasticity = expression_law(1e5 * e * e * e);
  EXPECT_FALSE(kept_by(scene).holds());
  scene.step = 2e-5;
  EXPECT_TRUE(kept_by(scene).holds());
}

TEST(LastingForce, IsAWeightAsADrive) {
  NetworkDescription scene = unstretched();
  scene.gravity = Vec3(-2e5, 0, 0);  // 200 N
  EXPECT_FALSE(kept_by(scene).holds());
  EXPECT_GT(farthest_under(scene, 100), 10.0);
  EXPECT_NEAR(kept_by(scene).certified.step, kept_by(driven_by(Term(200.0))).certified.step, 1e-9);
}

TEST(LastingForce, IsCertainAtAStepForTheWholeSwing) {
  for (const double sign : {1.0, -1.0}) {
    // Ahead for half a swing, and then back: from the one end to the other.
    const Term turned = sign * 200.0 * one(Operation::kSign, 0.002 - kTime);
    NetworkDescription scene = driven_by(turned);
    scene.step = 0.49 * kept_by(scene).certified.step;
    ASSERT_TRUE(kept_by(scene).holds()) << "beyond half of it its K' varies by more than 1";
    EXPECT_LT(farthest_under(scene, 20000), 0.5);
  }
}

TEST(LastingForce, IsWithinWhatIsWatched) {
  // 2 N stretch it by up to 0.043 m, where it stores 0.086 J: more than the 2 mJ of the start.
  const NetworkDescription scene = driven_by(Term(2.0));
  ASSERT_TRUE(kept_by(scene).holds());
  const plan::ReachLimit limit = plan::reach_limit(scene);
  engine::World world(std::make_shared<const engine::Network>(scene));
  for (int n = 0; n < 5000; ++n) {
    world.step();
    ASSERT_FALSE(plan::is_beyond(limit, world, world.energy())) << n;
  }
}

TEST(LastingForce, FindsWhereAPowerHoldsItHoweverFar) {
  // 1e-9 x^8 = 200 N at 26 m; the scene is a millimetre.
  NetworkDescription scene = driven_by(Term(200.0));
  scene.state_machines[0].states[0].elasticity = engine::Power{1e-9, 8.0};
  const double steepest = 8e-9 * std::pow(25.8, 7.0);
  EXPECT_LT(kept_by(scene).certified.step, 2.0 * std::sqrt(0.001 / steepest));
}

}  // namespace
}  // namespace cordis::test
