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

void execute(Runner& player, Request request) {
  player.execute(request);
}

/// A turn in which the key sends a position.
bool turn(Runner& player, std::uint64_t number, double position_m) {
  DeviceExchange& key = player.simulation().devices().front();
  key.receive(key_sample(number, position_m));
  return player.advance();
}

double force_of_key(Runner& player) {
  DeviceExchange& key = player.simulation().devices().front();
  return key.answer_forces(player.simulation().world(), true, 0).force_n()[0];
}

std::uint64_t steps_of(const Runner& player) {
  return player.simulation().world().step_count();
}

TEST(Runner, PlaysATickPerTurn) {
  Runner player(stage_of(swing_text()), false);
  EXPECT_TRUE(player.advance());
  EXPECT_EQ(steps_of(player), 4u);
}

TEST(Runner, StandsStillWhilePausedAndGoesOnWhereItWas) {
  Runner straight(stage_of(swing_text()), true);
  Runner paused(stage_of(swing_text()), true);
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
  Runner player(stage_of(swing_text()), true);
  turn(player, 1, 0.0);
  execute(player, request_of(Request::Kind::kStep, 6));

  EXPECT_TRUE(turn(player, 2, 0.0));
  EXPECT_EQ(steps_of(player), 8u);
  EXPECT_FALSE(turn(player, 3, 0.0)) << "the tick is not complete";
  EXPECT_EQ(steps_of(player), 10u);
  EXPECT_FALSE(player.moves());
  EXPECT_FALSE(player.advance());
  EXPECT_EQ(steps_of(player), 10u);
}

TEST(Runner, CompletesATickBegunInSingleStepsAsIfItHadNotBeenInterrupted) {
  Runner straight(stage_of(swing_text()), true);
  Runner stepped(stage_of(swing_text()), true);
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
  Runner player(stage_of(swing_text()), /*devices_wait=*/false);
  std::uint64_t number = 0;
  for (int i = 0; i < 300; ++i) turn(player, ++number, -0.01);
  ASSERT_GT(std::abs(force_of_key(player)), 0.1);

  execute(player, request_of(Request::Kind::kPause));
  turn(player, ++number, -0.01);
  EXPECT_EQ(force_of_key(player), 0.0);
  for (int i = 0; i < 50; ++i) turn(player, ++number, -0.03);
  EXPECT_EQ(force_of_key(player), 0.0);

  execute(player, request_of(Request::Kind::kResume));
  turn(player, ++number, -0.03);
  EXPECT_LT(std::abs(force_of_key(player)), 100.0 * 0.03 / 20.0) << "a hundredth of the force";
  for (int i = 0; i < 300; ++i) turn(player, ++number, -0.03);
  EXPECT_GT(std::abs(force_of_key(player)), 0.5);
}

TEST(Runner, BeginsAnotherStageAndHandsTheOldOneBack) {
  Runner player(stage_of(swing_text()), false);
  for (std::uint64_t n = 1; n <= 200; ++n) turn(player, n, -0.01);
  const LoadedScene* before = &player.stage();
  Request request = request_of(Request::Kind::kRestart);
  request.stage = stage_of(swing_text("other", 500.0), 2);
  const LoadedScene* next = request.stage.get();

  player.execute(request);

  EXPECT_EQ(&player.stage(), next);
  EXPECT_EQ(request.stage.get(), before);
  EXPECT_EQ(request.step, 800u);
  EXPECT_EQ(steps_of(player), 0u);
  EXPECT_NEAR(player.played_s(), 0.2, 1e-12) << "the time played goes on";
  EXPECT_EQ(force_of_key(player), 0.0);
  turn(player, 201, -0.01);
  EXPECT_NEAR(player.played_s(), 0.202, 1e-12);
}

TEST(Runner, StaysPausedWithAnotherStage) {
  Runner player(stage_of(swing_text()), false);
  execute(player, request_of(Request::Kind::kPause));
  Request request = request_of(Request::Kind::kRestart);
  request.stage = stage_of(swing_text(), 2);
  player.execute(request);
  EXPECT_TRUE(request.was_paused);
  EXPECT_FALSE(player.advance());
  EXPECT_EQ(steps_of(player), 0u);
}

/// The swing with another stiffness of its springs.
std::unique_ptr<LoadedScene> stage_with_stiffness(double stiffness) {
  auto scene = std::make_shared<scene::Scene>(*scene_of(swing_text()));
  for (engine::Link& link : scene->network.links) link.stiffness = stiffness;
  return std::make_unique<LoadedScene>(scene, kEpochOfSim, 1);
}

Request exchange_for(std::unique_ptr<LoadedScene> stage) {
  Request request = request_of(Request::Kind::kExchange);
  request.room.reserve(stage->simulation.world().max_values_of_state());
  request.stage = std::move(stage);
  return request;
}

TEST(Runner, GoesOnBitForBitWhenTheNewParametersAreTheOldOnes) {
  Runner straight(stage_of(swing_text()), false);
  Runner exchanged(stage_of(swing_text()), false);
  for (std::uint64_t n = 1; n <= 400; ++n) {
    turn(straight, n, -0.005);
    turn(exchanged, n, -0.005);
    if (n != 200) continue;
    Request request = exchange_for(stage_of(swing_text()));
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
  Runner player(stage_of(swing_text()), false);
  std::uint64_t number = 0;
  for (int i = 0; i < 300; ++i) turn(player, ++number, -0.01);
  const engine::Vec3 position = player.simulation().world().position(1);
  const engine::Vec3 velocity = player.simulation().world().velocity(1);
  const std::uint64_t hash = player.simulation().world().state_hash();
  Request request = exchange_for(stage_with_stiffness(300.0));

  const test::AllocationGuard guard;
  player.execute(request);
  EXPECT_EQ(guard.count(), 0u);

  const engine::World& world = player.simulation().world();
  EXPECT_TRUE(request.done);
  EXPECT_EQ(world.state_hash(), hash);
  EXPECT_EQ(world.position(1), position);
  EXPECT_EQ(world.velocity(1), velocity);
  EXPECT_EQ(world.network().description().links[0].stiffness, 300.0);
  const double threefold = 3.0 * force_of_key(player);
  turn(player, ++number, -0.01);
  EXPECT_NEAR(force_of_key(player), threefold, 0.02 * std::abs(threefold)) << "at once";

  for (int i = 0; i < 2500; ++i) turn(player, ++number, -0.01);
  const engine::Energy energy = player.simulation().world().energy();
  EXPECT_NE(energy.switching, 0.0);
  EXPECT_LT(std::abs(energy.residual()), 1e-9 * energy.largest) << "the account closes";
}

TEST(Runner, RefusesAStageThatDoesNotFitAndGoesOn) {
  Runner player(stage_of(swing_text()), false);
  for (std::uint64_t n = 1; n <= 10; ++n) turn(player, n, 0.0);
  auto scene = std::make_shared<scene::Scene>(*scene_of(swing_text()));
  scene->network.mats.push_back(scene->network.mats.back());
  scene->radius_m.push_back(0.0);
  scene->layout.push_back({});
  Request request = exchange_for(std::make_unique<LoadedScene>(scene, kEpochOfSim, 1));
  player.execute(request);
  EXPECT_FALSE(request.done);
  EXPECT_EQ(steps_of(player), 40u);
}

TEST(Runner, AllocatesNothingWhatever) {
  Runner player(stage_of(swing_text()), false);
  Request restart = request_of(Request::Kind::kRestart);
  restart.stage = stage_of(swing_text("other"), 2);
  Request pause = request_of(Request::Kind::kPause);
  Request step = request_of(Request::Kind::kStep, 5);
  Request resume = request_of(Request::Kind::kResume);

  const test::AllocationGuard guard;
  for (Request* request : {&pause, &step, &restart, &resume}) {
    player.execute(*request);
    player.advance();
    player.advance();
  }
  EXPECT_EQ(guard.count(), 0u);
}

}  // namespace
}  // namespace cordis::sim
