// tests/checked/checked_test.cpp -- preconditions outside the engine, compiled with their checks.
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "cli/table/column_summary.h"
#include "device_node/force_guard.h"
#include "node/period_grid.h"
#include "sim_node/run/tick_division.h"
#include "viz_node/frame_pace.h"
#include "viz_node/render/number_text.h"
#include "viz_node/render/vectors.h"
#include "viz_node/web/flow_credit.h"

namespace cordis {
namespace {

struct Misuse {
  std::string condition;  // a part of what is printed
  std::function<void()> act;
};

TEST(CheckedDeathTest, EachMisuseIsNamedAndEndsTheProgram) {
  ::testing::FLAGS_gtest_death_test_style = "threadsafe";
  viz::FlowCredit credit;
  credit.sent(7, 70, 0);
  device::ForceGuard guard(device::ForceGuardSettings{});
  guard.accept({});

  const std::vector<Misuse> misuses = {
      {"length > 0",
       [] {
         viz::normalized({0.0, 0.0, 0.0});
       }},
      {"length > 0", [] { viz::round_length(0.0); }},
      {"isfinite", [] { viz::round_length(std::numeric_limits<double>::infinity()); }},
      {"rate_hz > 0", [] { const viz::FramePace pace(-1.0); }},
      {"may_send", [&] { credit.sent(7, 70, 0); }},
      {"count_ > 0", [] { cli::ColumnSummary().json("m"); }},
      {"gesture_rate_hz > 0", [] { const sim::TickDivision division(1000.0, 0.0); }},
      {"numerator >= denominator", [] { const sim::TickDivision division(999.0, 1000.0); }},
      {"rate_hz > 0", [] { const node::PeriodGrid grid(0.0, 0); }},
      {"share <= 1", [&] { guard.tick(0.0, {}, 1.5); }},
  };
  for (const Misuse& misuse : misuses) {
    EXPECT_DEATH(misuse.act(), "this does not hold: .*" + misuse.condition) << misuse.condition;
  }
}

TEST(Checked, NoneIsHurtByProperUse) {
  EXPECT_EQ(viz::round_length(0.07), 0.05);
  EXPECT_EQ(sim::TickDivision(44100.0, 1000.0).max_steps(), 45u);
  EXPECT_EQ(sim::TickDivision(1000.0 * (1.0 - 1e-15), 1000.0).max_steps(), 1u);
}

}  // namespace
}  // namespace cordis
