// tests/plan/plan_of_network_test.cpp
#include <cmath>

#include <gtest/gtest.h>

#include "sim_node/plan/plan.h"
#include "tests/plan/networks.h"

namespace cordis::test {
namespace {

using plan::Plan;
using plan::plan_of;

TEST(Plan, TellsStableFromUnstable) {
  // K' = 4 at 0.02 s
  const Plan stable = plan_of(oscillator(0.1, 1000.0, 0.0, 1.0, 0.0, 0.01), 1.0);
  EXPECT_TRUE(stable.stability.holds());
  EXPECT_FALSE(stable.stability.diverges());
  EXPECT_NEAR(stable.stability.margin(), 0.75, 1e-9);

  const Plan unstable = plan_of(oscillator(0.1, 1000.0, 0.0, 1.0, 0.0, 0.021), 1.0);
  EXPECT_FALSE(unstable.stability.holds());
  EXPECT_TRUE(unstable.stability.diverges());
}

TEST(Plan, BoundsTheViscosityOfTheBandByThatOfItsLinks) {
  // Z / K = 1e-4 s in every link: a vibration of 10 Hz has Z / m = w^2 1e-4, and 0.3 of the medium.
  NetworkDescription scene = string_in_space(20, 0.04, 1e-4);
  scene.medium_viscosity = 3e-4;
  const double w = 20.0 * M_PI;

  EXPECT_NEAR(plan_of(scene, 10.0).band_edge.viscosity, w * w * 1e-4 + 0.3, 1e-9);
}

TEST(Plan, SaysWhatASwitchingMayGain) {
  NetworkDescription scene = oscillator(0.1, 0.0, 0.0, 1.0, 0.0, 1e-3);
  EXPECT_FALSE(plan_of(scene, 10.0).worst_contact.has_value());
  scene.links.clear();
  scene.state_machines.push_back(contact(4000.0));
  scene.state_links = {{0, 1, 0, 0.0}};

  const Plan plan = plan_of(scene, 10.0);

  ASSERT_TRUE(plan.worst_contact.has_value());
  EXPECT_NEAR(plan.worst_contact->stiffness, 0.04, 1e-12);
  EXPECT_NEAR(plan.worst_contact->worst, 1.0 / 0.99 - 1.0, 1e-12);  // 1 / (1 - K'/4) - 1
}

}  // namespace
}  // namespace cordis::test
