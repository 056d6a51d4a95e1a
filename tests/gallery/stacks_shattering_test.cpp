// tests/gallery/stacks_shattering_test.cpp
#include <cmath>

#include <gtest/gtest.h>

#include "tests/gallery/gallery_session.h"

namespace cordis::test {
namespace {

constexpr double kEnergyOfABond = 4e-5;  // [J] K rupture^2 / 2 = 2000 * 0.0002^2 / 2

TEST(StacksShattering, StandByThemselvesAndShatterWhenTheyAreHit) {
  GallerySession session("stacks_shattering.yaml");
  const std::size_t bonds = session.world().network().description().state_links.size();

  session.play_until(1.0);  // the hand rests
  EXPECT_EQ(session.signal("pieces"), 3.0);
  EXPECT_EQ(session.signal("bonds"), static_cast<double>(bonds));

  double taken = 0.0;  // by bonds that break [J]
  std::size_t broken = 0;
  double pieces = 3.0;
  session.play_until(2.5, [&] {
    for (const engine::LinkEvent& event : session.events()) {
      if (event.link == engine::kNoLink) continue;  // balls that knock
      ++broken;
      taken -= event.energy;
    }
    ASSERT_GE(session.signal("pieces"), pieces);  // what is broken stays broken
    pieces = session.signal("pieces");
  });
  EXPECT_EQ(session.signal("bonds"), static_cast<double>(bonds - broken));
  EXPECT_EQ(pieces, 54.0);
  // a step before the threshold or a step beyond it, as the account has it
  const double mean = taken / static_cast<double>(broken);
  EXPECT_NEAR(mean, kEnergyOfABond, 0.05 * kEnergyOfABond);
  EXPECT_LT(std::abs(session.energy_residual()), 1.0e-9);
}

}  // namespace
}  // namespace cordis::test
