// tests/gallery/anvil_test.cpp
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "node/config/device_limits.h"
#include "sim_node/checks/port_check.h"
#include "tests/gallery/gallery_session.h"

namespace cordis::test {
namespace {

constexpr double kFace = -0.02;   // of the anvil [m]
constexpr double kLeaning = 3.0;  // the hand leans on it [s]

/// The anvil in role mass, with as stiff a coupling as may stand before any hand, or with none.
ChangedScene in_role_mass(const std::string& coupling) {
  return {"anvil", {{"role: liaison, mass_kg: 0.3", "role: mass, mass_kg: 0.3" + coupling}}};
}

/// The force of the hand over how far it has gone in [N/m].
double stiffness_under_the_hand(GallerySession& session, const std::string& hand) {
  session.play_until(kLeaning);
  return -session.signal("blow") / (kFace - session.position(hand).x());
}

TEST(Anvil, IsAsStiffAsSteelInRoleLiaison) {
  GallerySession session("anvil.yaml");
  const double steel = stiffness_under_the_hand(session, "hammer");
  EXPECT_LT(session.signal("blow"), -4.0);

  const ChangedScene changed = in_role_mass("");
  GallerySession coupled("anvil.yaml", changed.overrides());
  const double soft = stiffness_under_the_hand(coupled, "hammer.handle");
  EXPECT_LT(coupled.signal("blow"), -2.0);
  EXPECT_NEAR(soft, 500.0, 100.0) << "the coupling";
  EXPECT_GT(steel, 200.0 * soft);
}

TEST(Anvil, IsTooStiffForADeviceInRoleMass) {
  config::DeviceLimits key;  // of launch_configs/devices/keyboard.yaml
  key.moving_mass_kg = 0.05;
  key.viscosity_n_s_per_m = 1.0;
  const auto uncertainty_of = [&key](const GallerySession& session) {
    return sim::verdict_on(sim::demands_of(session.scene()).at(0), key, 1).uncertainty;
  };
  EXPECT_EQ(uncertainty_of(GallerySession("anvil.yaml")), "");
  const ChangedScene changed = in_role_mass(", coupling: direct");
  EXPECT_NE(uncertainty_of(GallerySession("anvil.yaml", changed.overrides())), "");
}

TEST(Anvil, IsStruckByTheLawOfHertz) {
  GallerySession session("anvil.yaml");
  session.play_until(kLeaning);
  const double pressed = session.position("anvil").x() - session.position("hammer").x();
  EXPECT_NEAR(-session.signal("blow"), 1.0e8 * std::pow(pressed, 1.5), 1e-3);
}

/// How far the hammer goes up and down while the hand leans on the anvil [m].
double shaking_of_the_hammer(GallerySession& session) {
  session.play_until(3.0);
  return session.range_until(4.0, "hammer");
}

TEST(AnvilAfar, ShakesUnderAFirmHandWhoseAnswersAreFourPeriodsLate) {
  GallerySession session("anvil_afar.yaml");
  EXPECT_GT(shaking_of_the_hammer(session), 3e-3);
  EXPECT_NE(session.warnings(), std::vector<std::string>{});

  GallerySession nearby("anvil_afar.yaml", {"hand.delay_periods=2"});
  EXPECT_LT(shaking_of_the_hammer(nearby), 1e-6);
  EXPECT_NEAR(nearby.signal("blow"), -6.2, 0.01);
}

}  // namespace
}  // namespace cordis::test
