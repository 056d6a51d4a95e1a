// tests/cli/signal_log_test.cpp -- rows of signals, and what of them is lost.
#include "cli/run/signal_log.h"

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "idl/scene.h"

namespace cordis::cli {
namespace {

msg::SceneDescription described(std::uint64_t version) {
  msg::SceneDescription scene;
  scene.epoch(7);
  scene.version(version);
  scene.step_rate_hz(8000.0);
  scene.gesture_rate_hz(1000.0);
  msg::SignalDescription signal;
  signal.name("height");
  signal.unit("m");
  scene.signals().push_back(signal);
  return scene;
}

/// One row after each of `count` gesture periods.
msg::SceneSignals rows(std::uint64_t version, std::uint64_t first_step, std::size_t count) {
  msg::SceneSignals batch;
  batch.epoch(7);
  batch.version(version);
  batch.rate(msg::RATE_GESTURE);
  batch.signal_count(1);
  batch.first_step(first_step);
  batch.stride_steps(8);
  batch.value().assign(count, 0.5);
  return batch;
}

TEST(SignalRows, LeavesOutTheSceneOfASimThatBeganBeforeTheRun) {
  SignalRows table("", "", /*first_epoch=*/8);
  table.begin(described(1));
  EXPECT_TRUE(table.add(rows(1, 8, 100))) << "they wait for no description";
  EXPECT_EQ(table.row_count(), 0u);
  EXPECT_EQ(table.text(), "signals: no scene said which it has");
}

TEST(SignalRows, ADescriptionThatComesAgainBeginsNothing) {
  SignalRows table("", "");
  table.begin(described(1));
  table.add(rows(1, 8, 100));
  table.begin(described(1));
  table.add(rows(1, 808, 100));
  EXPECT_EQ(table.row_count(), 200u);
  EXPECT_EQ(table.lost_rows(), 0u);
  EXPECT_EQ(table.text(), "signals: 200 rows");
}

TEST(SignalRows, TheSummaryIsCompleteWhereTheTableHasNoRoom) {
  const std::string file = testing::TempDir() + "full_table." + std::to_string(getpid()) + ".json";
  SignalRows table("/dev/full", file);
  table.begin(described(1));
  for (std::uint64_t batch = 0; batch < 100; ++batch) table.add(rows(1, 8 + 800 * batch, 100));
  std::string failure;
  try {
    table.finish({});
  } catch (const std::runtime_error& error) {
    failure = error.what();
  }

  EXPECT_THAT(failure, testing::HasSubstr("cannot write '/dev/full'"));
  EXPECT_EQ(table.text(), "signals: 10000 rows");
  std::ifstream summary(file);
  EXPECT_EQ(nlohmann::json::parse(summary)["rows"], 10000);
  std::filesystem::remove(file);
}

TEST(SignalRows, TheSummarySaysHowEachNodeEnded) {
  const std::string file = testing::TempDir() + "ended_nodes." + std::to_string(getpid()) + ".json";
  const NodeEnd sim{.name = "sim", .program = "sim_node", .phase = "stopped"};
  NodeEnd key{.name = "key", .program = "device_node", .phase = "failed", .reason = "no board"};
  for (const bool is_required : {false, true}) {
    SignalRows table("", file);
    table.begin(described(1));
    table.add(rows(1, 8, 100));
    key.has_failed = is_required;
    table.finish({sim, key});

    std::ifstream text(file);
    const nlohmann::json summary = nlohmann::json::parse(text);
    EXPECT_EQ(summary["complete"], !is_required);
    EXPECT_EQ(summary["nodes"].dump(),
              R"({"key":{"node":"device_node","phase":"failed","reason":"no board"},)"
              R"("sim":{"node":"sim_node","phase":"stopped"}})");
  }
  std::filesystem::remove(file);
}

TEST(SignalRows, ASummaryThatHasNoRoomIsSaidToo) {
  SignalRows table("/dev/full", "/dev/full");
  table.begin(described(1));
  table.add(rows(1, 8, 100));
  try {
    table.finish({});
    ADD_FAILURE() << "both files are full";
  } catch (const std::runtime_error& error) {
    const std::string said = error.what();
    EXPECT_NE(said.find("signals: cannot write '/dev/full'"), std::string::npos) << said;
    EXPECT_NE(said.find("; summary: cannot write '/dev/full'"), std::string::npos) << said;
  }
}

TEST(SignalRows, RowsOfASceneWithOtherSignalsAreCounted) {
  const std::string file =
      testing::TempDir() + "other_signals." + std::to_string(getpid()) + ".json";
  SignalRows table("", file);
  table.begin(described(1));
  table.add(rows(1, 8, 100));
  msg::SceneDescription other = described(2);
  other.signals().front().name("width");
  table.begin(other);
  EXPECT_TRUE(table.add(rows(2, 8, 40)));
  table.begin(described(3));
  table.add(rows(3, 8, 10));
  EXPECT_EQ(table.row_count(), 110u);
  EXPECT_EQ(table.lost_rows(), 0u);
  EXPECT_EQ(table.other_rows(), 40u);
  EXPECT_THAT(table.text(), testing::HasSubstr("left out: 40 rows of a scene with other signals"));
  table.finish({});

  std::ifstream text(file);
  const nlohmann::json summary = nlohmann::json::parse(text);
  EXPECT_EQ(summary["other_rows"], 40);
  EXPECT_EQ(summary["complete"], false);
  std::filesystem::remove(file);
}

TEST(SignalRows, AnotherVersionBeginsAtStepZero) {
  SignalRows table("", "");
  table.begin(described(1));
  table.add(rows(1, 8, 100));
  table.begin(described(2));
  table.add(rows(2, 24, 10));
  EXPECT_EQ(table.row_count(), 110u);
  EXPECT_EQ(table.lost_rows(), 2u);
}

}  // namespace
}  // namespace cordis::cli
