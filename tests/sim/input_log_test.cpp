// tests/sim/input_log_test.cpp
#include "sim_node/run/input_log.h"

#include <gtest/gtest.h>

#include "tests/sim/loaded_scenes.h"
#include "tests/support/allocation_guard.h"

namespace cordis::sim {
namespace {

TEST(InputLog, KeepsInputsInTheirOrderAndTheirTurns) {
  InputLog log;
  Request request;
  request.step = 8;
  request.source = std::make_shared<const RequestSource>(RequestSource{msg::VERB_PAUSE, "", {}});
  {
    const test::AllocationGuard guard;
    log.sample(key_sample(1, -0.01), true, DeviceReach());
    log.end_turn();
    log.sample(key_sample(2, -0.02), false, DeviceReach());
    log.command(request);
    log.repeat(7);
    log.end_turn();
    log.hold();
    log.let_go(PassedBound::kEnergy, 12);
    EXPECT_EQ(guard.count(), 0u);
  }
  EXPECT_EQ(log.turns(), 2u);
  using Kind = InputRecord::Kind;
  const std::vector<std::pair<Kind, std::uint64_t>> expected{
      {Kind::kReach, 0},     {Kind::kReach, 0},     {Kind::kReach, 0},   {Kind::kReach, 0},
      {Kind::kPositions, 0}, {Kind::kPositions, 1}, {Kind::kCommand, 1}, {Kind::kRepeat, 1},
      {Kind::kHold, 2},      {Kind::kLetGo, 2}};
  InputRecord record;
  std::uint64_t number = 1;
  for (const auto& [kind, turn] : expected) {
    ASSERT_TRUE(log.take(record));
    EXPECT_EQ(record.kind, kind);
    EXPECT_EQ(record.turn, turn);
    EXPECT_EQ(record.number, ++number);
    if (kind == Kind::kPositions) {
      EXPECT_EQ(record.value[0], turn == 0 ? -0.01 : -0.02);
    }
    if (kind == Kind::kCommand) {
      EXPECT_EQ(record.command, request.source);
    }
  }
  EXPECT_FALSE(log.take(record));
  EXPECT_EQ(log.lost(), 0u);
}

TEST(InputLog, CountsWhatFindsNoRoomAndLeavesItsNumberOut) {
  InputLog log;
  for (std::size_t i = 0; i < InputLog::kRoom + 3; ++i) log.hold();
  EXPECT_EQ(log.lost(), 3u);
  EXPECT_TRUE(log.is_half_full());
  InputRecord record;
  while (log.take(record)) {
  }
  EXPECT_EQ(record.number, InputLog::kRoom + 1);
  EXPECT_FALSE(log.is_half_full());
  log.hold();
  ASSERT_TRUE(log.take(record));
  EXPECT_EQ(record.number, InputLog::kRoom + 5) << "three are missing";
}

TEST(InputLog, ARequestThatWasNotDoneLeavesNothing) {
  InputLog log;
  Request request;
  request.done = false;
  request.source = std::make_shared<const RequestSource>();
  log.command(request);
  InputRecord record;
  EXPECT_FALSE(log.take(record));
}

}  // namespace
}  // namespace cordis::sim
