// tests/gallery/stacks_shattering_test.cpp
#include <cmath>

#include <gtest/gtest.h>

#include "tests/gallery/stage.h"

namespace cordis::test {
namespace {

constexpr double kEnergyOfABond = 4e-5;  // [J] K rupture^2 / 2 = 2000 * 0.0002^2 / 2

TEST(StacksShattering, StandByThemselvesAndShatterWhenTheyAreHit) {
  Stage stage("stacks_shattering.yaml");
  const std::size_t bonds = stage.world().network().description().state_links.size();

  stage.play_until(1.0);  // the hand rests
  EXPECT_EQ(stage.signal("pieces"), 3.0);
  EXPECT_EQ(stage.signal("bonds"), static_cast<double>(bonds));

  double taken = 0.0;  // by bonds that break [J]
  std::size_t broken = 0;
  double pieces = 3.0;
  stage.play_until(2.5, [&] {
    for (const engine::LinkEvent& event : stage.events()) {
      if (event.link == engine::kNoLink) continue;  // balls that knock
      ++broken;
      taken -= event.energy;
    }
    ASSERT_GE(stage.signal("pieces"), pieces);  // what is broken stays broken
    pieces = stage.signal("pieces");
  });
  EXPECT_EQ(stage.signal("bonds"), static_cast<double>(bonds - broken));
  EXPECT_EQ(pieces, 53.0);
  // a step before the threshold or a step beyond it, as the account has it
  const double mean = taken / static_cast<double>(broken);
  EXPECT_NEAR(mean, kEnergyOfABond, 0.05 * kEnergyOfABond);
  EXPECT_LT(std::abs(stage.energy_residual()), 1.0e-9);
}

}  // namespace
}  // namespace cordis::test
