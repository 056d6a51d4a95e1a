// tests/cli/bench_test.cpp -- what `cordis bench` measures and makes of it, whatever time it takes.
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "cli/bench/bench_networks.h"
#include "cli/bench/bench_report.h"
#include "cli/bench/bench_verb.h"
#include "cli/bench/plain_loop.h"
#include "cli/bench/turns.h"
#include "cli/exit_code.h"
#include "cli/run/status_board.h"
#include "sim_node/engine/world.h"
#include "tests/cli/captured_run.h"

namespace cordis::cli {
namespace {

/// Gives the masses the speed with which their positions of the step before were those of the start, as
/// the plain loop takes it.
void begin_as_plain_loop(engine::NetworkDescription& network) {
  engine::World probe(std::make_shared<const engine::Network>(network));
  probe.step();
  for (std::uint32_t i = 0; i < network.mats.size(); ++i)
    network.mats[i].velocity = 0.5 * network.step / network.mats[i].mass * probe.link_force(i);
}

/// A control that steps something else would make every ratio of the table wrong.
TEST(Bench, ThePlainLoopMovesAsTheEngineDoes) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> moved(-1e-4, 1e-4);
  for (const int dimension : {1, 2, 3}) {
    engine::NetworkDescription network = square_net(dimension, 12);
    for (engine::Mat& mat : network.mats) {
      for (int axis = 0; axis < dimension; ++axis) mat.position[axis] += moved(random);
    }
    for (engine::Link& link : network.links) link.viscosity = 0.0;
    begin_as_plain_loop(network);
    PlainLoop plain(network);
    engine::World world(std::make_shared<const engine::Network>(network));
    for (int n = 0; n < 500; ++n) {
      plain.step();
      world.step();
    }
    double motion = 0.0;
    for (std::uint32_t i = 0; i < network.mats.size(); ++i) {
      for (int axis = 0; axis < dimension; ++axis) {
        ASSERT_NEAR(plain.position(i, axis), world.position(i)[axis], 1e-11)
            << dimension << "-D, mass " << i;
      }
      motion = std::max(motion, (world.position(i) - network.mats[i].position).norm());
    }
    EXPECT_GT(motion, 1e-5) << dimension << "-D";
  }
}

TEST(Bench, NetworksHaveTheirSizes) {
  EXPECT_EQ(square_net(3, 30).mats.size(), 900u);
  EXPECT_EQ(square_net(3, 30).links.size(), 2u * 30 * 29);
  EXPECT_EQ(strings(1000).mats.size(), 5u * 202);
  for (const std::uint32_t balls : {4u, 100u, 2500u, 10007u}) {
    const auto count = static_cast<double>(agglomerate(balls).mats.size());
    EXPECT_NEAR(count, balls, 0.05 * balls + 4.0);
  }
}

/// What is measured must not blow up while it is measured.
TEST(Bench, NetworksStayWhereTheyAre) {
  for (const engine::NetworkDescription& network :
       {square_net(1, 10), square_net(3, 10), strings(400), agglomerate(400)}) {
    engine::World world(std::make_shared<const engine::Network>(network));
    for (int n = 0; n < 20000; ++n) world.step();
    for (std::uint32_t i = 0; i < network.mats.size(); ++i)
      ASSERT_LT((world.position(i) - network.mats[i].position).norm(), 0.02);
  }
}

TEST(Bench, TimesAreThoseOfOneCall) {
  std::array<int, 2> calls{};
  const std::vector<double> times =
      times_in_turns({[&calls] { ++calls[0]; }, [&calls] { ++calls[1]; }}, 3);
  ASSERT_EQ(times.size(), 2u);
  for (const double time : times) EXPECT_GT(time, 0.0);
  for (const int count : calls) EXPECT_GT(count, 3);
}

TEST(Bench, FiguresOfTheForceLoopAreThoseOfTheTable) {
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> some(0.0, 1e-2);
  for (int round = 0; round < 50; ++round) {
    msg::NodeStatus status;
    status.node("key");
    status.kind(msg::KIND_DEVICE_NODE);
    status.epoch(1);
    status.ticks(1000);
    status.target_rate_hz(round % 2 == 0 ? 0.0 : 1000.0);
    status.mean_rate_hz(1e5 * some(random));
    status.overruns(random() % 100);
    status.latency_count(random() % 3);
    status.latency_p50_s(some(random));
    status.latency_p99_s(some(random));
    status.latency_max_s(some(random));
    StatusBoard board(0);
    board.put(status);
    const std::string output =
        "key | info the key of a node that is called key\n" + status_table({"sim", "key"}, board);

    const std::optional<TableRow> row = row_of(output, "key");

    ASSERT_TRUE(row) << output;
    EXPECT_NEAR(row->rate_hz, status.mean_rate_hz(), 0.051);
    const bool is_paced = status.target_rate_hz() > 0.0;
    EXPECT_EQ(row->overruns, is_paced ? static_cast<double>(status.overruns()) : 0.0);
    ASSERT_EQ(row->p50_us.has_value(), status.latency_count() > 0);
    if (!row->p50_us) continue;
    EXPECT_NEAR(*row->p50_us, 1e6 * status.latency_p50_s(), 0.51);
    EXPECT_NEAR(*row->p99_us, 1e6 * status.latency_p99_s(), 0.51);
    EXPECT_NEAR(*row->longest_us, 1e6 * status.latency_max_s(), 0.51);
  }
  EXPECT_FALSE(row_of("key said 1 2 3 4 5 6 7 8 9\n", "key")) << "no table";
  EXPECT_FALSE(row_of("node rate\nkey  no status was received\n", "key"));
}

BenchReport report_of() {
  BenchReport report;
  report.version = "1.2.3";
  report.machine = {"a processor's name", 2, 0.05, 3.5, 2000.0, 3000.0};
  report.engine.vector_width = "avx2";
  report.engine.addition_s = 1e-9;
  report.engine.addition_at_end_s = 1.01e-9;
  report.engine.by_dimension = {{3, 10000, 19800, 6e-9, 2e-9}};
  report.engine.by_size = {{3, 1024, 1984, 6e-9, 2e-9}, {3, 1000000, 1998000, 8e-9, 5e-9}};
  report.engine.ball_s = 1e-7;
  report.engine.largest = {{"net in 3-D", "masses", 123456, 5e-4, 1}};
  report.force_loop = ForceLoopFigures{15000.0, 90.0, 180.0, 1200.0, 0.001};
  report.seconds = 27.0;
  return report;
}

TEST(Bench, TheReportHasItsFigures) {
  const std::string text = bench_text(report_of());
  for (const char* const part : {"6.00 ns", "2.00 ns", "3.00", "123456 masses", "15000 exchanges/s",
                                 "90 us p50, 180 us p99, 1200 us longest; 0.1 % of the ticks late"})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
  const auto json = nlohmann::json::parse(bench_json(report_of()));
  EXPECT_EQ(json["engine"]["by_size"][1]["masses"], 1000000);
  EXPECT_EQ(json["engine"]["largest_at_1_khz"][0]["count"], 123456);
  EXPECT_DOUBLE_EQ(json["force_loop"]["p50_s"], 90e-6);
  EXPECT_EQ(json["machine"]["processor"], "a processor's name");
  CommandLine line("cordis", "", "1.2.3");
  add_bench_verb(line);
  const std::string help = line.reference();
  const std::function<void(const nlohmann::json&)> expect_in_help =
      [&](const nlohmann::json& part) {
        for (const auto& [key, value] : part.items()) {
          if (part.is_object()) {
            EXPECT_NE(help.find(key), std::string::npos) << key;
          }
          if (value.is_structured()) expect_in_help(value);
        }
      };
  expect_in_help(json);
}

TEST(Bench, WarnsOfAMachineThatWasNotQuiet) {
  MachineFigures machine;
  EXPECT_EQ(machine.disturbances(), "");
  machine.stolen_share = 0.001;
  machine.load = 1.1;
  machine.lowest_mhz = machine.highest_mhz = 2000.0;
  EXPECT_EQ(machine.disturbances(), "");
  machine.stolen_share = 0.05;
  machine.load = 8.0;
  EXPECT_EQ(machine.disturbances(),
            "The hypervisor took 5 % of the processor time. Other programs ran: the load was 8.0.");
  BenchReport report = report_of();
  report.machine = {};
  EXPECT_EQ(bench_text(report).find("warning"), std::string::npos);
  report.engine.addition_at_end_s = 0.9e-9;
  EXPECT_NE(bench_text(report).find("warning: The clock of the core changed"), std::string::npos);
}

TEST(Bench, MeasuresNothingWhereAFileIsKept) {
  const std::string take = testing::TempDir() + "bench_test." + std::to_string(getpid()) + ".mcap";
  std::ofstream(take) << "a take";
  for (const char* option : {"--json", "--chart"}) {
    CommandLine line("cordis", "", "1");
    add_bench_verb(line);
    std::string out;
    std::string error;
    EXPECT_EQ(run_captured(line, {"bench", option, take}, out, error), kBadInput);
    EXPECT_NE(error.find(option + (" would overwrite the take " + take)), std::string::npos)
        << error;
  }
  EXPECT_EQ(std::filesystem::file_size(take), 6u);
  std::filesystem::remove(take);
}

TEST(Bench, TheChartIsDrawn) {
  try {
    const std::string svg = bench_chart(report_of());
    EXPECT_NE(svg.find("a processor's name"), std::string::npos);
    EXPECT_NE(svg.find("plain C++ loop"), std::string::npos);
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("gnuplot"), std::string::npos);
    EXPECT_NE(std::system("gnuplot --version > /dev/null 2>&1"), 0) << error.what();
  }
}

}  // namespace
}  // namespace cordis::cli
