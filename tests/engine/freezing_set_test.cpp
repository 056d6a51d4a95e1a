// tests/engine/freezing_set_test.cpp -- pairs of a set that are left out of a step while they rest.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "sim_node/engine/core/vector_width.h"
#include "tests/engine/balls.h"
#include "tests/engine/programs.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/rounds.h"

namespace cordis::test {
namespace {

using engine::IntegratorKind;

constexpr double kSpacing = 0.01;  // [m]
constexpr double kTolerance = 1e-7;

/// Bound where they met, and torn off beyond a stretch.
StateMachine sticky_balls(double age_of_wear) {
  Behaving stick;
  stick.state(0.0).exit(q(engine::Quantity::kDistance) < 1.1 * kSpacing, 1, RestRule::kHere);
  stick.state(200.0, 0.3).exit(q(engine::Quantity::kElongation) > 0.5 * kSpacing, 0);
  if (age_of_wear > 0.0) {
    stick.exit(q(engine::Quantity::kAge) > age_of_wear, 2);
    stick.state(20.0, 0.3);
  }
  return stick.state_machine;
}

struct BallLaw {
  std::string name;
  StateMachine state_machine;
};

std::vector<BallLaw> ball_laws() {
  const auto stateless = [](const LinkState& state) {
    StateMachine state_machine;
    state_machine.states = {state};
    return state_machine;
  };
  LinkState spring = contact(200.0, 0.3);
  spring.pulls = true;
  const double diameter = kSpacing / std::pow(2.0, 1.0 / 6.0);
  const LinkState bare = lennard_jones(200.0 * diameter * diameter / 57.14628, diameter, 0.0);
  LinkState damped = bare;
  damped.viscosity = 0.3;
  if (rounds(10) < 10) return {{"states", sticky_balls(0.0)}};
  return {{"spring", stateless(spring)},
          {"bare Lennard-Jones", stateless(bare)},
          {"damped Lennard-Jones", stateless(damped)},
          {"states", sticky_balls(0.0)}};
}

void add_set_of_all(NetworkDescription& scene, const StateMachine& state_machine) {
  SetLiaison set;
  set.range = 1.4 * kSpacing;
  set.rest_length = kSpacing;
  for (std::uint32_t i = 0; i < scene.mats.size(); ++i) set.set_p.push_back(i);
  scene.state_machines.push_back(state_machine);
  scene.sets.push_back(set);
}

/// Balls in rows of 24 in a plane, each in the gap of the two below, the lowest row fixed.
NetworkDescription wall(std::uint32_t rows, const StateMachine& state_machine) {
  NetworkDescription scene;
  scene.dimension = 2;
  scene.step = 2e-4;
  scene.gravity = Vec3(0, -9.81, 0);
  scene.medium_viscosity = 0.1;
  for (std::uint32_t row = 0; row < rows; ++row) {
    for (std::uint32_t i = 0; i < 24; ++i) {
      const Vec3 place(kSpacing * (i + 0.5 * (row % 2)), std::sqrt(0.75) * kSpacing * row, 0);
      scene.mats.push_back(row == 0 ? fixed(place) : mass(1e-3, place));
    }
  }
  add_set_of_all(scene, state_machine);
  return scene;
}

std::string key_of(std::string name, IntegratorKind integrator) {
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == ' ' || c == '-'; }, '_');
  return name + '_' + to_string(integrator);
}

/// Errors in tolerances, and the part that was awake.
std::string numbers(double usual, double largest, double awake) {
  return std::to_string(usual) + ", at most " + std::to_string(largest) + ", awake " +
         std::to_string(awake);
}

/// Pushes the last ball for a while.
void poke(World& world, std::uint64_t from) {
  const bool pushed = world.step_count() >= from && world.step_count() < from + 60;
  world.set_external_force(static_cast<std::uint32_t>(world.network().mat_count() - 1),
                           pushed ? Vec3(-0.02, -0.02, 0) : Vec3(Vec3::Zero()));
}

constexpr std::uint64_t kSettled = 2900;  // steps; the first trial of sleepers has ended

TEST(FreezingSet, IsOffByLessThanTenTolerances) {
  for (const IntegratorKind integrator : {IntegratorKind::kCordis, IntegratorKind::kLeapfrog}) {
    for (const BallLaw& law : ball_laws()) {
      NetworkDescription scene = wall(8, law.state_machine);
      scene.integrator = integrator;
      World whole = make_world(scene);
      scene.freeze_tolerance = kTolerance;
      World part = make_world(scene);
      run(whole, kSettled);
      run(part, kSettled);
      ASSERT_EQ(part.asleep_count(), 7U * 24U) << law.name;

      double square = 0.0;
      double largest = 0.0;
      double awake = 0.0;
      constexpr int kSteps = 400;
      for (int n = 0; n < kSteps; ++n) {
        for (World* world : {&whole, &part}) {
          poke(*world, kSettled);
          world->step();
        }
        awake += (1.0 - part.asleep_count() / 168.0) / kSteps;
        for (std::uint32_t i = 24; i < scene.mats.size(); ++i) {
          const double error = (whole.position(i) - part.position(i)).norm() / kTolerance;
          square += error * error / (168.0 * kSteps);
          largest = std::max(largest, error);
        }
      }
      EXPECT_LT(std::sqrt(square), 10.0) << law.name << ' ' << to_string(integrator);
      EXPECT_LT(largest, 50.0) << law.name << ' ' << to_string(integrator);
      EXPECT_LT(awake, 0.95) << law.name << ' ' << to_string(integrator);
      EXPECT_GT(awake, 0.05) << law.name << ' ' << to_string(integrator);
      RecordProperty(key_of(law.name, integrator), numbers(std::sqrt(square), largest, awake));
    }
  }
}

/// A swarm that moves forever, and a patch far off, at rest without any force.
NetworkDescription swarm_and_patch(const StateMachine& state_machine, int dimension) {
  NetworkDescription scene = cloud(60, 0.06, 0.3, dimension);
  scene.radius.clear();
  scene.step = 1e-4;
  for (Mat& ball : scene.mats) ball.mass *= 1e-3;
  for (std::uint32_t i = 0; i < 12; ++i) {
    const Vec3 place(kSpacing * (i % 4), dimension > 1 ? kSpacing * (i / 4) : 0.0, 0);
    if (dimension == 1 && i >= 4) break;
    scene.mats.push_back(mass(1e-3, place + Vec3(100, 0, 0)));
  }
  add_set_of_all(scene, state_machine);
  return scene;
}

TEST(FreezingSet, IsNotKnownToWhatIsAwake) {
  for (const IntegratorKind integrator : {IntegratorKind::kCordis, IntegratorKind::kLeapfrog}) {
    for (const int dimension : {1, 2, 3}) {
      for (const BallLaw& law : ball_laws()) {
        NetworkDescription scene = swarm_and_patch(law.state_machine, dimension);
        scene.integrator = integrator;
        World whole = make_world(scene);
        scene.freeze_tolerance = 1e-9;
        World part = make_world(scene);
        for (int n = 0; n < 1100; ++n) {
          whole.step();
          part.step();
          ASSERT_EQ(whole.events().size(), part.events().size());
        }

        EXPECT_EQ(part.asleep_count(), dimension == 1 ? 4U : 12U) << law.name;
        for (std::uint32_t i = 0; i < 60; ++i) {
          ASSERT_EQ(part.position(i), whole.position(i)) << law.name << ", MAT " << i;
          ASSERT_EQ(part.link_force(i), whole.link_force(i)) << law.name << ", MAT " << i;
        }
      }
    }
  }
}

TEST(FreezingSet, KeepsTheAccount) {
  for (const BallLaw& law : ball_laws()) {
    NetworkDescription scene = wall(8, law.state_machine);
    scene.freeze_tolerance = kTolerance;
    World world = make_world(scene);
    for (int n = 0; n < rounds(3000); ++n) {
      poke(world, 2000);
      world.step();
      const engine::Energy energy = world.energy();
      ASSERT_LT(std::abs(energy.residual()), 1e-9 * energy.largest) << law.name << ", step " << n;
    }
  }
}

TEST(FreezingSet, GoesOnFromASnapshotBitForBit) {
  for (const IntegratorKind integrator : {IntegratorKind::kCordis, IntegratorKind::kLeapfrog}) {
    for (const BallLaw& law : ball_laws()) {
      NetworkDescription scene = wall(6, law.state_machine);
      scene.integrator = integrator;
      scene.freeze_tolerance = kTolerance;
      const auto go_on = [](World& world, int steps) {
        for (int n = 0; n < steps; ++n) {
          poke(world, 1600);
          world.step();
        }
      };
      World first = make_world(scene);
      World again = make_world(scene);
      for (int n = 0; n < 8; ++n) {
        go_on(first, 250);
        go_on(again, 100);
        again.restore(first.snapshot());
        go_on(again, 117);
        World straight = make_world(scene);
        straight.restore(first.snapshot());
        go_on(straight, 60);
        straight.restore(straight.snapshot());
        go_on(straight, 57);
        ASSERT_EQ(again.state_hash(), straight.state_hash()) << law.name << ", part " << n;
        ASSERT_EQ(again.energy().total(), straight.energy().total()) << law.name;
        ASSERT_EQ(again.energy().dissipated, straight.energy().dissipated) << law.name;
      }
      World uncut = make_world(scene);
      go_on(uncut, 2117);
      EXPECT_EQ(uncut.state_hash(), again.state_hash()) << law.name;
    }
  }
}

TEST(FreezingSet, IsTheSameBitsForEveryWidth) {
  for (const BallLaw& law : ball_laws()) {
    NetworkDescription scene = wall(6, law.state_machine);
    scene.freeze_tolerance = kTolerance;
    std::vector<std::uint64_t> hashes;
    for (const VectorWidth width : engine::supported_vector_widths()) {
      World world = make_world(scene, width);
      for (int n = 0; n < 2960; ++n) {
        poke(world, kSettled);
        world.step();
      }
      EXPECT_GT(world.asleep_count(), 0U) << law.name;
      hashes.push_back(world.state_hash());
      EXPECT_EQ(hashes.back(), hashes.front()) << law.name << ", " << to_string(width);
    }
  }
}

TEST(FreezingSet, StepsWithoutAllocating) {
  for (const BallLaw& law : ball_laws()) {
    NetworkDescription scene = wall(6, law.state_machine);
    scene.freeze_tolerance = kTolerance;
    World world = make_world(scene);
    world.set_external_force(140, Vec3::Zero());
    const AllocationGuard guard;
    for (int n = 0; n < 2960; ++n) {
      poke(world, kSettled);
      world.step();
    }
    EXPECT_EQ(guard.count(), 0U) << law.name;
  }
}

TEST(FreezingSet, WakesWhatIsBoundBeyondTheRange) {
  NetworkDescription scene;
  scene.dimension = 1;
  scene.step = 2e-4;
  scene.freeze_tolerance = kTolerance;
  scene.mats = {mass(1e-3, Vec3::Zero()), mass(1e-3, Vec3(kSpacing, 0, 0))};
  add_set_of_all(scene, sticky_balls(0.0));
  scene.sets[0].range = 1.05 * kSpacing;
  World world = make_world(scene);
  world.step();  // they stick
  for (int n = 0; n < 2000; ++n) {
    for (const std::uint32_t i : {0U, 1U})
      world.set_external_force(i, Vec3(i == 0 ? -0.4 : 0.4, 0, 0));
    world.step();
  }
  EXPECT_GT(world.position(1).x() - world.position(0).x(), 1.15 * kSpacing);
  EXPECT_EQ(world.asleep_count(), 0U);

  NetworkDescription held = scene;  // held apart by springs, not by forces
  held.mats.push_back(fixed(Vec3(-0.5, 0, 0)));
  held.mats.push_back(fixed(Vec3(0.5, 0, 0)));
  held.links = {{2, 0, 400.0, 1.0, 0.5 - 0.1 * kSpacing}, {1, 3, 400.0, 1.0, 0.5 - 1.8 * kSpacing}};
  held.medium_viscosity = 0.5;
  held.sets[0].set_p = {0, 1};
  World asleep = make_world(held);
  run(asleep, 8000);
  ASSERT_EQ(asleep.asleep_count(), 2U);
  ASSERT_GT(asleep.position(1).x() - asleep.position(0).x(), 1.06 * kSpacing);

  asleep.set_external_force(1, Vec3(0.05, 0, 0));
  run(asleep, 40);
  EXPECT_FALSE(asleep.is_asleep(0));
}

TEST(FreezingSet, WakesWhereAnAgeRunsOut) {
  NetworkDescription scene = wall(3, sticky_balls(0.75));
  scene.freeze_tolerance = kTolerance;
  World world = make_world(scene);
  run(world, 3650);
  ASSERT_EQ(world.asleep_count(), 48U);
  ASSERT_EQ(world.change_count(0, 1, 2), 0U);

  run(world, 200);

  EXPECT_GT(world.change_count(0, 1, 2), 100U);
  EXPECT_EQ(world.asleep_count(), 0U);
}

}  // namespace
}  // namespace cordis::test
