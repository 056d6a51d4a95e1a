// tests/engine/link_runs_test.cpp -- links in runs, beside a scalar loop over the links and beside
// the same network whose links are gathered.
#include "sim_node/engine/links/link_runs.h"

#include <algorithm>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/engine/random_runs.h"
#include "tests/engine/scenes.h"

namespace cordis::test {
namespace {

using engine::layout_of;
using engine::LinkArrangement;
using engine::LinkOrder;
using engine::LinkRun;
using engine::order_in_runs;

constexpr std::uint32_t kEmpty = LinkArrangement::kEmpty;

std::vector<Link> ascending(std::vector<Link> links) {
  for (Link& link : links) link = engine::ascending(link, 3);
  return links;
}

/// In runs where they may be, with room behind them.
LinkArrangement arranged(const std::vector<Link>& links) {
  LinkArrangement rows;
  engine::arrange_links(links, 0, true, 1000000, rows);
  return rows;
}

std::vector<Link> chain(std::uint32_t first, std::uint32_t link_count, std::uint32_t offset = 1) {
  std::vector<Link> links;
  for (std::uint32_t i = 0; i < link_count; ++i) {
    links.push_back({first + i, first + i + offset, 100.0, 0.1, 0.5});
  }
  return links;
}

class LinkRuns : public testing::TestWithParam<VectorWidth> {};

INSTANTIATE_TEST_SUITE_P(Widths, LinkRuns, testing::ValuesIn(engine::supported_vector_widths()),
                         [](const auto& width) { return engine::to_string(width.param); });

TEST(LinkArrangement, HasEachLinkInOneRowAndInItsOrder) {
  for (std::uint32_t seed = 0; seed < 300; ++seed) {
    RandomRuns random(seed);
    const std::vector<Link> links = ascending(random.links(97));
    const LinkArrangement rows = arranged(links);

    std::uint32_t next = 0;
    std::size_t row = 0;
    for (const LinkRun& run : rows.runs) {
      ASSERT_EQ(run.first_row, row) << "seed " << seed;
      ASSERT_EQ(run.row_count % 8, 0U) << "seed " << seed;
      for (; row < run.first_row + run.row_count; ++row) {
        const bool is_used = (rows.used_rows[row / 8] >> row % 8 & 1) != 0;
        ASSERT_EQ(is_used, rows.link_of_row[row] != kEmpty) << "seed " << seed << ", row " << row;
        if (!is_used) continue;
        ASSERT_EQ(rows.link_of_row[row], next) << "seed " << seed;
        if (!run.is_gathered) {
          ASSERT_EQ(links[next].mat_a, run.first_a + row - run.first_row) << "seed " << seed;
          ASSERT_EQ(links[next].mat_b, run.first_b + row - run.first_row) << "seed " << seed;
        }
        ++next;
      }
    }
    ASSERT_EQ(next, links.size()) << "seed " << seed;
    ASSERT_EQ(row, rows.link_of_row.size()) << "seed " << seed;
  }
}

TEST(LinkArrangement, MakesOneRunOfAChainAndOneOfAllRowsOfAGrid) {
  EXPECT_EQ(arranged(chain(0, 70)).runs.size(), 1U);
  EXPECT_EQ(arranged(chain(3, 70, 30)).runs.size(), 1U);

  std::vector<Link> rows_of_grid = chain(0, 19);
  for (const Link& link : chain(20, 19)) rows_of_grid.push_back(link);
  const LinkArrangement rows = arranged(rows_of_grid);

  ASSERT_EQ(rows.runs.size(), 1U);
  EXPECT_EQ(rows.link_of_row[19], kEmpty);
  EXPECT_EQ(rows.link_of_row[20], 19U);
}

TEST(LinkArrangement, GathersWhatIsTooShortOrDescends) {
  EXPECT_TRUE(arranged(chain(0, 7)).runs[0].is_gathered);
  EXPECT_FALSE(arranged(chain(0, 8)).runs[0].is_gathered);
  std::vector<Link> descending = chain(0, 30);
  std::reverse(descending.begin(), descending.end());
  const LinkArrangement rows = arranged(descending);
  ASSERT_EQ(rows.runs.size(), 1U);
  EXPECT_TRUE(rows.runs[0].is_gathered);
}

TEST(LinkArrangement, GathersLinksInLessThanHalfOfTheRows) {
  std::vector<Link> every_third;
  for (std::uint32_t i = 0; i < 30; ++i) every_third.push_back({3 * i, 3 * i + 50});
  EXPECT_TRUE(arranged(every_third).runs[0].is_gathered);
  std::vector<Link> every_second;
  for (std::uint32_t i = 0; i < 30; ++i) every_second.push_back({2 * i, 2 * i + 50});
  EXPECT_FALSE(arranged(every_second).runs[0].is_gathered);
}

TEST(LinkOrder, HasEachLinkOnceAndIsKept) {
  for (std::uint32_t seed = 0; seed < 300; ++seed) {
    RandomRuns random(seed);
    std::vector<Link> links = random.links(97);
    const LinkOrder order = order_in_runs(links);

    std::vector<std::uint32_t> sorted = order.links;
    std::sort(sorted.begin(), sorted.end());
    for (std::uint32_t l = 0; l < links.size(); ++l) ASSERT_EQ(sorted[l], l) << "seed " << seed;
    ASSERT_EQ(sorted.size(), links.size()) << "seed " << seed;

    std::vector<Link> in_order;
    for (const std::uint32_t link : order.links) in_order.push_back(links[link]);
    ASSERT_GE(order_in_runs(in_order).in_runs, order.in_runs) << "seed " << seed;
    ASSERT_EQ(order_in_runs(in_order).links, sorted) << "not kept, seed " << seed;
  }
}

TEST(LinkOrder, FindsTheRunsOfAShuffledNetWithLinksEitherWayRound) {
  constexpr std::uint32_t kSide = 60;  // over several tiles
  std::vector<Link> links;
  for (std::uint32_t row = 0; row < kSide; ++row) {
    for (const Link& link : chain(kSide * row, kSide - 1)) links.push_back(link);
  }
  for (const Link& link : chain(0, kSide * (kSide - 1), kSide)) links.push_back(link);
  EXPECT_EQ(order_in_runs(links).in_runs, links.size());
  std::mt19937 random(7);
  std::shuffle(links.begin(), links.end(), random);
  for (std::size_t l = 0; l < links.size(); l += 2) std::swap(links[l].mat_a, links[l].mat_b);

  EXPECT_EQ(order_in_runs(links).in_runs, links.size());
}

TEST(LinkOrder, TakesASecondLinkBetweenTwoMatsInARunOfItsOwn) {
  std::vector<Link> springs_and_dampers;
  for (const Link& link : chain(0, 50))
    springs_and_dampers.insert(springs_and_dampers.end(), 2, link);

  const LinkOrder order = order_in_runs(springs_and_dampers);

  EXPECT_EQ(order.in_runs, 100U);
  for (std::uint32_t l = 0; l < 50; ++l) {
    EXPECT_EQ(order.links[l], 2 * l);
    EXPECT_EQ(order.links[50 + l], 2 * l + 1);
  }
}

TEST(LinkOrder, StaysWhereNearlyAllLinksAreInRuns) {
  std::vector<Link> links = chain(200, 70, 30);
  links.push_back({3, 90});
  for (const Link& link : chain(0, 70)) links.push_back(link);
  const LinkOrder order = order_in_runs(links);
  EXPECT_EQ(order.in_runs, 140U);
  EXPECT_TRUE(std::is_sorted(order.links.begin(), order.links.end()));
}

TEST_P(LinkRuns, AddUpLikeAScalarLoopOverTheLinks) {
  int in_runs = 0;
  for (std::uint32_t seed = 0; seed < 240; ++seed) {
    RandomRuns random(seed);
    const NetworkDescription scene = random.network(1 + static_cast<int>(seed % 3));
    if (layout_of(scene).is_by_axis()) ++in_runs;
    const NetworkDescription in_order = in_order_of_step(scene);
    World world = make_world(scene, GetParam());
    world.step();

    std::vector<Vec3> delayed = positions_of(make_world(scene));
    std::vector<Vec3> position = positions_of(world);
    for (int n = 1; n < 12; ++n) {
      move_ports(scene, world, n);
      for (std::uint32_t i = 0; i < scene.mats.size(); ++i) {
        if (scene.mats[i].kind != MatKind::kPort) continue;
        position[i] = scene.mats[i].position + Vec3(1e-3 * (n % 40), 0, 0);
      }
      world.step();
      const std::vector<Vec3> expected = scalar_forces(in_order, position, delayed);

      for (std::uint32_t i = 0; i < scene.mats.size(); ++i) {
        ASSERT_EQ(world.link_force(i), expected[i]) << "seed " << seed << ", step " << n << ", MAT "
                                                    << i << ", " << scene.links.size() << " links";
      }
      delayed = position;
      position = positions_of(world);
    }
  }
  EXPECT_GT(in_runs, 100);  // the others test that gathered links do the same
}

TEST_P(LinkRuns, MoveTheMatsAsGatheredLinksDo) {
  for (std::uint32_t seed = 0; seed < 240; ++seed) {
    RandomRuns random(seed);
    const NetworkDescription scene = random.network(1 + static_cast<int>(seed % 3));
    World in_runs = make_world(scene, GetParam());
    World one_by_one = make_world(gathered(scene), VectorWidth::kSse2);
    ASSERT_FALSE(layout_of(one_by_one.network().description()).is_by_axis());

    for (int n = 0; n < 60; ++n) {
      move_ports(scene, in_runs, n);
      move_ports(scene, one_by_one, n);
      in_runs.step();
      one_by_one.step();
    }

    for (std::uint32_t i = 0; i < scene.mats.size(); ++i) {
      ASSERT_EQ(in_runs.position(i), one_by_one.position(i)) << "seed " << seed << ", MAT " << i;
      ASSERT_EQ(in_runs.velocity(i), one_by_one.velocity(i)) << "seed " << seed << ", MAT " << i;
      ASSERT_EQ(in_runs.link_force(i), one_by_one.link_force(i)) << "seed " << seed;
      ASSERT_EQ(Vec3(in_runs.positions().col(i).head<3>()), in_runs.position(i));
    }
    // the works are summed in another order
    const engine::Energy energy = in_runs.energy();
    const engine::Energy expected = one_by_one.energy();
    const double rounding = 1e-12 * (1.0 + expected.largest);
    EXPECT_NEAR(energy.dissipated, expected.dissipated, rounding) << "seed " << seed;
    EXPECT_NEAR(energy.elastic, expected.elastic, rounding) << "seed " << seed;
    EXPECT_NEAR(energy.port_work, expected.port_work, rounding) << "seed " << seed;
    EXPECT_NEAR(energy.residual(), 0.0, rounding) << "seed " << seed;
  }
}

TEST_P(LinkRuns, HaveTheSameAccountOnEveryWidthAndGoOnFromASnapshot) {
  for (std::uint32_t seed = 0; seed < 60; ++seed) {
    RandomRuns random(seed);
    const NetworkDescription scene = random.network(1 + static_cast<int>(seed % 3));
    World narrow = make_world(scene, VectorWidth::kSse2);
    World world = make_world(scene, GetParam());
    run(narrow, 40);
    run(world, 40);
    EXPECT_EQ(world.energy().dissipated, narrow.energy().dissipated) << "seed " << seed;
    EXPECT_EQ(world.energy().total(), narrow.energy().total()) << "seed " << seed;

    World restored = make_world(scene, GetParam());
    restored.restore(narrow.snapshot());
    run(restored, 40);
    run(world, 40);
    EXPECT_EQ(restored.state_hash(), world.state_hash()) << "seed " << seed;
    EXPECT_EQ(restored.energy().total(), world.energy().total()) << "seed " << seed;
  }
}

TEST_P(LinkRuns, OfEveryLengthAddUpAsGatheredLinksDo) {
  for (const int dimension : {1, 2, 3}) {
    for (std::uint32_t length = 1; length <= 70; ++length) {
      NetworkDescription scene = free_cluster(length + 40, 0, 0.0, dimension);
      scene.links = chain(1, length);
      for (const Link& link : chain(0, length, 37)) scene.links.push_back(link);
      EXPECT_EQ(layout_of(scene).is_by_axis(), length >= 8);
      World in_runs = make_world(scene, GetParam());
      World one_by_one = make_world(gathered(scene), GetParam());
      run(in_runs, 20);
      run(one_by_one, 20);
      for (std::uint32_t i = 0; i < scene.mats.size(); ++i) {
        ASSERT_EQ(in_runs.position(i), one_by_one.position(i))
            << length << " links, dimension " << dimension << ", MAT " << i;
      }
    }
  }
}

TEST_P(LinkRuns, StandBesideHeldForcesAndVectorSprings) {
  NetworkDescription scene = string_in_space(50, 0.05, 1e-3);
  scene.mats.push_back(port(Vec3(0.2, 0.1, 0.0)));
  scene.links.push_back({51 + 1, 20, 30.0, 0.1, 0.0, true});
  ASSERT_TRUE(layout_of(scene).is_by_axis());
  World in_runs = make_world(scene, GetParam());
  World one_by_one = make_world(gathered(scene), GetParam());

  for (World* world : {&in_runs, &one_by_one}) {
    world->set_external_force(7, Vec3(0.01, -0.02, 0.03));
    for (int n = 0; n < 100; ++n) {
      world->impose_position(52, Vec3(0.2, 0.1 + 1e-4 * n, 0.0));
      world->step();
    }
  }

  for (std::uint32_t i = 0; i < scene.mats.size(); ++i) {
    ASSERT_EQ(in_runs.position(i), one_by_one.position(i)) << i;
  }
  EXPECT_NEAR(in_runs.energy().residual(), 0.0, 1e-12);
}

}  // namespace
}  // namespace cordis::test
