// tests/sim/runner_test.cpp
#include "sim_node/run/runner.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/sim/loaded_scenes.h"
#include "tests/support/allocation_guard.h"

namespace cordis::sim {
namespace {

Request request_of(Request::Kind kind, std::uint64_t steps = 0) {
  Request request;
  request.kind = kind;
  request.steps = steps;
  return request;
}

void execute(Runner& runner, Request request) {
  runner.execute(request);
}

/// A turn in which the key sends a position.
bool turn(Runner& runner, std::uint64_t number, double position_m) {
  DeviceExchange& key = runner.simulation().devices().front();
  key.receive(key_sample(number, position_m));
  return runner.advance();
}

double force_of_key(Runner& runner) {
  DeviceExchange& key = runner.simulation().devices().front();
  return key.answer_forces(runner.simulation().world(), true, 0).force_n()[0];
}

std::uint64_t steps_of(const Runner& runner) {
  return runner.simulation().world().step_count();
}

TEST(Runner, PlaysATickPerTurn) {
  Runner runner(loaded_scene_of(swing_text()), false);
  EXPECT_TRUE(runner.advance());
  EXPECT_EQ(steps_of(runner), 4u);
}

TEST(Runner, StandsStillWhilePausedAndGoesOnWhereItWas) {
  Runner straight(loaded_scene_of(swing_text()), true);
  Runner paused(loaded_scene_of(swing_text()), true);
  for (std::uint64_t n = 1; n <= 50; ++n) turn(straight, n, 0.001);
  for (std::uint64_t n = 1; n <= 25; ++n) turn(paused, n, 0.001);

  execute(paused, request_of(Request::Kind::kPause));
  for (int i = 0; i < 10; ++i) EXPECT_FALSE(paused.advance());
  EXPECT_EQ(steps_of(paused), 100u);
  execute(paused, request_of(Request::Kind::kResume));
  for (std::uint64_t n = 26; n <= 50; ++n) turn(paused, n, 0.001);

  EXPECT_EQ(paused.simulation().world().state_hash(), straight.simulation().world().state_hash())
      << "in lockstep a pause leaves no trace";
}

TEST(Runner, DoesJustTheSingleStepsWanted) {
  Runner runner(loaded_scene_of(swing_text()), true);
  turn(runner, 1, 0.0);
  execute(runner, request_of(Request::Kind::kStep, 6));

  EXPECT_TRUE(turn(runner, 2, 0.0));
  EXPECT_EQ(steps_of(runner), 8u);
  EXPECT_FALSE(turn(runner, 3, 0.0)) << "the tick is not complete";
  EXPECT_EQ(steps_of(runner), 10u);
  EXPECT_FALSE(runner.moves());
  EXPECT_FALSE(runner.advance());
  EXPECT_EQ(steps_of(runner), 10u);
}

TEST(Runner, CompletesATickBegunInSingleStepsAsIfItHadNotBeenInterrupted) {
  Runner straight(loaded_scene_of(swing_text()), true);
  Runner stepped(loaded_scene_of(swing_text()), true);
  for (std::uint64_t n = 1; n <= 40; ++n) {
    turn(straight, n, 1e-4 * static_cast<double>(n));
    DeviceExchange& key = stepped.simulation().devices().front();
    key.receive(key_sample(n, 1e-4 * static_cast<double>(n)));
    execute(stepped, request_of(Request::Kind::kStep, 1));
    EXPECT_FALSE(stepped.advance());
    execute(stepped, request_of(Request::Kind::kStep, 2));
    EXPECT_FALSE(stepped.advance());
    execute(stepped, request_of(Request::Kind::kResume));
    EXPECT_TRUE(stepped.advance());
  }
  EXPECT_EQ(stepped.simulation().world().state_hash(), straight.simulation().world().state_hash());
}

TEST(Runner, GivesNoForceWhilePausedAndGivesItBackGradually) {
  Runner runner(loaded_scene_of(swing_text()), /*devices_wait=*/false);
  std::uint64_t number = 0;
  for (int i = 0; i < 300; ++i) turn(runner, ++number, -0.01);
  ASSERT_GT(std::abs(force_of_key(runner)), 0.1);

  execute(runner, request_of(Request::Kind::kPause));
  turn(runner, ++number, -0.01);
  EXPECT_EQ(force_of_key(runner), 0.0);
  for (int i = 0; i < 50; ++i) turn(runner, ++number, -0.03);
  EXPECT_EQ(force_of_key(runner), 0.0);

  execute(runner, request_of(Request::Kind::kResume));
  turn(runner, ++number, -0.03);
  EXPECT_LT(std::abs(force_of_key(runner)), 100.0 * 0.03 / 20.0) << "a hundredth of the force";
  for (int i = 0; i < 300; ++i) turn(runner, ++number, -0.03);
  EXPECT_GT(std::abs(force_of_key(runner)), 0.5);
}

TEST(Runner, BeginsAnotherStageAndHandsTheOldOneBack) {
  Runner runner(loaded_scene_of(swing_text()), false);
  for (std::uint64_t n = 1; n <= 200; ++n) turn(runner, n, -0.01);
  const LoadedScene* before = &runner.loaded_scene();
  Request request = request_of(Request::Kind::kRestart);
  request.scene = loaded_scene_of(swing_text("other", 500.0), 2);
  const LoadedScene* next = request.scene.get();

  runner.execute(request);

  EXPECT_EQ(&runner.loaded_scene(), next);
  EXPECT_EQ(request.scene.get(), before);
  EXPECT_EQ(request.step, 800u);
  EXPECT_EQ(steps_of(runner), 0u);
  EXPECT_NEAR(runner.played_s(), 0.2, 1e-12) << "the time played goes on";
  EXPECT_EQ(force_of_key(runner), 0.0);
  turn(runner, 201, -0.01);
  EXPECT_NEAR(runner.played_s(), 0.202, 1e-12);
}

TEST(Runner, StaysPausedWithAnotherScene) {
  Runner runner(loaded_scene_of(swing_text()), false);
  execute(runner, request_of(Request::Kind::kPause));
  Request request = request_of(Request::Kind::kRestart);
  request.scene = loaded_scene_of(swing_text(), 2);
  runner.execute(request);
  EXPECT_TRUE(request.was_paused);
  EXPECT_FALSE(runner.advance());
  EXPECT_EQ(steps_of(runner), 0u);
}

/// The swing with another stiffness of its springs.
std::unique_ptr<LoadedScene> stage_with_stiffness(double stiffness) {
  auto scene = std::make_shared<scene::Scene>(*scene_of(swing_text()));
  for (engine::Link& link : scene->network.links) link.stiffness = stiffness;
  return std::make_unique<LoadedScene>(scene, kEpochOfSim, 1);
}

Request exchange_for(std::unique_ptr<LoadedScene> loaded) {
  Request request = request_of(Request::Kind::kExchange);
  request.room.reserve(loaded->simulation.world().max_values_of_state());
  request.scene = std::move(loaded);
  return request;
}

TEST(Runner, GoesOnBitForBitWhenTheNewParametersAreTheOldOnes) {
  Runner straight(loaded_scene_of(swing_text()), false);
  Runner exchanged(loaded_scene_of(swing_text()), false);
  for (std::uint64_t n = 1; n <= 400; ++n) {
    turn(straight, n, -0.005);
    turn(exchanged, n, -0.005);
    if (n != 200) continue;
    Request request = exchange_for(loaded_scene_of(swing_text()));
    exchanged.execute(request);
    ASSERT_TRUE(request.done);
  }
  EXPECT_EQ(exchanged.simulation().world().state_hash(),
            straight.simulation().world().state_hash());
  EXPECT_DOUBLE_EQ(exchanged.played_s(), straight.played_s());
  EXPECT_EQ(exchanged.simulation().world().energy().dissipated,
            straight.simulation().world().energy().dissipated);
}

TEST(Runner, TakesOverMotionForceAndAccountWithNewParameters) {
  Runner runner(loaded_scene_of(swing_text()), false);
  std::uint64_t number = 0;
  for (int i = 0; i < 300; ++i) turn(runner, ++number, -0.01);
  const engine::Vec3 position = runner.simulation().world().position(1);
  const engine::Vec3 velocity = runner.simulation().world().velocity(1);
  const std::uint64_t hash = runner.simulation().world().state_hash();
  Request request = exchange_for(stage_with_stiffness(300.0));

  const test::AllocationGuard guard;
  runner.execute(request);
  EXPECT_EQ(guard.count(), 0u);

  const engine::World& world = runner.simulation().world();
  EXPECT_TRUE(request.done);
  EXPECT_EQ(world.state_hash(), hash);
  EXPECT_EQ(world.position(1), position);
  EXPECT_EQ(world.velocity(1), velocity);
  EXPECT_EQ(world.network().description().links[0].stiffness, 300.0);
  const double threefold = 3.0 * force_of_key(runner);
  turn(runner, ++number, -0.01);
  EXPECT_NEAR(force_of_key(runner), threefold, 0.02 * std::abs(threefold)) << "at once";

  for (int i = 0; i < 2500; ++i) turn(runner, ++number, -0.01);
  const engine::Energy energy = runner.simulation().world().energy();
  EXPECT_NE(energy.switching, 0.0);
  EXPECT_LT(std::abs(energy.residual()), 1e-9 * energy.largest) << "the account closes";
}

TEST(Runner, RefusesAStageThatDoesNotFitAndGoesOn) {
  Runner runner(loaded_scene_of(swing_text()), false);
  for (std::uint64_t n = 1; n <= 10; ++n) turn(runner, n, 0.0);
  auto scene = std::make_shared<scene::Scene>(*scene_of(swing_text()));
  scene->network.mats.push_back(scene->network.mats.back());
  scene->radius_m.push_back(0.0);
  scene->layout.push_back({});
  Request request = exchange_for(std::make_unique<LoadedScene>(scene, kEpochOfSim, 1));
  runner.execute(request);
  EXPECT_FALSE(request.done);
  EXPECT_EQ(steps_of(runner), 40u);
}

TEST(Runner, AllocatesNothingWhatever) {
  Runner runner(loaded_scene_of(swing_text()), false);
  Request restart = request_of(Request::Kind::kRestart);
  restart.scene = loaded_scene_of(swing_text("other"), 2);
  Request pause = request_of(Request::Kind::kPause);
  Request step = request_of(Request::Kind::kStep, 5);
  Request resume = request_of(Request::Kind::kResume);

  const test::AllocationGuard guard;
  for (Request* request : {&pause, &step, &restart, &resume}) {
    runner.execute(*request);
    runner.advance();
    runner.advance();
  }
  EXPECT_EQ(guard.count(), 0u);
}

}  // namespace
}  // namespace cordis::sim
