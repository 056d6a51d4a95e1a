// tests/engine/thread_team_test.cpp -- threads that share a step, and the bits they come to.
#include "sim_node/engine/core/thread_team.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <signal.h>

#include "sim_node/engine/matter/mat_blocks.h"
#include "sim_node/engine/world.h"
#include "tests/engine/scenes.h"
#include "tests/support/rounds.h"

namespace cordis::test {
namespace {

using engine::MatBlocks;
using engine::ThreadTeam;

constexpr std::size_t kMembers[] = {1, 2, 3, 5};

TEST(ThreadTeam, CallsEachMemberOnceAndReturnsWhenAllHaveEnded) {
  for (const std::size_t count : kMembers) {
    ThreadTeam team(count);
    std::vector<std::uint64_t> calls(count, 0);
    for (std::uint64_t n = 1; n <= 3000; ++n) {
      team.run([&](std::size_t member) { ++calls[member]; });
      for (const std::uint64_t of_member : calls) ASSERT_EQ(of_member, n);
    }
  }
}

TEST(ThreadTeam, MeetsBeforeAnyMemberGoesOn) {
  for (const std::size_t count : kMembers) {
    ThreadTeam team(count);
    std::vector<std::uint64_t> at(count, 0);
    std::atomic<int> ahead{0};
    for (int n = 0; n < 100; ++n) {
      team.run([&](std::size_t member) {
        for (int meeting = 0; meeting < 20; ++meeting) {
          ++at[member];
          team.meet();
          for (const std::uint64_t other : at) {
            if (other != at[member]) ++ahead;
          }
          team.meet();
        }
      });
    }
    EXPECT_EQ(ahead, 0);
    for (const std::uint64_t meetings : at) EXPECT_EQ(meetings, 2000U);
  }
}

TEST(ThreadTeam, SharesAllThingsOnce) {
  for (const std::size_t count : kMembers) {
    ThreadTeam team(count);
    for (std::size_t things = 0; things < 40; ++things) {
      std::size_t next = 0;
      for (std::size_t member = 0; member < count; ++member) {
        const ThreadTeam::Share share = team.share(member, things);
        EXPECT_EQ(share.first, next);
        EXPECT_LE(share.last - share.first, things / count + 1);
        next = share.last;
      }
      EXPECT_EQ(next, things);
    }
  }
}

/// A signal goes to the thread that waits for it, or to the one that the program has for it.
TEST(ThreadTeam, TakesNoSignals) {
  ThreadTeam team(3);
  std::array<int, 3> blocked{};
  team.run([&](std::size_t member) {
    sigset_t mask;
    pthread_sigmask(SIG_BLOCK, nullptr, &mask);
    for (const int signal : {SIGTERM, SIGINT, SIGHUP})
      blocked[member] += sigismember(&mask, signal);
  });
  EXPECT_EQ(blocked, (std::array<int, 3>{0, 3, 3}));
}

/// Lattices, chains and nets of more links than MatBlocks::kMinLinks, with links left out, doubled, turned about
/// and far ones.
class LargeNetwork {
 public:
  explicit LargeNetwork(std::uint32_t seed) : random_(seed) {}

  NetworkDescription network(int dimension) {
    NetworkDescription scene;
    scene.dimension = dimension;
    scene.step = 1e-3;
    if (once_in(2)) scene.medium_viscosity = 0.01;
    if (once_in(2)) scene.gravity.x() = 2.0;
    const std::uint32_t rows = dimension == 1 ? 1 : dimension == 2 ? 60 + below(60) : 14 + below(8);
    const std::uint32_t layer = dimension == 3 ? rows * rows : rows;
    const std::uint32_t count = 9000 + below(4000);
    const std::uint32_t fixed_in = 2 + below(200);
    for (std::uint32_t i = 0; i < count; ++i) {
      Vec3 place(i % rows, dimension > 1 ? i / rows % rows : 0, dimension > 2 ? i / layer : 0);
      if (dimension == 1) place.x() = i;
      place.x() += uniform(-0.1, 0.1);
      scene.mats.push_back(once_in(fixed_in) ? fixed(place)
                           : once_in(500)    ? port(place)
                                             : mass(0.1, place));
    }
    has_gaps_ = once_in(2);
    turns_ = once_in(3);
    add_all(scene, 1);
    if (dimension > 1) add_all(scene, rows);
    if (dimension > 2) add_all(scene, layer);
    while (scene.links.size() < MatBlocks::kMinLinks) add_all(scene, 2 + below(6));
    for (int i = 0; i < 100; ++i) add(scene, below(count), below(count));
    for (Link& link : scene.links) {
      link.isotropic = dimension > 1 && once_in(50);
      if (link.isotropic) link.rest_length = 0.0;
    }
    return scene;
  }

 private:
  bool once_in(std::uint32_t count) { return below(count) == 0; }
  std::uint32_t below(std::uint32_t count) { return static_cast<std::uint32_t>(random_() % count); }
  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(random_()) / 4294967296.0);
  }
  void add_all(NetworkDescription& scene, std::uint32_t offset) {
    for (std::uint32_t i = 0; i + offset < scene.mats.size(); ++i) {
      if (has_gaps_ && once_in(20)) continue;
      turns_&& once_in(10) ? add(scene, i + offset, i) : add(scene, i, i + offset);
    }
  }
  void add(NetworkDescription& scene, std::uint32_t a, std::uint32_t b) {
    if (a != b)
      scene.links.push_back({a, b, uniform(10.0, 100.0), uniform(0.0, 0.2), uniform(0.5, 1.0)});
  }

  std::mt19937 random_;
  bool has_gaps_ = false;
  bool turns_ = false;
};

TEST(MatBlocks, GiveEachMatAndLinkToOneGroup) {
  for (std::uint32_t seed = 0; seed < 12; ++seed) {
    const NetworkDescription scene = LargeNetwork(seed).network(1 + static_cast<int>(seed % 3));
    const MatBlocks blocks(scene);
    ASSERT_GT(blocks.count(), 1U) << "seed " << seed;
    std::uint32_t next = 0;
    for (std::size_t block = 0; block < blocks.count(); ++block) {
      EXPECT_EQ(blocks.first(block), next);
      for (next = blocks.first(block); next < blocks.last(block); ++next) {
        ASSERT_EQ(blocks.block_of(next), block);
      }
    }
    EXPECT_EQ(next, scene.mats.size());
    std::size_t others = 0;
    for (const Link& link : scene.links) {
      const std::size_t group = blocks.group_of(link);
      ASSERT_LT(group, blocks.group_count());
      for (const std::uint32_t mat : {link.mat_a, link.mat_b}) {
        ASSERT_GE(mat, blocks.mats_of_group(group).first);
        ASSERT_LT(mat, blocks.mats_of_group(group).last);
      }
      others += group == blocks.group_of_others() ? 1 : 0;
    }
    EXPECT_LT(others, scene.links.size() / 50) << "seed " << seed;
  }
}

/// Masses with links to many of their neighbours, before a long chain: blocks in the dense piece are no smaller than
/// its links are long.
TEST(MatBlocks, LeaveFewLinksToTheOthersInDensePiecesToo) {
  std::mt19937 random(2);
  NetworkDescription scene;
  constexpr std::uint32_t kDense = 3000;
  constexpr std::uint32_t kReach = 300;
  for (std::uint32_t i = 0; i < 60'000; ++i) {
    scene.mats.push_back(mass(0.1, Vec3(i, 0, 0)));
    if (i >= kDense) scene.links.push_back({i - 1, i, 1.0, 0.0, 1.0});
    for (int n = 0; n < 20 && i + kReach < kDense; ++n)
      scene.links.push_back(
          {i, i + 1 + static_cast<std::uint32_t>(random() % kReach), 1.0, 0.0, 1.0});
  }
  const MatBlocks blocks(scene);
  EXPECT_GT(blocks.count(), 4U);
  std::size_t others = 0;
  for (const Link& link : scene.links) {
    others += blocks.group_of(link) == blocks.group_of_others() ? 1 : 0;
  }
  EXPECT_LE(others, scene.links.size() / 100);
}

TEST(MatBlocks, AreOneWhereLinksJoinAnyPlacesOrAreFew) {
  std::mt19937 random(1);
  NetworkDescription scene;
  for (int i = 0; i < 10000; ++i) scene.mats.push_back(mass(0.1, Vec3(i, 0, 0)));
  for (int i = 0; i < 20000; ++i) {
    scene.links.push_back({static_cast<std::uint32_t>(random() % 10000),
                           static_cast<std::uint32_t>(random() % 10000), 1.0, 0.0, 1.0});
  }
  EXPECT_EQ(MatBlocks(scene).count(), 1U);
  EXPECT_EQ(MatBlocks(string_in_space(100, 0.1, 1e-4)).count(), 1U);
}

struct Ended {
  std::uint64_t hash;
  engine::Energy energy;
};

Ended played(const NetworkDescription& scene, std::size_t members, VectorWidth width) {
  World world = make_world(scene, width);
  world.share_steps(std::make_shared<ThreadTeam>(members));
  for (int n = 0; n < 40; ++n) {
    for (std::uint32_t i = 0; i < scene.mats.size(); ++i) {
      if (scene.mats[i].kind == engine::MatKind::kPort)
        world.impose_position(i, scene.mats[i].position + Vec3(1e-4 * n, 0, 0));
    }
    world.step();
  }
  return {world.state_hash(), world.energy()};
}

TEST(ThreadTeam, OfAnySizeComesToTheSameBits) {
  using engine::IntegratorKind;
  // One of each dimension at least.
  const auto seeds = static_cast<std::uint32_t>(std::max(rounds(9), 3));
  for (std::uint32_t seed = 0; seed < seeds; ++seed) {
    NetworkDescription scene = LargeNetwork(seed).network(1 + static_cast<int>(seed % 3));
    for (const IntegratorKind integrator : {IntegratorKind::kCordis, IntegratorKind::kLeapfrog}) {
      scene.integrator = integrator;
      const Ended alone = played(scene, 1, engine::best_vector_width());
      for (const VectorWidth width : engine::supported_vector_widths()) {
        if (rounds(2) == 1 && width != engine::best_vector_width()) continue;
        for (const std::size_t members : kMembers) {
          const Ended shared = played(scene, members, width);
          EXPECT_EQ(shared.hash, alone.hash) << "seed " << seed << ", " << members << " threads";
          EXPECT_EQ(shared.energy.kinetic, alone.energy.kinetic);
          EXPECT_EQ(shared.energy.elastic, alone.energy.elastic);
          EXPECT_EQ(shared.energy.dissipated, alone.energy.dissipated);
        }
      }
    }
  }
}

/// A scene that freezes has the bits of the one that does not, while nothing rests.
TEST(ThreadTeam, HasTheBitsOfAStepThatLeavesOutWhatRests) {
  for (std::uint32_t seed = 0; seed < 6; ++seed) {
    NetworkDescription scene = LargeNetwork(seed).network(1 + static_cast<int>(seed % 3));
    World whole = make_world(scene);
    scene.freeze_tolerance = 1e-30;
    World some = make_world(scene);
    some.share_steps(std::make_shared<ThreadTeam>(3));
    run(whole, 40);
    run(some, 40);
    ASSERT_EQ(some.asleep_count(), 0U);
    for (std::uint32_t i = 0; i < scene.mats.size(); ++i) {
      ASSERT_EQ(some.position(i), whole.position(i)) << "seed " << seed << ", MAT " << i;
    }
  }
}

/// The account of `cordis` closes, which takes the works of all groups.
TEST(ThreadTeam, KeepsTheAccount) {
  for (std::uint32_t seed = 0; seed < 6; ++seed) {
    const NetworkDescription scene = LargeNetwork(seed).network(1 + static_cast<int>(seed % 3));
    const engine::Energy energy = played(scene, 3, engine::best_vector_width()).energy;
    EXPECT_LT(std::abs(energy.residual()), 1e-11 * energy.largest) << "seed " << seed;
  }
}

}  // namespace
}  // namespace cordis::test
