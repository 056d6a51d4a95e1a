// tests/engine/snapshot_test.cpp
#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/engine/scenes.h"

namespace cordis::test {
namespace {

/// A free cluster with a port, in a medium, under gravity.
NetworkDescription scene_with_everything() {
  NetworkDescription scene = free_cluster(20, 61, 0.2);
  scene.gravity = Vec3(0, 0, -9.81);
  scene.medium_viscosity = 0.01;
  scene.mats.push_back(port(Vec3::Zero()));
  scene.links.push_back({3, 20, 50.0, 0.1, 0.2});
  return scene;
}

/// The outside of a step: a port in motion, forces that begin at different steps.
void drive(World& world, int step_count) {
  for (int n = 0; n < step_count; ++n) {
    const auto now = static_cast<double>(world.step_count());
    world.impose_position(20, Vec3(0.001 * now, 0.0, 0.0));
    world.set_external_force(static_cast<std::uint32_t>(world.step_count() % 7), Vec3(0, now, 0));
    world.step();
  }
}

void expect_same_motion(const World& first, const World& second) {
  EXPECT_EQ(first.state_hash(), second.state_hash());
  EXPECT_EQ(first.step_count(), second.step_count());
  const engine::Energy one = first.energy();
  const engine::Energy other = second.energy();
  EXPECT_EQ(one.kinetic, other.kinetic);
  EXPECT_EQ(one.elastic, other.elastic);
  EXPECT_EQ(one.gravity, other.gravity);
  EXPECT_EQ(one.dissipated, other.dissipated);
  EXPECT_EQ(one.port_work, other.port_work);
  EXPECT_EQ(one.initial, other.initial);
  EXPECT_EQ(one.largest, other.largest);
  for (std::uint32_t i = 0; i < first.network().mat_count(); ++i) {
    EXPECT_EQ(first.link_force(i), second.link_force(i)) << "MAT " << i;
    EXPECT_EQ(first.velocity(i), second.velocity(i)) << "MAT " << i;
  }
}

TEST(Snapshot, IsGoneOnFromBitForBitInAnotherWorld) {
  World first = make_world(scene_with_everything());
  drive(first, 50);
  first.impose_position(20, Vec3(0.3, 0.1, 0.0));  // still to come
  const engine::Snapshot snapshot = first.snapshot();

  World second = make_world(scene_with_everything());
  second.set_external_force(11, Vec3(1, 1, 1));  // to be forgotten
  second.restore(snapshot);

  expect_same_motion(first, second);
  first.step();
  second.step();
  expect_same_motion(first, second);
  drive(first, 50);
  drive(second, 50);
  expect_same_motion(first, second);
}

TEST(Snapshot, TakesAWorldBack) {
  World world = make_world(scene_with_everything());
  drive(world, 20);
  const engine::Snapshot snapshot = world.snapshot();
  drive(world, 30);
  const std::uint64_t hash = world.state_hash();

  world.restore(snapshot);
  EXPECT_EQ(world.step_count(), 20U);
  drive(world, 30);

  EXPECT_EQ(world.state_hash(), hash);
}

TEST(Snapshot, OfAnotherNetworkIsRefused) {
  NetworkDescription other = scene_with_everything();
  other.links[5].stiffness += 1.0;
  World world = make_world(scene_with_everything());

  EXPECT_THROW(world.restore(make_world(other).snapshot()), std::invalid_argument);
}

TEST(Snapshot, OfAForceHeldOnAFixedPointIsRefused) {
  NetworkDescription scene = free_cluster(3, 61, 0.2);
  scene.mats.push_back(scene.mats[0]);
  scene.mats[3].kind = engine::MatKind::kFixed;
  scene.mats[3].mass = 0.0;
  scene.mats[3].velocity = Vec3::Zero();
  World world = make_world(scene);
  world.set_external_force(2, Vec3(1, 0, 0));
  engine::Snapshot snapshot = world.snapshot();
  double& held = snapshot.state[snapshot.state.size() - 4];  // before the 3 values of the force
  ASSERT_EQ(held, 2.0);
  held = 3.0;
  EXPECT_THROW(world.restore(snapshot), std::invalid_argument);
  held = 1.0;
  EXPECT_NO_THROW(world.restore(snapshot));
}

TEST(Snapshot, ThatIsCutShortIsRefused) {
  World world = make_world(scene_with_everything());
  drive(world, 5);
  engine::Snapshot snapshot = world.snapshot();
  while (!snapshot.state.empty()) {
    snapshot.state.pop_back();
    ASSERT_THROW(world.restore(snapshot), std::invalid_argument) << snapshot.state.size();
  }
}

TEST(StateHash, SeesTheLastBitOfAPosition) {
  NetworkDescription scene = scene_with_everything();
  const std::uint64_t hash = make_world(scene).state_hash();
  scene.mats[20].position.x() = 5e-324;

  EXPECT_NE(make_world(scene).state_hash(), hash);
}

TEST(StateHash, SeesTheStepCountAndTheSpeed) {
  NetworkDescription scene;
  scene.step = 1.0;
  scene.mats = {fixed(Vec3::Zero())};
  World resting = make_world(scene);
  const std::uint64_t before = resting.state_hash();
  resting.step();
  EXPECT_NE(resting.state_hash(), before);

  scene.mats = {mass(1.0, Vec3::Zero())};
  const std::uint64_t at_rest = make_world(scene).state_hash();
  scene.mats[0].velocity.z() = 1.0;
  EXPECT_NE(make_world(scene).state_hash(), at_rest);
}

}  // namespace
}  // namespace cordis::test
