#include <cmath>

#include <gtest/gtest.h>

#include "node/config/device_limits.h"
#include "sim_node/checks/port_check.h"
#include "tests/gallery/stage.h"

namespace cordis::test {
namespace {

constexpr double kFace = -0.02;   // of the anvil [m]
constexpr double kLeaning = 3.0;  // the hand leans on it [s]

/// The anvil in role mass, with as stiff a coupling as may stand before any hand, or with none.
ChangedScene in_role_mass(const std::string& coupling) {
  return {"anvil", {{"role: liaison, mass_kg: 0.3", "role: mass, mass_kg: 0.3" + coupling}}};
}

/// The force of the hand over how far it has gone in [N/m].
double stiffness_under_the_hand(Stage& stage, const std::string& hand) {
  stage.play_until(kLeaning);
  return -stage.signal("blow") / (kFace - stage.position(hand).x());
}

TEST(Anvil, IsAsStiffAsSteelInRoleLiaison) {
  Stage stage("anvil.yaml");
  const double steel = stiffness_under_the_hand(stage, "hammer");
  EXPECT_LT(stage.signal("blow"), -4.0);

  const ChangedScene changed = in_role_mass("");
  Stage coupled("anvil.yaml", changed.overrides());
  const double soft = stiffness_under_the_hand(coupled, "hammer.handle");
  EXPECT_LT(coupled.signal("blow"), -2.0);
  EXPECT_NEAR(soft, 500.0, 100.0) << "the coupling";
  EXPECT_GT(steel, 200.0 * soft);
}

TEST(Anvil, IsTooStiffForADeviceInRoleMass) {
  config::DeviceLimits key;  // of launch_configs/devices/keyboard.yaml
  key.moving_mass_kg = 0.05;
  key.viscosity_n_s_per_m = 1.0;
  const auto doubt_about = [&key](const Stage& stage) {
    return sim::verdict_on(sim::demands_of(stage.scene()).at(0), key, 1).doubt;
  };
  EXPECT_EQ(doubt_about(Stage("anvil.yaml")), "");
  const ChangedScene changed = in_role_mass(", coupling: direct");
  EXPECT_NE(doubt_about(Stage("anvil.yaml", changed.overrides())), "");
}

TEST(Anvil, IsStruckByTheLawOfHertz) {
  Stage stage("anvil.yaml");
  stage.play_until(kLeaning);
  const double pressed = stage.position("anvil").x() - stage.position("hammer").x();
  EXPECT_NEAR(-stage.signal("blow"), 1.0e8 * std::pow(pressed, 1.5), 1e-3);
}

}  // namespace
}  // namespace cordis::test
