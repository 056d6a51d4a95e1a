// tests/engine/connected_components_test.cpp
#include "sim_node/engine/connected_components.h"

#include <limits>
#include <numeric>
#include <queue>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "tests/engine/balls.h"
#include "tests/support/allocation_guard.h"

namespace cordis::test {
namespace {

using engine::BoundPair;
using engine::ConnectedComponents;

/// Flood fill over all pairs.
std::vector<std::uint32_t> flooded(const NetworkDescription& scene, double distance) {
  const SetLiaison& set = scene.sets[0];
  std::vector<std::uint32_t> mats = set.set_p;
  mats.insert(mats.end(), set.set_q.begin(), set.set_q.end());
  const auto is_pair = [&](std::size_t a, std::size_t b) {
    if (!set.set_q.empty() && (a < set.set_p.size()) == (b < set.set_p.size())) return false;
    return (scene.mats[mats[a]].position - scene.mats[mats[b]].position).norm() < distance;
  };
  std::vector<std::uint32_t> piece(mats.size(), std::numeric_limits<std::uint32_t>::max());
  std::uint32_t count = 0;
  for (std::size_t first = 0; first < mats.size(); ++first) {
    if (piece[first] != std::numeric_limits<std::uint32_t>::max()) continue;
    std::queue<std::size_t> open;
    open.push(first);
    piece[first] = count;
    while (!open.empty()) {
      const std::size_t a = open.front();
      open.pop();
      for (std::size_t b = 0; b < mats.size(); ++b) {
        if (piece[b] != std::numeric_limits<std::uint32_t>::max() || !is_pair(a, b)) continue;
        piece[b] = count;
        open.push(b);
      }
    }
    ++count;
  }
  return piece;
}

TEST(ConnectedComponents, AreThoseOfAFloodFill) {
  for (const int dimension : {1, 2, 3}) {
    for (const std::uint32_t split : {200U, 60U}) {
      NetworkDescription scene = cloud(200, dimension == 1 ? 20.0 : 1.5, 0.0, dimension);
      add_set(scene, contact(1.0, 0.0), 0.1, -1.0, split);
      const World world = make_world(scene);
      ConnectedComponents pieces(world.network(), 0);
      for (const double distance : {0.02, 0.1, 0.2, 5.0}) {
        const std::vector<std::uint32_t> expected = flooded(scene, distance);

        const std::size_t count = pieces.find_near(world.positions(), distance);

        EXPECT_EQ(count, 1U + *std::max_element(expected.begin(), expected.end()));
        for (std::size_t m = 0; m < 200; ++m) ASSERT_EQ(pieces.component_of(m), expected[m]) << m;
        pieces.keep_near(distance);
        EXPECT_EQ(pieces.find_near(world.positions(), distance), count);
        for (std::size_t m = 0; m < 200; ++m) ASSERT_EQ(pieces.component_of(m), expected[m]) << m;
      }
    }
  }
}

TEST(ConnectedComponents, AreTheSameWhetherPairsAreKeptOrNot) {
  NetworkDescription scene = cloud(200, 1.5, 0.5, 2);
  World world = make_world(scene);
  std::vector<std::uint32_t> all(200);
  std::iota(all.begin(), all.end(), 0U);
  ConnectedComponents searching(scene, all);
  ConnectedComponents keeping(scene, all);
  keeping.keep_near(0.12);

  for (int n = 0; n < 500; ++n) {
    world.step();
    ASSERT_EQ(keeping.find_near(world.positions(), 0.12),
              searching.find_near(world.positions(), 0.12))
        << n;
  }
}

TEST(ConnectedComponents, OfBoundPairsFollowTheChain) {
  NetworkDescription scene = cloud(8, 1.0, 0.0, 3);
  SetLiaison set;
  set.set_p = {1, 2, 4, 5, 7};
  set.range = 0.1;
  set.rest_length = 0.0;
  scene.state_machines.push_back({"none", {LinkState{}}, {}, 0});
  scene.sets = {set};
  const World world = make_world(scene);
  ConnectedComponents pieces(world.network(), 0);
  const std::vector<BoundPair> pairs = {{5, 7, 1, 0.0}, {1, 7, 1, 0.0}};

  EXPECT_EQ(pieces.find_bound(pairs), 3U);
  EXPECT_EQ(pieces.component_of(0), pieces.component_of(4));  // MATs 1 and 7
  EXPECT_EQ(pieces.component_of(0), pieces.component_of(3));
  EXPECT_EQ(pieces.component_of(1), 1U);
  EXPECT_EQ(pieces.component_of(2), 2U);
  EXPECT_EQ(pieces.find_bound({}), 5U);
}

TEST(ConnectedComponents, AreCountedWithoutAllocating) {
  NetworkDescription scene = cloud(200, 1.0, 0.0, 3);
  add_set(scene, contact(1.0, 0.0), 0.1, -1.0, 200);
  const World world = make_world(scene);
  ConnectedComponents pieces(world.network(), 0);

  const AllocationGuard guard;
  const std::size_t count = pieces.find_near(world.positions(), 0.1);

  EXPECT_EQ(guard.count(), 0U);
  EXPECT_GT(count, 1U);
}

TEST(ConnectedComponents, OfASetThatDoesNotExistAreRefused) {
  const World world = make_world(free_cluster(3, 2, 0.0));
  EXPECT_THROW(ConnectedComponents(world.network(), 0), std::invalid_argument);
}

}  // namespace
}  // namespace cordis::test
