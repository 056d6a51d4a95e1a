// tests/engine/freezing_test.cpp -- what is left out of a step while it rests, and that nothing
// else knows of it.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "sim_node/engine/core/vector_width.h"
#include "tests/engine/programs.h"
#include "tests/engine/struck_chain.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/rounds.h"

namespace cordis::test {
namespace {

using engine::IntegratorKind;

TEST(Freezing, LetsAPulseIntoWhatRests) {
  constexpr std::uint32_t kCount = 100;
  constexpr double kTolerance = 1e-4 * kPeak;
  const NetworkDescription scene = bedded_chain(kCount);
  World whole = make_world(scene);
  World part = make_world(frozen(scene, kTolerance));
  run(part, 101);
  ASSERT_EQ(part.asleep_count(), kCount);

  std::vector<int> arrival(kCount + 1, 0);
  for (int n = 0; n < 400; ++n) {
    for (World* world : {&whole, &part}) {
      const double way = 0.5 * kPeak * (1.0 - std::cos(0.1 * std::min(n + 1, 62)));
      world->impose_position(kCount + 1, scene.mats[kCount + 1].position - Vec3(way, 0, 0));
      world->step();
    }
    for (std::uint32_t i = 1; i <= kCount; ++i) {
      const double moved = (whole.position(i) - scene.mats[i].position).norm();
      if (arrival[i] == 0 && moved > 20.0 * kTolerance) {
        arrival[i] = n;
        EXPECT_FALSE(part.is_asleep(i)) << "MAT " << i << " at step " << n;
      }
    }
  }
  EXPECT_GT(arrival[20], 0);
}

/// Two clusters that no liaison joins: the second is at rest.
NetworkDescription two_pieces(int dimension) {
  NetworkDescription scene = free_cluster(30, 90, 0.05, dimension);
  const NetworkDescription other = scene;
  for (const Mat& mat : other.mats) {
    scene.mats.push_back(mat);
    scene.mats.back().velocity = Vec3::Zero();
  }
  for (Link link : other.links) {
    link.mat_a += 30;
    link.mat_b += 30;
    Vec3 along = scene.mats[link.mat_b].position - scene.mats[link.mat_a].position;
    link.rest_length = dimension == 1 ? along.x() : along.norm();
    scene.links.push_back(link);
  }
  return scene;
}

TEST(Freezing, IsNotKnownToWhatIsAwake) {
  for (const IntegratorKind integrator : {IntegratorKind::kCordis, IntegratorKind::kLeapfrog}) {
    for (const int dimension : {1, 2, 3}) {
      NetworkDescription scene = two_pieces(dimension);
      scene.integrator = integrator;
      World whole = make_world(scene);
      World part = make_world(frozen(scene, 1e-9));
      run(whole, 300);
      run(part, 300);

      EXPECT_EQ(part.asleep_count(), 30U);
      for (std::uint32_t i = 0; i < 30; ++i) {
        EXPECT_EQ(part.position(i), whole.position(i)) << "MAT " << i;
        EXPECT_EQ(part.velocity(i), whole.velocity(i)) << "MAT " << i;
        EXPECT_EQ(part.link_force(i), whole.link_force(i)) << "MAT " << i;
      }
    }
  }
}

/// Links of all kinds, that come to rest.
NetworkDescription scene_of_all_links(int dimension) {
  NetworkDescription scene = free_cluster(30, 90, 2.0, dimension);
  scene.medium_viscosity = 0.3;
  scene.mats.push_back(port(Vec3::Zero()));
  scene.links.push_back({3, 30, 50.0, 0.1, 0.2});
  scene.maxwell_links = {{1, 2, 30.0, 0.5}, {7, 11, 40.0, 0.2}};
  Behaving contact;
  contact.state(0.0).exit(size(q(engine::Quantity::kDistance)) < 0.3, 1);
  contact.state(20.0, 1.0).exit(size(q(engine::Quantity::kDistance)) > 0.3, 0);
  scene.state_machines = {contact.state_machine};
  for (std::uint32_t i = 0; i + 9 < 30; ++i) scene.state_links.push_back({i, i + 9, 0, 0.3});
  return scene;
}

TEST(Freezing, KeepsTheAccount) {
  for (const int dimension : {1, 3}) {
    World world = make_world(frozen(scene_of_all_links(dimension), 1e-4));
    std::uint32_t max_asleep = 0;
    for (int n = 0; n < rounds(20000); ++n) {
      if (n == 14000) world.impose_position(30, Vec3(0.3, 0, 0));
      world.step();
      max_asleep = std::max(max_asleep, world.asleep_count());
      const engine::Energy energy = world.energy();
      ASSERT_LT(std::abs(energy.residual()), 1e-9 * energy.largest) << "step " << n;
    }
    EXPECT_TRUE(rounds(10) < 10 || max_asleep > 25U) << max_asleep;
  }
}

TEST(Freezing, OfLeapfrogLosesWhatItStops) {
  NetworkDescription scene = bedded_chain(40);
  scene.integrator = IntegratorKind::kLeapfrog;
  World whole = make_world(scene);
  World part = make_world(frozen(scene, 1e-3 * kPeak));
  for (int n = 0; n < 2500; ++n) {
    for (World* world : {&whole, &part}) {
      strike(*world, 41, scene.mats[41].position);
      world->step();
    }
  }
  EXPECT_GT(part.asleep_count(), 20U);
  // what finite steps do is the same, the tolerance apart
  EXPECT_NEAR(part.energy().residual(), whole.energy().residual(), 2e-3 * part.energy().largest);
}

TEST(Freezing, GoesOnFromASnapshotBitForBit) {
  for (const IntegratorKind integrator : {IntegratorKind::kCordis, IntegratorKind::kLeapfrog}) {
    NetworkDescription scene = frozen(bedded_chain(60), 1e-4 * kPeak);
    scene.integrator = integrator;
    World first = make_world(scene);
    const auto go_on = [&scene](World& world, int steps) {
      for (int n = 0; n < steps; ++n) {
        strike(world, 61, scene.mats[61].position);
        world.step();
      }
    };
    for (int n = 0; n < 1200; n += 37) {
      go_on(first, 37);
      const engine::Snapshot snapshot = first.snapshot();
      World second = make_world(scene);
      go_on(second, n % 64);
      second.restore(snapshot);
      ASSERT_EQ(second.state_hash(), first.state_hash()) << "step " << n;
      ASSERT_EQ(second.asleep_count(), first.asleep_count());
      World third = make_world(scene);
      third.restore(snapshot);
      go_on(second, 50);
      go_on(third, 50);
      ASSERT_EQ(second.state_hash(), third.state_hash()) << "step " << n;
      World same = make_world(scene);
      go_on(same, n + 37 + 50);
      ASSERT_EQ(second.state_hash(), same.state_hash()) << "step " << n;
      ASSERT_EQ(second.energy().total(), same.energy().total()) << "step " << n;
      ASSERT_EQ(second.energy().dissipated, same.energy().dissipated) << "step " << n;
    }
  }
}

TEST(Freezing, IsTheSameBitsForEveryWidth) {
  for (const int dimension : {1, 3}) {
    std::vector<std::uint64_t> hashes;
    for (const VectorWidth width : engine::supported_vector_widths()) {
      World world = make_world(frozen(scene_of_all_links(dimension), 1e-4), width);
      run(world, rounds(6000));
      hashes.push_back(world.state_hash());
      EXPECT_EQ(hashes.back(), hashes.front()) << to_string(width);
    }
  }
}

TEST(Freezing, LeavesOutNothingThatFliesOrIsHeld) {
  NetworkDescription scene;
  scene.dimension = 2;
  scene.step = 1e-4;
  scene.gravity = Vec3(0, -9.81, 0);
  Behaving contact;
  contact.state(1e6);  // a 4th of its tolerance pulls 25 times the weight of the ball
  contact.state_machine.states[0].pulls = false;
  scene.state_machines = {contact.state_machine};
  scene.mats = {fixed(Vec3::Zero()), mass(0.01, Vec3(0, 0.02, 0), Vec3(0, 0.05, 0)),
                mass(0.01, Vec3(1, 0, 0)), fixed(Vec3(2, 0, 0))};
  scene.state_links = {{0, 1, 0, 0.01}};
  scene.links = {{2, 3, 1000.0, 5.0, 1.0}};
  scene.freeze_tolerance = 1e-5;
  World world = make_world(scene);
  world.set_external_force(2, Vec3(0, 0.0981, 0));

  for (int n = 0; n < 200; ++n) {  // the ball turns about at step 51
    world.step();
    ASSERT_EQ(world.asleep_count(), 0U) << "step " << n;
  }

  world.set_external_force(2, Vec3::Zero());
  world.step();
  EXPECT_FALSE(world.is_asleep(2));
  EXPECT_NE(world.velocity(2), Vec3::Zero());
}

TEST(Freezing, DoesNotStopAMassWithoutStiffness) {
  NetworkDescription scene;
  scene.dimension = 1;
  scene.step = 1e-3;
  scene.mats = {fixed(Vec3::Zero()), mass(1.0, Vec3(0.1, 0, 0), Vec3(1e-9, 0, 0))};
  scene.links = {{0, 1, 0.0, 1e-6, 0.0}};
  scene.freeze_tolerance = 1e-3;
  World world = make_world(scene);

  run(world, 100);

  EXPECT_EQ(world.asleep_count(), 0U);
}

TEST(Freezing, DoesNotStopAMassWhoseStiffnessIsTakenAway) {
  NetworkDescription scene;
  scene.dimension = 1;
  scene.step = 1e-3;
  scene.mats = {fixed(Vec3::Zero()), mass(1.0, Vec3(0.1, 0, 0), Vec3(1e-3, 0, 0))};
  scene.state_machines = {Behaving().state(1.0).state_machine};
  scene.state_links = {{0, 1, 0, 0.1}};
  scene.freeze_tolerance = 1e-3;
  World world = make_world(scene);
  world.replace_state_machine(0, Behaving().state(0.0).state_machine);

  run(world, 1000);

  EXPECT_EQ(world.asleep_count(), 0U);
  EXPECT_NEAR(world.position(1).x(), 0.101, 1e-9);  // free flight: 1 mm/s for 1 s
}

/// Two masses at rest on springs, and a link with states between them.
NetworkDescription resting_pair(const Behaving& state_machine) {
  NetworkDescription scene;
  scene.dimension = 1;
  scene.step = 1e-3;
  scene.mats = {fixed(Vec3::Zero()), mass(0.01, Vec3(0.1, 0, 0)), mass(0.01, Vec3(0.2, 0, 0)),
                fixed(Vec3(0.3, 0, 0))};
  scene.links = {{0, 1, 100.0, 0.1, 0.1}, {2, 3, 100.0, 0.1, 0.1}};
  scene.state_machines = {state_machine.state_machine};
  scene.state_links = {{1, 2, 0, 0.15}};
  scene.freeze_tolerance = 1e-5;
  return scene;
}

TEST(Freezing, WakesWhereAnAgeRunsOut) {
  Behaving fuse;
  fuse.state(0.0).exit(q(engine::Quantity::kAge) > 0.2, 1);
  fuse.state(50.0);
  World world = make_world(resting_pair(fuse));
  run(world, 190);
  ASSERT_EQ(world.asleep_count(), 2U);

  run(world, 20);

  EXPECT_EQ(world.state_of(0), 1U);
  EXPECT_EQ(world.asleep_count(), 0U);
  EXPECT_LT(world.position(1).x(), 0.1);
  EXPECT_GT(world.position(2).x(), 0.2);
}

TEST(Freezing, WakesWhatIsTouched) {
  Behaving hook;
  hook.state(0.0);
  hook.state(50.0);
  const NetworkDescription scene = resting_pair(hook);
  World world = make_world(scene);
  run(world, 110);
  ASSERT_EQ(world.asleep_count(), 2U);

  world.force_state(0, 1);
  EXPECT_EQ(world.asleep_count(), 0U);
  run(world, 2);
  EXPECT_NE(world.velocity(1), Vec3::Zero());

  World other = make_world(scene);
  run(other, 110);
  other.set_external_force(1, Vec3(0.01, 0, 0));
  EXPECT_FALSE(other.is_asleep(1));
  EXPECT_TRUE(other.is_asleep(2));
  other.step();
  EXPECT_GT(other.velocity(1).x(), 0.0);

  World changed = make_world(scene);
  run(changed, 110);
  engine::StateMachine stiff = scene.state_machines[0];
  stiff.states[0].stiffness = 20.0;
  changed.replace_state_machine(0, stiff);
  EXPECT_EQ(changed.asleep_count(), 0U);
  changed.step();
  EXPECT_NE(changed.velocity(1), Vec3::Zero());

  NetworkDescription edited = scene;
  edited.gravity = Vec3(1.0, 0, 0);
  World after = make_world(edited);
  World before = make_world(scene);
  run(before, 110);
  std::vector<double> room;
  room.reserve(after.max_values_of_state());
  ASSERT_TRUE(after.take_over(before, room));
  EXPECT_EQ(after.asleep_count(), 0U);
  after.step();
  EXPECT_GT(after.velocity(1).x(), 0.0);

  NetworkDescription never = scene;
  never.freeze_tolerance = 0.0;
  World without = make_world(never);
  EXPECT_FALSE(without.take_over(before, room));
}

TEST(Freezing, LetsAMaxwellElementFade) {
  // A mass between a spring and a Maxwell element: released at rest it creeps home as the force of
  // the element fades.
  NetworkDescription scene;
  scene.dimension = 1;
  scene.step = 1e-3;
  scene.mats = {fixed(Vec3::Zero()), mass(0.01, Vec3(0.12, 0, 0)), port(Vec3(0.2, 0, 0))};
  scene.links = {{0, 1, 50.0, 0.3, 0.1}};
  scene.maxwell_links = {{1, 2, 200.0, 40.0}};
  scene.freeze_tolerance = 1e-6;
  World world = make_world(scene);
  scene.freeze_tolerance = 0.0;
  World whole = make_world(scene);

  for (int n = 0; n < 31; ++n) {
    run(world, 500);
    run(whole, 500);
    EXPECT_NEAR(world.position(1).x(), whole.position(1).x(), 20e-6) << "step " << 500 * n;
  }
  EXPECT_TRUE(world.is_asleep(1));
}

TEST(Freezing, StepsWithoutAllocating) {
  World world = make_world(frozen(scene_of_all_links(3), 1e-4));
  const AllocationGuard guard;

  run(world, rounds(4000));
  world.impose_position(30, Vec3(0.5, 0, 0));
  run(world, rounds(1000));

  EXPECT_EQ(guard.count(), 0U);
}

TEST(Freezing, IsRefusedWhereItCannotBeKept) {
  for (const IntegratorKind integrator :
       {IntegratorKind::kImplicit, IntegratorKind::kModal, IntegratorKind::kSymplectic4}) {
    NetworkDescription scene = oscillator(1.0, 1.0, 0.0, 0.1, 0.0, 1e-3);
    scene.integrator = integrator;
    EXPECT_NO_THROW(make_world(scene));
    EXPECT_THROW(make_world(frozen(scene, 1e-6)), std::invalid_argument) << to_string(integrator);
  }
  NetworkDescription implicit = oscillator(1.0, 1.0, 400.0, 0.1, 0.0, 1e-3);
  implicit.integrator = IntegratorKind::kLeapfrog;
  EXPECT_THROW(make_world(frozen(implicit, 1e-6)), std::invalid_argument);
  EXPECT_THROW(make_world(frozen(bedded_chain(3), kNan)), std::invalid_argument);
  NetworkDescription kept = frozen(bedded_chain(3), 1e-6);
  kept.kept_awake = {99};
  EXPECT_THROW(make_world(kept), std::invalid_argument);
}

TEST(Freezing, KeepsAwakeWhoseForceIsAskedFor) {
  NetworkDescription scene = bedded_chain(10);
  scene.gravity = Vec3(-9.81, 0, 0);
  scene.medium_viscosity = 0.1;
  World whole = make_world(scene);
  scene.kept_awake = {0, 3};
  World world = make_world(frozen(scene, 1e-9));
  run(whole, 4000);
  run(world, 4000);

  EXPECT_EQ(world.asleep_count(), 9U);
  EXPECT_NEAR(world.link_force(0).x(), whole.link_force(0).x(), 20e-9 * 1003.0);
}

TEST(Freezing, ShowsTheForceOnWhatSleeps) {
  NetworkDescription scene = frozen(bedded_chain(50), 1e-7);
  scene.medium_viscosity = 0.1;
  scene.gravity = Vec3(-9.81, 0, 0);
  World world = make_world(scene);
  run(world, 3000);
  ASSERT_EQ(world.asleep_count(), 50U);

  for (int n = 0; n < 40; ++n) {
    strike(world, 51, scene.mats[51].position + Vec3(1e-3, 0, 0));
    world.step();
  }

  ASSERT_GT(world.asleep_count(), 0U);
  ASSERT_LT(world.asleep_count(), 50U);
  for (std::uint32_t i = 1; i <= 50; ++i) {
    if (!world.is_asleep(i)) continue;
    EXPECT_NEAR(world.link_force(i).x(), 1e-3 * 9.81, 1e-7 * 1003.0) << "MAT " << i;
  }
}

}  // namespace
}  // namespace cordis::test
