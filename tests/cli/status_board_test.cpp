// tests/cli/status_board_test.cpp
#include "cli/status_board.h"

#include <gtest/gtest.h>

namespace cordis::cli {
namespace {

msg::NodeStatus status_of(const std::string& node, const std::string& kind, std::uint64_t run) {
  msg::NodeStatus status;
  status.node(node);
  status.kind(kind);
  status.run(run);
  return status;
}

TEST(StatusBoard, KeepsTheNewestOfEachNode) {
  StatusBoard board(/*first_run=*/100);
  msg::NodeStatus status = status_of("sim", "sim_node", 150);
  status.step(1);
  EXPECT_TRUE(board.put(status));
  status.step(2);
  EXPECT_TRUE(board.put(status));

  ASSERT_NE(board.find("sim"), nullptr);
  EXPECT_EQ(board.find("sim")->step(), 2u);
  EXPECT_EQ(board.find("view"), nullptr);
}

TEST(StatusBoard, RefusesProcessesOlderThanTheRun) {
  StatusBoard board(/*first_run=*/100);
  EXPECT_FALSE(board.put(status_of("sim", "sim_node", 99)));
  EXPECT_EQ(board.find("sim"), nullptr);
}

TEST(StatusTable, TellsRateOverrunsLatencyDriftAndState) {
  StatusBoard board(0);
  msg::NodeStatus sim = status_of("sim", "sim_node", 1);
  sim.target_rate_hz(1000);
  sim.mean_rate_hz(999.96);
  sim.overruns(12);
  sim.energy_drift(1.25e-7);
  sim.step(10000);
  sim.state_hash(0x0123456789abcdefull);
  board.put(sim);
  msg::NodeStatus key = status_of("keyboard", "device_node", 1);
  key.target_rate_hz(1000);
  key.mean_rate_hz(1000);
  key.dropped(3);
  key.latency_count(9000);
  key.latency_p50_s(56e-6);
  key.latency_p99_s(98.4e-6);
  key.latency_max_s(2.31e-3);
  board.put(key);

  EXPECT_EQ(
      status_table({"sim", "keyboard", "view"}, board),
      "node      rate [Hz]  wanted  overruns  lost  latency p50 [us]  p99   max  energy drift\n"
      "sim          1000.0    1000        12     0                 -    -     -       1.2e-07\n"
      "keyboard     1000.0    1000         0     3                56   98  2310             -\n"
      "view      no status was received\n"
      "state hash 0123456789abcdef after 10000 steps\n");
}

TEST(StatusTable, WritesTheWholeHash) {
  StatusBoard board(0);
  msg::NodeStatus sim = status_of("sim", "sim_node", 1);
  sim.state_hash(0xab);
  board.put(sim);
  EXPECT_NE(status_table({"sim"}, board).find("state hash 00000000000000ab after 0 steps\n"),
            std::string::npos);
}

}  // namespace
}  // namespace cordis::cli
