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
#include "tests/engine/many_states.h"
#include "tests/engine/programs.h"
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

/// What the links of a large network are.
enum class Kinds : std::uint8_t { kLinear, kMixed };

/// Lattices, chains and nets of more links than MatBlocks::kMinLinks, with links left out, doubled, turned about
/// and far ones.
class LargeNetwork {
 public:
  explicit LargeNetwork(std::uint32_t seed) : random_(seed) {}

  /// @param kinds  kMixed: a third of the links have states that come and go, a fifth are Maxwell elements
  NetworkDescription network(int dimension, Kinds kinds = Kinds::kLinear) {
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
    if (kinds == Kinds::kMixed) mix(scene);
    return scene;
  }

 private:
  void mix(NetworkDescription& scene) {
    scene.state_machines = {
        Behaving()
            .state(60.0, 0.05)
            .exit(q(Quantity::kElongation) > 0.1, 1, RestRule::kHere)
            .state(20.0, 0.1)
            .exit(q(Quantity::kAge) > 0.004 + q(Quantity::kMassA) * 0.01, 0)
            .state_machine,
        Behaving().state(10.0, 0.2).exit(q(Quantity::kSpeed) > 0.01, 0).state_machine,
        Behaving()
            .state(0.1, 0.001)
            .exit(q(Quantity::kAge) > 0.006, 1)
            .state(0.05, 0.0)
            .exit(q(Quantity::kAge) > 0.01, 0)
            .state_machine};
    std::vector<Link> linear;
    for (const Link& link : scene.links) {
      if (const std::uint32_t kind = below(15); kind < 5) {
        scene.state_links.push_back({link.mat_a, link.mat_b, kind / 4, link.rest_length});
      } else if (kind < 8) {
        scene.maxwell_links.push_back(
            {link.mat_a, link.mat_b, link.stiffness, 0.1 + link.viscosity, uniform(-0.1, 0.1)});
      } else {
        linear.push_back(link);
      }
    }
    scene.links = std::move(linear);
    if (scene.dimension == 1) return;
    for (std::uint32_t i = 0; i + 2 < scene.mats.size(); i += 1 + below(3)) {
      const bool has_states = once_in(3);
      scene.bends.push_back({i, i + 1, i + 2, has_states ? 0.0 : 0.1, has_states ? 0.0 : 0.001, 0.0,
                             1.0, 1.0, has_states ? 2U : engine::Bend::kNone});
    }
  }
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
      const std::size_t group = blocks.group_of(link.mat_a, link.mat_b);
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
    others += blocks.group_of(link.mat_a, link.mat_b) == blocks.group_of_others() ? 1 : 0;
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
  std::vector<engine::LinkEvent> events;
};

Ended played(const NetworkDescription& scene, std::size_t members, VectorWidth width) {
  World world = make_world(scene, width);
  world.share_steps(std::make_shared<ThreadTeam>(members));
  std::vector<engine::LinkEvent> events;
  for (int n = 0; n < 40; ++n) {
    for (std::uint32_t i = 0; i < scene.mats.size(); ++i) {
      if (scene.mats[i].kind == engine::MatKind::kPort)
        world.impose_position(i, scene.mats[i].position + Vec3(1e-4 * n, 0, 0));
    }
    world.step();
    events.insert(events.end(), world.events().begin(), world.events().end());
  }
  return {world.state_hash(), world.energy(), std::move(events)};
}

bool is_same(const engine::LinkEvent& a, const engine::LinkEvent& b) {
  return a.step == b.step && a.link == b.link && a.mat_a == b.mat_a && a.mat_b == b.mat_b &&
         a.state_machine == b.state_machine && a.from == b.from && a.to == b.to &&
         a.quantity == b.quantity && a.value == b.value && a.energy == b.energy;
}

TEST(ThreadTeam, OfAnySizeComesToTheSameBits) {
  using engine::IntegratorKind;
  // One of each dimension at least.
  const auto seeds = static_cast<std::uint32_t>(std::max(rounds(9), 3));
  // Mixed ones are slow: where few rounds are asked for, one in space.
  const auto mixed = static_cast<std::uint32_t>(std::clamp(rounds(3), 1, 3));
  for (std::uint32_t n = 0; n < seeds + mixed; ++n) {
    const std::uint32_t seed = n < seeds ? n : 11 - (n - seeds);
    const Kinds kinds = n < seeds ? Kinds::kLinear : Kinds::kMixed;
    NetworkDescription scene = LargeNetwork(seed).network(1 + static_cast<int>(seed % 3), kinds);
    ASSERT_GT(MatBlocks(scene).count(), 4U);
    for (const IntegratorKind integrator : {IntegratorKind::kCordis, IntegratorKind::kLeapfrog}) {
      scene.integrator = integrator;
      const Ended alone = played(scene, 1, engine::best_vector_width());
      EXPECT_EQ(alone.events.size() > 1000, kinds == Kinds::kMixed) << "seed " << seed;
      for (const VectorWidth width : engine::supported_vector_widths()) {
        if (rounds(2) == 1 && width != engine::best_vector_width()) continue;
        for (const std::size_t members : kMembers) {
          const Ended shared = played(scene, members, width);
          EXPECT_EQ(shared.hash, alone.hash) << "seed " << seed << ", " << members << " threads";
          EXPECT_EQ(shared.energy.kinetic, alone.energy.kinetic);
          EXPECT_EQ(shared.energy.elastic, alone.energy.elastic);
          EXPECT_EQ(shared.energy.dissipated, alone.energy.dissipated);
          EXPECT_EQ(shared.energy.switching, alone.energy.switching);
          EXPECT_TRUE(std::ranges::equal(shared.events, alone.events, is_same)) << "seed " << seed;
        }
      }
    }
  }
}

/// A scene that freezes has the bits of the one that does not, while nothing rests.
TEST(ThreadTeam, HasTheBitsOfAStepThatLeavesOutWhatRests) {
  for (std::uint32_t seed = 0; seed < 9; ++seed) {
    NetworkDescription scene = LargeNetwork(seed).network(
        1 + static_cast<int>(seed % 3), seed < 6 ? Kinds::kLinear : Kinds::kMixed);
    scene.bends.clear();  // they do not freeze
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

/// A small network of many states, `count` times beside itself.
NetworkDescription copies_of(const NetworkDescription& small, std::uint32_t count) {
  NetworkDescription scene = small;
  for (std::uint32_t copy = 1; copy < count; ++copy) {
    const auto first = static_cast<std::uint32_t>(small.mats.size()) * copy;
    const auto add = [first](auto& links, const auto& own) {
      for (auto link : own) {
        link.mat_a += first;
        link.mat_b += first;
        links.push_back(link);
      }
    };
    scene.mats.insert(scene.mats.end(), small.mats.begin(), small.mats.end());
    add(scene.links, small.links);
    add(scene.state_links, small.state_links);
    add(scene.maxwell_links, small.maxwell_links);
  }
  return scene;
}

/// Blocks end within copies, whose forces are summed in another order: not the bits, but the changes are those of
/// one copy alone, in link order.
TEST(ThreadTeam, ChangesTheStatesOfEachPartAsThatPartAlone) {
  constexpr std::uint32_t kCopies = 250;
  for (const int dimension : {1, 2, 3}) {
    NetworkDescription small = network_of_many_states(dimension);
    small.maxwell_links = {{1, 2, 20.0, 0.5, 0.1}, {4, 9, 50.0, 0.2, 0.0}};
    const NetworkDescription large = copies_of(small, kCopies);
    const auto links = static_cast<std::uint32_t>(small.state_links.size());
    const auto mats = static_cast<std::uint32_t>(small.mats.size());
    ASSERT_GT(MatBlocks(large).count(), 4U);
    World one = make_world(small);
    World all = make_world(large);
    all.share_steps(std::make_shared<ThreadTeam>(3));
    std::size_t changes = 0;
    for (int n = 0; n < 60; ++n) {
      one.step();
      all.step();
      const auto own = one.events();
      ASSERT_EQ(all.events().size(), kCopies * own.size()) << dimension << "-D, step " << n;
      for (std::size_t i = 0; i < all.events().size(); ++i) {
        const engine::LinkEvent& event = all.events()[i];
        const engine::LinkEvent& of_one = own[i % own.size()];
        const auto copy = static_cast<std::uint32_t>(i / own.size());
        ASSERT_EQ(event.link, copy * links + of_one.link);
        ASSERT_EQ(event.mat_a, copy * mats + of_one.mat_a);
        ASSERT_EQ(event.to, of_one.to);
        ASSERT_NEAR(event.value, of_one.value, 1e-8 * std::abs(of_one.value) + 1e-10);
        ASSERT_NEAR(event.energy, of_one.energy, 1e-8 * (1.0 + std::abs(of_one.energy)));
        ++changes;
      }
    }
    EXPECT_GT(changes, kCopies * 20U);
    const auto near = [](double found, double expected) {
      return std::abs(found - expected) <= 1e-8 * (1.0 + std::abs(expected));
    };
    for (std::uint32_t i = 0; i < large.mats.size(); ++i) {
      const Vec3 expected = one.position(i % mats);
      ASSERT_LE((all.position(i) - expected).norm(), 1e-9 * (1.0 + expected.norm()));
    }
    for (std::uint32_t l = 0; l < large.state_links.size(); ++l) {
      ASSERT_EQ(all.state_of(l), one.state_of(l % links));
      ASSERT_PRED2(near, all.tension_of(l), one.tension_of(l % links));
      ASSERT_PRED2(near, all.rest_length_of(l), one.rest_length_of(l % links));
    }
  }
}

TEST(ThreadTeam, GoesOnFromASavedStateAsTheWorldThatSavedIt) {
  for (std::uint32_t seed = 0; seed < 3; ++seed) {
    const NetworkDescription scene =
        LargeNetwork(seed).network(1 + static_cast<int>(seed), Kinds::kMixed);
    World first = make_world(scene);
    first.share_steps(std::make_shared<ThreadTeam>(2));
    run(first, 15);
    World second = make_world(scene);
    second.share_steps(std::make_shared<ThreadTeam>(3));
    second.restore(first.snapshot());
    ASSERT_EQ(second.state_hash(), first.state_hash());
    run(first, 15);
    run(second, 15);
    EXPECT_EQ(second.state_hash(), first.state_hash()) << "seed " << seed;
  }
}

/// The account of `cordis` closes, which takes the works of all groups.
TEST(ThreadTeam, KeepsTheAccount) {
  for (std::uint32_t seed = 0; seed < 9; ++seed) {
    const NetworkDescription scene = LargeNetwork(seed).network(
        1 + static_cast<int>(seed % 3), seed < 6 ? Kinds::kLinear : Kinds::kMixed);
    const engine::Energy energy = played(scene, 3, engine::best_vector_width()).energy;
    EXPECT_LT(std::abs(energy.residual()), 1e-11 * energy.largest) << "seed " << seed;
  }
}

}  // namespace
}  // namespace cordis::test
