// tests/plan/table_pulse_test.cpp -- which pulses of tables a step may pass over.
#include "sim_node/plan/table_pulse.h"

#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "sim_node/plan/rate.h"
#include "tests/plan/networks.h"

namespace cordis::test {
namespace {

/// A mass that a table pushes.
NetworkDescription pushed(const std::vector<double>& times, const std::vector<double>& forces) {
  NetworkDescription scene = oscillator(1.0, 1000.0, 0.0, 0.0, 0.0, 1e-3);
  engine::TimeFunction table;
  table.time = times;
  for (const double force : forces) table.value.emplace_back(force, 0, 0);
  scene.time_functions.push_back(std::move(table));
  engine::Drive drive;
  drive.mat = 1;
  drive.is_force = true;
  scene.drives.push_back(drive);
  return scene;
}

TEST(TablePulse, IsAsWideAsAtHalfItsHeight) {
  const auto pulse = plan::narrowest_pulse(pushed({0.1003, 0.10035, 0.1004}, {0, 100, 0}));
  ASSERT_TRUE(pulse);
  EXPECT_NEAR(pulse->width, 5e-5, 1e-12);
  EXPECT_DOUBLE_EQ(pulse->time, 0.10035);
  EXPECT_EQ(pulse->drive, 0u);

  const auto bell = plan::narrowest_pulse(
      pushed({1, 2, 3, 4, 5, 6, 7, 8, 9}, {0, -10, -50, -90, -100, -90, -50, -10, 0}));
  ASSERT_TRUE(bell);
  EXPECT_NEAR(bell->width, 4.0, 1e-12);

  const auto level = plan::narrowest_pulse(pushed({1, 1.001, 1.1, 1.2, 1.201}, {2, 3, 3, 3, 2}));
  ASSERT_TRUE(level);
  EXPECT_NEAR(level->width, 0.2, 1e-12);
}

TEST(TablePulse, IsNoJumpNorASmallRippleNorWhatIsBeforeTheStart) {
  EXPECT_FALSE(plan::narrowest_pulse(pushed({1, 1.00001}, {0, 1})));
  EXPECT_FALSE(plan::narrowest_pulse(pushed({-2, -1.99, -1.98}, {0, 1, 0})));
  EXPECT_FALSE(plan::narrowest_pulse(pushed({1}, {1})));
  const auto ripple = plan::narrowest_pulse(pushed({0, 1, 1.001, 1.002, 2}, {0, 10, 9.9, 10, 0}));
  ASSERT_TRUE(ripple);
  EXPECT_NEAR(ripple->width, 1.0, 0.01);
  const auto lower_side = plan::narrowest_pulse(pushed({0, 1, 2, 3}, {0, 10, 5, 5}));
  ASSERT_TRUE(lower_side);
  EXPECT_NEAR(lower_side->width, 0.25 + 0.5, 1e-12);
}

TEST(TablePulse, IsMetByTheRateThatAnAccuracyAsksFor) {
  const NetworkDescription scene = pushed({0.1003, 0.10035, 0.1004}, {0, 100, 0});
  const plan::FormulaRate rate = plan::rate_by_formula(scene, {0.1, 5.0, 0.1}, 1000.0);
  EXPECT_EQ(rate.reason, plan::RateReason::kPulse);
  EXPECT_STREQ(to_string(rate.reason), "the shortest pulse of a table");
  EXPECT_NEAR(rate.needed_hz, 20000.0, 1e-3);
  EXPECT_DOUBLE_EQ(rate.rate_hz, 20000.0);
}

}  // namespace
}  // namespace cordis::test
