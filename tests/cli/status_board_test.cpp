// tests/cli/status_board_test.cpp
#include "cli/run/status_board.h"

#include <limits>

#include <gtest/gtest.h>

namespace cordis::cli {
namespace {

msg::NodeStatus status_of(const std::string& node, msg::NodeKind kind, std::uint64_t epoch) {
  msg::NodeStatus status;
  status.node(node);
  status.kind(kind);
  status.epoch(epoch);
  return status;
}

bool ends_with_dash(const std::string& table, const std::string& node) {
  const std::size_t row = table.find("\n" + node + " ") + 1;
  return row > 0 && table.substr(0, table.find('\n', row)).ends_with("  -");
}

TEST(StatusBoard, KeepsTheNewestOfEachNode) {
  StatusBoard board(/*first_epoch=*/100);
  msg::NodeStatus status = status_of("sim", msg::KIND_SIM_NODE, 150);
  status.step(1);
  EXPECT_TRUE(board.put(status));
  status.step(2);
  EXPECT_TRUE(board.put(status));

  ASSERT_NE(board.find("sim"), nullptr);
  EXPECT_EQ(board.find("sim")->step(), 2u);
  EXPECT_EQ(board.find("view"), nullptr);
}

TEST(StatusBoard, ForgetsTheLifeBeforeTheRestartOfANode) {
  StatusBoard board(/*first_epoch=*/100);
  board.put(status_of("sim", msg::KIND_SIM_NODE, 101));
  board.put(status_of("key", msg::KIND_DEVICE_NODE, 102));

  board.begin_life("sim", 200);

  EXPECT_EQ(board.find("sim"), nullptr);
  EXPECT_FALSE(board.put(status_of("sim", msg::KIND_SIM_NODE, 101))) << "it comes late";
  EXPECT_EQ(board.find("sim"), nullptr);
  EXPECT_TRUE(board.put(status_of("sim", msg::KIND_SIM_NODE, 201)));
  EXPECT_NE(board.find("sim"), nullptr);
  EXPECT_NE(board.find("key"), nullptr) << "the others stay";
}

TEST(StatusBoard, KnowsWhetherASimWasPausedBeforeItDied) {
  StatusBoard board(/*first_epoch=*/100);
  const auto put = [&board](msg::NodePhase phase, std::uint64_t epoch) {
    msg::NodeStatus status = status_of("sim", msg::KIND_SIM_NODE, epoch);
    status.phase(phase);
    board.put(status);
  };
  EXPECT_EQ(board.was_paused("sim"), std::nullopt);
  put(msg::PHASE_RUNNING, 101);
  EXPECT_EQ(board.was_paused("sim"), false);
  put(msg::PHASE_PAUSED, 101);

  board.begin_life("sim", 200);
  EXPECT_EQ(board.was_paused("sim"), true);
  put(msg::PHASE_STARTING, 201);
  EXPECT_EQ(board.was_paused("sim"), true) << "a life that has not begun to play";
  put(msg::PHASE_FAILED, 201);
  EXPECT_EQ(board.was_paused("sim"), true);
  put(msg::PHASE_WAITING, 201);
  EXPECT_EQ(board.was_paused("sim"), false);
}

TEST(StatusBoard, KnowsOfAPauseThatArrivesAfterTheDeath) {
  StatusBoard board(/*first_epoch=*/100);
  msg::NodeStatus status = status_of("sim", msg::KIND_SIM_NODE, 101);
  status.phase(msg::PHASE_RUNNING);
  board.put(status);
  board.begin_life("sim", 200);
  status.phase(msg::PHASE_PAUSED);
  EXPECT_FALSE(board.put(status));
  EXPECT_EQ(board.find("sim"), nullptr);
  EXPECT_EQ(board.was_paused("sim"), true);

  msg::NodeStatus next = status_of("sim", msg::KIND_SIM_NODE, 201);
  next.phase(msg::PHASE_RUNNING);
  board.put(next);
  board.put(status);
  EXPECT_EQ(board.was_paused("sim"), false) << "the newer life counts";
}

TEST(StatusBoard, RefusesProcessesOlderThanTheRun) {
  StatusBoard board(/*first_epoch=*/100);
  EXPECT_FALSE(board.put(status_of("sim", msg::KIND_SIM_NODE, 99)));
  EXPECT_EQ(board.find("sim"), nullptr);
}

TEST(StatusBoard, AddsUpTheLateTicksOfAllNodes) {
  StatusBoard board(/*first_epoch=*/0);
  for (const char* node : {"sim", "key"}) {
    msg::NodeStatus status = status_of(node, msg::KIND_DEVICE_NODE, 1);
    status.late_by_machine(3);
    status.late_by_work(1);
    board.put(status);
  }
  EXPECT_EQ(board.late_ticks().by_machine, 6u);
  EXPECT_EQ(board.late_ticks().by_work, 2u);
}

TEST(StatusTable, ReportsRateOverrunsLatencyDriftAndState) {
  StatusBoard board(0);
  msg::NodeStatus sim = status_of("sim", msg::KIND_SIM_NODE, 1);
  sim.target_rate_hz(1000);
  sim.mean_rate_hz(999.96);
  sim.overruns(12);
  sim.late_by_machine(9);
  sim.late_by_work(3);
  sim.silent_ticks(240);
  sim.energy_drift(1.25e-7);
  sim.energy_j(0.0125);
  sim.port_work_j(0.03);
  sim.switching_energy_j(-0.0005);
  sim.dissipated_j(0.017);
  sim.integration_error_j(-0.00025);
  sim.overflowed_steps(3);
  sim.forgotten_pairs(17);
  sim.refused_inputs(5);
  sim.largest_stability_number(1.75);
  sim.largest_partners(7);
  sim.certified_partners(12);
  sim.step(10000);
  sim.state_hash(0x0123456789abcdefull);
  sim.phase(msg::PHASE_STOPPED);
  board.put(sim);
  msg::NodeStatus key = status_of("keyboard", msg::KIND_DEVICE_NODE, 1);
  key.target_rate_hz(1000);
  key.mean_rate_hz(1000);
  key.dropped(3);
  key.latency_count(9000);
  key.latency_p50_s(56e-6);
  key.latency_p99_s(98.4e-6);
  key.latency_max_s(2.31e-3);
  key.port_energy_j(-0.002);
  key.passivity_ticks(7);
  key.link_samples(20000);
  key.link_unanswered(240);
  board.put(key);

  EXPECT_EQ(
      status_table({"sim", "keyboard", "view"}, board),
      R"(node      rate [Hz]  wanted  overruns  lost  latency p50 [us]  p99   max  energy drift  late ticks
sim          1000.0    1000        12     0                 -    -     -       1.2e-07  not woken 9, scene too slow 3, device silent 240
keyboard     1000.0    1000         0     3                56   98  2310             -  none
view      no status was received
energy 0.0125 J: 0.03 J through the ports, -0.0005 J by changes of state, 0.017 J taken by viscosity; largest K' + 2 Z' 1.75 of 4
integration error -0.00025 J
a mass of a set touched 7 others at once, certified up to 12
steps with more pairs in range than room, slow: 3
states of pairs FORGOTTEN for lack of memory: 17
positions, forces and parameters refused, not finite: 5
state hash 0123456789abcdef after 10000 steps
the hand gave keyboard 0.002 J, damped in 7 ticks
keyboard: 1.20 % of 20000 samples without an answer of their own
)");
}

TEST(StatusTable, CallsAStabilityNumberBeyondAllMeaningNotBounded) {
  const auto table_of = [](double number) {
    StatusBoard board(0);
    msg::NodeStatus sim = status_of("sim", msg::KIND_SIM_NODE, 1);
    sim.largest_stability_number(number);
    board.put(sim);
    return status_table({"sim"}, board);
  };
  const auto has = [](const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
  };
  for (const double number :
       {1.2e64, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()})
    EXPECT_TRUE(has(table_of(number), "largest K' + 2 Z' not bounded\n")) << table_of(number);
  EXPECT_TRUE(has(table_of(41.0), "largest K' + 2 Z' 41 of 4\n")) << table_of(41.0);
}

TEST(StatusTable, SaysThatAnEnergyIsNotFiniteAndShowsNoFigureOfIt) {
  StatusBoard board(0);
  msg::NodeStatus sim = status_of("sim", msg::KIND_SIM_NODE, 1);
  sim.energy_j(std::numeric_limits<double>::quiet_NaN());
  sim.port_work_j(2e229);
  board.put(sim);
  const std::string table = status_table({"sim"}, board);
  EXPECT_NE(table.find("\nenergy: not a finite number\n"), std::string::npos) << table;
  EXPECT_EQ(table.find("nan"), std::string::npos) << table;
  EXPECT_EQ(table.find("e+229"), std::string::npos) << table;
}

TEST(StatusTable, ReportsCausesInTheWordsOfTheNode) {
  StatusBoard board(0);
  msg::NodeStatus key = status_of("key", msg::KIND_DEVICE_NODE, 1);
  key.target_rate_hz(1000);
  key.late_by_work(2);
  key.silent_ticks(31);
  board.put(key);
  EXPECT_NE(status_table({"key"}, board).find("  own work too slow 2, scene silent 31\n"),
            std::string::npos);
}

TEST(StatusTable, ReportsNoCausesOfANodeWithoutARate) {
  StatusBoard board(0);
  msg::NodeStatus sim = status_of("sim", msg::KIND_SIM_NODE, 1);  // as in lockstep and asap
  sim.ticks(1000);
  sim.silent_ticks(31);
  board.put(sim);
  EXPECT_EQ(status_table({"sim"}, board).find("silent"), std::string::npos);
  EXPECT_TRUE(ends_with_dash(status_table({"sim"}, board), "sim"));

  msg::NodeStatus view =
      status_of("view", msg::KIND_VIZ_NODE, 1);  // it skips frames, and is never late
  view.target_rate_hz(25);
  board.put(view);
  EXPECT_TRUE(ends_with_dash(status_table({"view"}, board), "view"));
}

TEST(StatusTable, CountsNoSilenceOfANodeThatIsStopped) {
  StatusBoard board(0);
  msg::NodeStatus sim = status_of("sim", msg::KIND_SIM_NODE, 1);
  sim.target_rate_hz(1000);
  sim.silent_ticks(31);
  board.put(sim);

  board.begin_stop();
  sim.silent_ticks(500);
  sim.late_by_machine(1);
  board.put(sim);

  EXPECT_NE(status_table({"sim"}, board).find("  not woken 1, device silent 31\n"),
            std::string::npos);
}

TEST(StatusTable, ReportsWhyANodeFailed) {
  StatusBoard board(0);
  msg::NodeStatus sim = status_of("sim", msg::KIND_SIM_NODE, 1);
  sim.phase(msg::PHASE_FAILED);
  sim.text("the scene diverged");
  board.put(sim);
  EXPECT_NE(status_table({"sim"}, board).find("sim failed: the scene diverged\n"),
            std::string::npos);
}

TEST(StatusTable, SaysWhatADeviceEndsWith) {
  StatusBoard board(0);
  msg::NodeStatus key = status_of("key", msg::KIND_DEVICE_NODE, 1);
  key.phase(msg::PHASE_RUNNING);
  key.text("1 axis, driver kfb1");
  board.put(key);
  EXPECT_EQ(status_table({"key"}, board).find("driver kfb1"), std::string::npos);

  key.phase(msg::PHASE_STOPPED);
  key.text("the device was never connected; another node played it");
  board.put(key);
  EXPECT_NE(status_table({"key"}, board)
                .find("key: the device was never connected; another node played it\n"),
            std::string::npos);
}

TEST(StatusTable, SaysWhereTheTakeIs) {
  StatusBoard board(0);
  msg::NodeStatus record = status_of("record", msg::KIND_RECORD_NODE, 1);
  record.text("/takes/take-2.mcap, 3.1 MB");
  board.put(record);
  EXPECT_NE(status_table({"record"}, board).find("record: /takes/take-2.mcap, 3.1 MB\n"),
            std::string::npos);
}

TEST(StatusTable, WritesTheWholeHash) {
  StatusBoard board(0);
  msg::NodeStatus sim = status_of("sim", msg::KIND_SIM_NODE, 1);
  sim.state_hash(0xab);
  board.put(sim);
  EXPECT_NE(
      status_table({"sim"}, board).find("\nlast known state hash 00000000000000ab after 0 steps\n"),
      std::string::npos);
  sim.phase(msg::PHASE_STOPPED);
  board.put(sim);
  EXPECT_NE(status_table({"sim"}, board).find("\nstate hash 00000000000000ab after 0 steps\n"),
            std::string::npos);
}

}  // namespace
}  // namespace cordis::cli
