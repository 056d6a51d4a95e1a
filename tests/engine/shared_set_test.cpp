// tests/engine/shared_set_test.cpp -- sets that threads share, and the bits they come to.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "sim_node/engine/core/thread_team.h"
#include "sim_node/engine/pairs/row_shares.h"
#include "sim_node/engine/world.h"
#include "tests/engine/balls.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/rounds.h"

namespace cordis::test {
namespace {

using engine::RowShares;
using engine::ThreadTeam;

constexpr std::size_t kTeams[] = {2, 3, 4};

/// A few balls more than a set must have to be shared, of random sizes, weights and speeds, in the order of a
/// lattice or in any.
class LargeSet {
 public:
  explicit LargeSet(std::uint32_t seed) : random_(seed) {}

  /// Balls that are pressed into one another between fixed ones, and move.
  NetworkDescription pack(int dimension, double speed = 0.5) {
    NetworkDescription scene = lattice(dimension, 0.08, speed);
    for (std::size_t i = 0; i < scene.mats.size(); ++i) {
      scene.radius.push_back(uniform(0.038, 0.045));
      if (once_in(50)) scene.mats[i] = fixed(scene.mats[i].position);
    }
    LinkState law = contact(uniform(500.0, 2000.0), once_in(2) ? 0.0 : 0.2);
    if (once_in(3)) law.elasticity = engine::Table({-0.1, -0.01, 0.0}, {-150.0, -10.0, 0.0});
    add(scene, law, 0.09, -1.0);
    return scene;
  }

  /// A drop of balls that attract each other.
  NetworkDescription melt(int dimension, double speed = 1.0) {
    NetworkDescription scene = lattice(dimension, 1.05, speed);
    scene.step = 0.004;
    for (Mat& ball : scene.mats) ball.mass = 1.0;
    add(scene, lennard_jones(1.0, 1.0, 2.0), 2.0, 0.0);
    return scene;
  }

 private:
  bool once_in(std::uint32_t count) { return random_() % count == 0; }
  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(random_()) / 4294967296.0);
  }

  NetworkDescription lattice(int dimension, double pitch, double speed) {
    NetworkDescription scene;
    scene.dimension = dimension;
    scene.step = 5e-4;
    if (once_in(2)) scene.medium_viscosity = 0.01;
    const auto count = static_cast<std::uint32_t>(RowShares::kMinMembers + random_() % 100);
    const auto edge = static_cast<std::uint32_t>(std::ceil(std::pow(count, 1.0 / dimension)));
    const std::uint32_t layer = dimension > 2 ? edge * edge : count;
    for (std::uint32_t i = 0; i < count; ++i) {
      Vec3 place(i % edge, i % layer / edge, i / layer);
      Vec3 velocity = Vec3::Zero();
      for (int axis = 0; axis < dimension; ++axis) {
        place[axis] += uniform(-0.05, 0.05);
        velocity[axis] = uniform(-speed, speed);
      }
      scene.mats.push_back(mass(uniform(0.5, 1.5), pitch * place, velocity));
    }
    if (once_in(2)) std::shuffle(scene.mats.begin(), scene.mats.end(), random_);
    return scene;
  }

  void add(NetworkDescription& scene, const LinkState& law, double range, double rest_length) {
    add_set(scene, law, range, rest_length, static_cast<std::uint32_t>(scene.mats.size()));
  }

  std::mt19937 random_;
};

NetworkDescription scene_of(std::uint32_t seed) {
  LargeSet set(seed);
  const int dimension = 2 + static_cast<int>(seed % 2);
  return seed / 2 % 2 == 0 ? set.pack(dimension) : set.melt(dimension);
}

void share(World& world, std::size_t threads) {
  world.share_steps(std::make_shared<ThreadTeam>(threads));
}

/// Steps as a session does: room that is wanted is made between two steps.
void play(World& world, int steps) {
  for (int n = 0; n < steps; ++n) {
    if (world.step().wants_room) world.make_room();
  }
}

void expect_same(const World& shared, const World& alone, const std::string& what) {
  EXPECT_EQ(shared.state_hash(), alone.state_hash()) << what;
  EXPECT_EQ(shared.energy().kinetic, alone.energy().kinetic) << what;
  EXPECT_EQ(shared.energy().elastic, alone.energy().elastic) << what;
  EXPECT_EQ(shared.energy().dissipated, alone.energy().dissipated) << what;
  EXPECT_EQ(shared.largest_partners(0).of_p, alone.largest_partners(0).of_p) << what;
  for (std::size_t member = 0; member < shared.network().mat_count(); member += 97)
    EXPECT_EQ(shared.partners_of(0, member), alone.partners_of(0, member)) << what;
}

std::string name_of(std::uint32_t seed, std::size_t threads) {
  return "seed " + std::to_string(seed) + ", " + std::to_string(threads) + " threads";
}

TEST(SharedSets, ComeToTheSameBitsWithEveryNumberOfThreads) {
  for (std::uint32_t seed = 0; seed < 8; ++seed) {
    const NetworkDescription scene = scene_of(seed);
    World alone = make_world(scene);
    ASSERT_GT(alone.block_count(), 4U);
    play(alone, rounds(150));
    for (const std::size_t threads : kTeams) {
      World shared = make_world(scene);
      share(shared, threads);
      play(shared, rounds(150));
      expect_same(shared, alone, name_of(seed, threads));
    }
  }
}

TEST(SharedSets, ComeToTheSameBitsWithEveryVectorWidth) {
  const NetworkDescription pack = LargeSet(20).pack(2);
  const NetworkDescription melt = LargeSet(21).melt(3);
  for (const NetworkDescription* scene : {&pack, &melt}) {
    World alone = make_world(*scene);
    play(alone, 40);
    for (const VectorWidth width : engine::supported_vector_widths()) {
      World shared = make_world(*scene, width);
      share(shared, 3);
      play(shared, 40);
      expect_same(shared, alone, to_string(width));
    }
  }
}

/// The list of near pairs is renewed some hundred times.
TEST(SharedSets, ComeToTheSameBitsOverThousandsOfSteps) {
  const NetworkDescription pack = LargeSet(30).pack(2, 3.0);
  World alone = make_world(pack);
  World shared = make_world(pack);
  share(shared, 2);
  for (int round = 0; round < 6; ++round) {
    play(alone, rounds(400));
    play(shared, rounds(400));
    ASSERT_EQ(shared.state_hash(), alone.state_hash()) << "step " << alone.step_count();
  }
  expect_same(shared, alone, "pack");
}

/// Balls that fly past one another fast leave no time for slices: lists are made at once.
TEST(SharedSets, ComeToTheSameBitsWhereListsAreMadeAtOnce) {
  for (std::uint32_t seed = 40; seed < 43; ++seed) {
    const NetworkDescription scene = LargeSet(seed).pack(2 + static_cast<int>(seed % 2), 60.0);
    World alone = make_world(scene);
    World shared = make_world(scene);
    share(shared, 3);
    for (int n = 0; n < rounds(60); ++n) {
      play(alone, 1);
      play(shared, 1);
      ASSERT_EQ(shared.state_hash(), alone.state_hash()) << "seed " << seed << ", step " << n;
    }
  }
}

TEST(SharedSets, ComeToTheSameBitsWithEveryIntegrator) {
  using engine::IntegratorKind;
  NetworkDescription scene = LargeSet(50).melt(3);
  for (const IntegratorKind integrator :
       {IntegratorKind::kLeapfrog, IntegratorKind::kSymplectic4}) {
    scene.medium_viscosity = 0.0;
    scene.integrator = integrator;
    World alone = make_world(scene);
    World shared = make_world(scene);
    share(shared, 3);
    play(alone, 30);
    play(shared, 30);
    expect_same(shared, alone, "integrator " + std::to_string(static_cast<int>(integrator)));
  }
}

TEST(SharedSets, GoOnFromACopyAndWithOtherThreads) {
  for (const NetworkDescription& scene : {LargeSet(60).pack(3), LargeSet(61).melt(2)}) {
    World alone = make_world(scene);
    World shared = make_world(scene);
    share(shared, 3);
    play(alone, rounds(50));
    play(shared, rounds(50));
    std::vector<double> copy;
    shared.copy_state(copy);
    World later = make_world(scene);
    share(later, 2);
    play(later, 7);
    ASSERT_TRUE(later.take_state(copy, shared.step_count()));
    World restored = make_world(scene);
    restored.restore(shared.snapshot());
    share(restored, 4);
    later.swap_teams(restored);
    World* const worlds[] = {&later, &restored, &shared};
    share(shared, 2);
    play(alone, rounds(50));
    for (World* const world : worlds) {
      play(*world, rounds(50));
      expect_same(*world, alone, std::to_string(world->team().member_count()) + " threads");
    }
  }
}

TEST(SharedSets, KeepEnergyAndMomentum) {
  NetworkDescription scene = LargeSet(70).melt(3);
  scene.medium_viscosity = 0.0;
  World world = make_world(scene);
  share(world, 3);
  const Vec3 before = world.momentum();
  play(world, rounds(200));
  const engine::Energy energy = world.energy();
  EXPECT_LT(std::abs(energy.residual()), 1e-11 * energy.largest);
  EXPECT_LT((world.momentum() - before).norm(), 1e-9 * static_cast<double>(scene.mats.size()));
}

TEST(SharedSets, AllocateNothingInAStep) {
  for (const std::uint32_t seed : {80U, 83U}) {
    World world = make_world(scene_of(seed));
    share(world, 3);
    play(world, 60);
    ThreadTeam& team = world.team();
    std::vector<std::optional<AllocationGuard>> guards(team.member_count());
    std::vector<std::size_t> counts(team.member_count());
    team.run([&](std::size_t member) { guards[member].emplace(); });
    for (int n = 0; n < rounds(60); ++n) world.step();
    team.run([&](std::size_t member) { counts[member] = guards[member]->count(); });
    EXPECT_EQ(counts, std::vector<std::size_t>(team.member_count(), 0)) << "seed " << seed;
  }
}

/// Friction, sets of two kinds of balls and sleepers: one thread computes what a team does not.
TEST(SharedSets, ComeToTheSameBitsWhereATeamComputesNoPairs) {
  const NetworkDescription plain = LargeSet(90).pack(2);
  NetworkDescription rubs = plain;
  rubs.state_machines[0].friction = {100.0, 0.1, 0.5, 0.4};
  NetworkDescription across = plain;
  std::vector<std::uint32_t>& balls = across.sets[0].set_p;
  across.sets[0].set_q.assign(balls.begin() + 2000, balls.end());
  balls.resize(2000);
  NetworkDescription freezes = plain;
  freezes.freeze_tolerance = 1e-6;
  for (const NetworkDescription* scene : {&rubs, &across, &freezes}) {
    World alone = make_world(*scene);
    World shared = make_world(*scene);
    share(shared, 3);
    play(alone, 20);
    play(shared, 20);
    expect_same(shared, alone, scene == &rubs ? "rubs" : scene == &across ? "across" : "freezes");
  }
}

}  // namespace
}  // namespace cordis::test
