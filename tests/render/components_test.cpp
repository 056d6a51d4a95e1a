// tests/render/components_test.cpp
#include "viz_node/render/components.h"

#include <cstdint>
#include <optional>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/rounds.h"

namespace cordis::viz {
namespace {

/// Who is joined to whom, found by looking again and again.
std::vector<std::size_t> joined(std::size_t mats, const std::vector<std::uint32_t>& ends,
                                const std::vector<bool>& acts) {
  std::vector<std::size_t> lowest(mats);
  for (std::size_t mat = 0; mat < mats; ++mat) lowest[mat] = mat;
  for (bool is_other = true; is_other;) {
    is_other = false;
    for (std::size_t link = 0; link < acts.size(); ++link) {
      std::size_t& a = lowest[ends[2 * link]];
      std::size_t& b = lowest[ends[2 * link + 1]];
      if (!acts[link] || a == b) continue;
      a = b = std::min(a, b);
      is_other = true;
    }
  }
  return lowest;
}

TEST(Components, AreWhatLinksJoin) {
  std::mt19937_64 random(20261127);
  for (int round = 0; round < test::rounds(200); ++round) {
    const std::size_t mats = 1 + random() % 40;
    std::vector<std::uint32_t> ends;
    std::vector<bool> acts;
    for (std::size_t link = random() % 40; link-- > 0;) {
      ends.push_back(static_cast<std::uint32_t>(random() % mats));
      ends.push_back(static_cast<std::uint32_t>(random() % mats));
      acts.push_back(random() % 3 != 0);
    }
    Components components;
    components.update(mats, ends, acts);
    const std::vector<std::size_t> lowest = joined(mats, ends, acts);
    std::vector<std::size_t> sizes(mats, 0);
    for (const std::size_t mat : lowest) ++sizes[mat];
    std::size_t last = mats;
    std::size_t of_two_or_more = 0;
    for (const auto& component : components.list()) {
      EXPECT_EQ(component.size, sizes[component.root]);
      EXPECT_LE(component.size, last) << "the largest first";
      last = component.size;
    }
    for (std::size_t mat = 0; mat < mats; ++mat) {
      of_two_or_more += sizes[mat] > 1 ? 1u : 0u;
      EXPECT_EQ(components.colour_of(mat), components.colour_of(lowest[mat]));
      if (sizes[lowest[mat]] == 1) {
        EXPECT_EQ(components.colour_of(mat), std::nullopt);
      }
    }
    EXPECT_EQ(components.list().size(), of_two_or_more);
  }
}

TEST(Components, KeepTheirColoursWhileTheyAreAmongTheLargest) {
  // Three chains: 0 1 2 3, 4 5 6, 7 8.
  const std::vector<std::uint32_t> ends{0, 1, 1, 2, 2, 3, 4, 5, 5, 6, 7, 8};
  Components components;
  components.update(9, ends, {true, true, true, true, true, true});
  EXPECT_EQ(components.colour_of(0), 0u);
  EXPECT_EQ(components.colour_of(4), 1u);
  EXPECT_EQ(components.colour_of(7), 2u);

  // The first one breaks in the middle: what is left of it keeps its colour, the other half gets a new one.
  components.update(9, ends, {true, false, true, true, true, true});
  EXPECT_EQ(components.list().front().root, 4u);
  EXPECT_EQ(components.colour_of(0), 0u);
  EXPECT_EQ(components.colour_of(4), 1u);
  EXPECT_EQ(components.colour_of(7), 2u);
  EXPECT_EQ(components.colour_of(2), 3u);
}

TEST(Components, BeyondTheLargestHaveNoColour) {
  std::vector<std::uint32_t> ends;
  for (std::uint32_t mat = 0; mat < 20; ++mat) ends.push_back(mat);
  Components components;
  components.update(20, ends, std::vector<bool>(10, true));
  EXPECT_EQ(components.list().size(), 10u);
  EXPECT_EQ(components.colour_of(14), 7u);
  EXPECT_EQ(components.colour_of(16), std::nullopt);
}

}  // namespace
}  // namespace cordis::viz
