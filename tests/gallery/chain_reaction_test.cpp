// tests/gallery/chain_reaction_test.cpp
#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/gallery/gallery_session.h"

namespace cordis::test {
namespace {

constexpr std::uint32_t kHeld = 0;
constexpr std::uint32_t kFallen = 1;
constexpr std::size_t kLatches = 5;

TEST(ChainReaction, BeginsWithTheKeyAndGoesOnFromLatchToLatchInEveryRound) {
  constexpr double kPressed = -0.008;    // [m]
  constexpr std::uint64_t kApart = 301;  // the first whole number of 0.5 ms above 0.1502 s
  GallerySession session("chain_reaction.yaml");
  std::array<std::vector<std::uint64_t>, kLatches> falls;  // steps
  std::vector<std::uint64_t> presses;                      // steps done
  bool is_down = false;
  session.play_until(9.5, [&] {
    const bool was_down = std::exchange(is_down, session.signal("key") < kPressed);
    if (is_down && !was_down) presses.push_back(session.world().step_count());
    for (const engine::LinkEvent& event : session.events()) {
      if (event.link < kLatches && event.to == kFallen) falls[event.link].push_back(event.step);
    }
  });

  ASSERT_EQ(presses.size(), 2u);
  for (std::size_t round = 0; round < presses.size(); ++round) {
    ASSERT_EQ(falls[0].size(), 2u);
    // in the step after the key was there: the last of a period of two, or the next
    EXPECT_GE(falls[0][round], presses[round] - 1);
    EXPECT_LE(falls[0][round], presses[round]);
    for (std::size_t latch = 1; latch < kLatches; ++latch) {
      ASSERT_EQ(falls[latch].size(), 2u) << latch;
      EXPECT_EQ(falls[latch][round] - falls[latch - 1][round], kApart) << latch;
    }
  }
}

TEST(ChainReaction, HoistsAllWeightsAgain) {
  GallerySession session("chain_reaction.yaml");
  double lowest = 0.0;
  session.play_until(5.0, [&] { lowest = std::min(lowest, session.signal("last")); });

  EXPECT_LT(lowest, -0.279);  // it has lain on the floor
  for (std::uint32_t weight = 0; weight < kLatches; ++weight) {
    EXPECT_EQ(session.world().state_of(weight), kHeld);
    // below the place where its latch has no force by m g / K
    EXPECT_NEAR(session.position("weights", weight).y(), -0.1 - 0.05 * 9.81 / 400.0, 1e-5);
  }
  EXPECT_LT(session.energy_residual(), 1e-9);
}

}  // namespace
}  // namespace cordis::test
