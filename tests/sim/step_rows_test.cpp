// tests/sim/step_rows_test.cpp -- signals of each step on their way to a message.
#include "sim_node/run/step_rows.h"

#include <gtest/gtest.h>

#include "tests/sim/loaded_scenes.h"
#include "tests/support/allocation_guard.h"

namespace cordis::sim {
namespace {

/// swing_text() with its height at each step as well.
std::string swing_by_step() {
  return swing_text() + "  fast: {of: bob, quantity: position, rate: step}\n";
}

TEST(StepRows, HoldTheSignalAfterEachStepWithoutAllocating) {
  const auto loaded = loaded_scene_of(swing_by_step());
  EventRoom events(0);
  const test::AllocationGuard guard;
  for (std::uint64_t tick = 0; tick < 10; ++tick) {
    loaded->step_rows.clear();
    for (int j = 1; j <= 4; ++j) {
      loaded->simulation.advance(1, events, &loaded->step_rows);
      EXPECT_EQ(*loaded->step_rows.row(static_cast<std::size_t>(j - 1)),
                loaded->simulation.world().position(1).x());
    }
    EXPECT_EQ(loaded->step_rows.count(), 4u);
    EXPECT_EQ(loaded->step_rows.first_step(), 4 * tick + 1);
    loaded->frames.add(loaded->step_rows);
  }
  EXPECT_EQ(guard.count(), 0u);
}

TEST(StepRows, BeyondTheBufferOfTheFramesAreCountedAndFollowEachOther) {
  const auto loaded = loaded_scene_of(swing_by_step());
  EventRoom events(0);
  std::uint64_t row_count = 0;
  for (int tick = 0; tick < 500; ++tick) {  // 12 frames and a half of 40 ticks
    loaded->step_rows.clear();
    loaded->simulation.advance(4, events, &loaded->step_rows);
    loaded->frames.add(loaded->step_rows);
    row_count += 4;
  }
  loaded->frames.turn(loaded->simulation.world(), 0.0, 0);
  const std::uint64_t kept = loaded->frames.published().step_row_count;
  EXPECT_EQ(loaded->frames.published().first_step_row, 1u);
  EXPECT_EQ(loaded->frames.published().dropped_step_rows, 0u);
  EXPECT_LT(kept, row_count);
  EXPECT_GE(kept, row_count / 2);

  loaded->step_rows.clear();
  loaded->simulation.advance(4, events, &loaded->step_rows);
  loaded->frames.add(loaded->step_rows);
  loaded->frames.turn(loaded->simulation.world(), 0.0, 0);
  EXPECT_EQ(loaded->frames.published().dropped_step_rows, row_count - kept);
  EXPECT_EQ(loaded->frames.published().first_step_row, row_count + 1);
  EXPECT_EQ(loaded->frames.published().step_row_count, 4u);
}

}  // namespace
}  // namespace cordis::sim
