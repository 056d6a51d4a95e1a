// tests/cli/tick_steps_test.cpp -- gesture periods of a session that was paused, stepped and reset.
#include "cli/export/tick_steps.h"

#include <string>

#include <gtest/gtest.h>

#include "idl/inputs.h"

namespace cordis::cli {
namespace {

msg::InputEvent command_of(msg::InputKind kind, const std::string& argument = "") {
  msg::InputEvent event;
  event.kind(kind);
  event.argument(argument);
  return event;
}

TEST(TickSteps, FollowsPausesAndSingleSteps) {
  TickSteps ticks(1, 4000.0, 1000.0);
  EXPECT_TRUE(ticks.play_turn());
  EXPECT_TRUE(ticks.play_turn());
  EXPECT_EQ(ticks.step(), 8u);
  ticks.execute(command_of(msg::INPUT_PAUSE));
  EXPECT_FALSE(ticks.play_turn());
  EXPECT_EQ(ticks.step(), 8u);
  ticks.execute(command_of(msg::INPUT_STEP, "6"));
  EXPECT_TRUE(ticks.play_turn());
  EXPECT_FALSE(ticks.play_turn());
  EXPECT_FALSE(ticks.play_turn());
  EXPECT_EQ(ticks.step(), 14u);
  ticks.execute(command_of(msg::INPUT_RESUME));
  EXPECT_TRUE(ticks.play_turn());
  EXPECT_EQ(ticks.step(), 16u);
}

TEST(TickSteps, CountsOneSceneOfSeveral) {
  TickSteps ticks(2, 4000.0, 1000.0);
  EXPECT_FALSE(ticks.play_turn());
  ticks.execute(command_of(msg::INPUT_RESET));
  EXPECT_TRUE(ticks.play_turn());
  EXPECT_EQ(ticks.step(), 4u);
  ticks.load();
  EXPECT_FALSE(ticks.play_turn());
  EXPECT_EQ(ticks.step(), 4u);
}

/// The last step of tick k is the last one that is not later than the end of the gesture period.
TEST(TickSteps, HasUnevenTicksWhereTheRatesAsk) {
  TickSteps ticks(1, 44'100.0, 1000.0);
  for (std::uint64_t k = 1; k <= 1000; ++k) {
    ASSERT_TRUE(ticks.play_turn());
    ASSERT_EQ(ticks.step(), 441 * k / 10);
  }
}

}  // namespace
}  // namespace cordis::cli
