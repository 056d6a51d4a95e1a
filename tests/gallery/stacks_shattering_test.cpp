#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "sim_node/engine/connected_pieces.h"
#include "tests/gallery/stage.h"

namespace cordis::test {
namespace {

constexpr std::size_t kRubble = 0;       // the set of all balls of the stacks
constexpr std::uint32_t kWhole = 0;      // states of the mortar
constexpr double kEnergyOfABond = 4e-5;  // [J] K rupture^2 / 2 = 2000 * 0.0002^2 / 2

/// The bonds of mortar that still hold.
std::vector<engine::BoundPair> whole_bonds(const Stage& stage) {
  const std::vector<engine::StateLink>& mortar = stage.world().network().description().state_links;
  std::vector<engine::BoundPair> whole;
  for (std::uint32_t l = 0; l < mortar.size(); ++l) {
    if (stage.world().state_of(l) == kWhole) whole.push_back({mortar[l].mat_a, mortar[l].mat_b});
  }
  return whole;
}

TEST(StacksShattering, StandByThemselvesAndShatterWhenTheyAreHit) {
  Stage stage("stacks_shattering.yaml");
  engine::ConnectedPieces rubble(stage.world().network(), kRubble);
  const auto pieces = [&] { return rubble.find_bound(whole_bonds(stage)); };
  const std::size_t bonds = whole_bonds(stage).size();
  ASSERT_EQ(rubble.members().size(), 108u);

  stage.play_until(1.0);  // the hand rests
  EXPECT_EQ(pieces(), 3u);
  EXPECT_EQ(whole_bonds(stage).size(), bonds);

  double taken = 0.0;  // by bonds that break [J]
  std::size_t broken = 0;
  std::size_t before = 3;
  stage.play_until(2.5, [&] {
    for (const engine::LinkEvent& event : stage.events()) {
      if (event.link == engine::kNoLink) continue;  // balls that knock
      ++broken;
      taken -= event.energy;
    }
    const std::size_t now = pieces();
    ASSERT_GE(now, before);  // what is broken stays broken
    before = now;
  });
  EXPECT_EQ(whole_bonds(stage).size(), bonds - broken);
  EXPECT_GE(before, 50u);  // of 3
  EXPECT_LT(before, 108u);
  // a step before the threshold or a step beyond it, as the account has it
  const double mean = taken / static_cast<double>(broken);
  EXPECT_NEAR(mean, kEnergyOfABond, 0.05 * kEnergyOfABond);
  EXPECT_LT(std::abs(stage.energy_residual()), 1.0e-9);
}

}  // namespace
}  // namespace cordis::test
