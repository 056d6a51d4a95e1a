// tests/integration/numbers_test.cpp -- the numbers of a session, live and offline, are the same.
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "idl/scene.h"
#include "node/dds/reader.h"
#include "tests/integration/live_session.h"
#include "tests/support/filled.h"
#include "tests/support/test_domain.h"

namespace cordis::test {
namespace {

constexpr const char* kConfigs = CORDIS_SOURCE_DIR "/launch_configs/";

std::string nodes_of(const std::string& scene, const std::string& device) {
  return "  sim: {node: sim_node, scene: '" + std::string(kConfigs) + "scenes/" + scene +
         ".yaml'}\n  " + device;
}

std::string plucked() {
  return nodes_of("plucked_string", "keyboard: {node: device_node, device: '" +
                                        std::string(kConfigs) + "devices/keyboard.yaml'}\n");
}

/// The hand of the gallery, sooner.
std::string sounding() {
  return nodes_of("sounding_string", filled(R"(hand:
    node: device_node
    device: '<configs>devices/two_thimbles.yaml'
    driver: script
    script:
      positions:
        - {at_s: 0, m: [0, 0, 0, 0]}
        - {at_s: 0.3, m: [0, 0.08, 0, -0.04]}
        - {at_s: 1, m: [0, 0.08, 0, -0.08]}
)",
                                            {{"configs", std::string(kConfigs)}}));
}

/// A hand that pulls the hammer up, where the key is at the end of its travel.
std::string pushed_beyond_its_travel() {
  return nodes_of("anvil", filled(R"(hand:
    node: device_node
    device: '<configs>devices/keyboard.yaml'
    driver: script
    script:
      forces:
        - {at_s: 0, n: 0}
        - {at_s: 0.2, n: 15}
        - {at_s: 1, n: 15}
)",
                                  {{"configs", std::string(kConfigs)}}));
}

std::string hash_in(const std::string& output) {
  std::smatch match;
  EXPECT_TRUE(std::regex_search(output, match,
                                std::regex("state hash ([0-9a-f]{16}) after ([0-9]+) steps")))
      << output;
  return match.str();
}

std::string file_text(const std::filesystem::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<std::vector<double>> rows_of(const std::filesystem::path& path) {
  std::istringstream lines(file_text(path));
  std::string line;
  std::getline(lines, line);
  std::vector<std::vector<double>> rows;
  while (std::getline(lines, line)) {
    rows.emplace_back();
    std::istringstream fields(line);
    for (std::string field; std::getline(fields, field, ',');)
      rows.back().push_back(std::stod(field));
  }
  return rows;
}

/// `cordis simulate` of the launch file of a session.
std::string simulate(LiveSession& session, const std::vector<std::string>& words) {
  std::vector<std::string> command{program_path("cordis"), "simulate", session.launch_file(),
                                   "--duration", "1s"};
  command.insert(command.end(), words.begin(), words.end());
  ChildProcess process(command);
  EXPECT_EQ(process.wait(kPatience), 0) << process.output();
  return process.output();
}

TEST(Numbers, SimulateGivesTheStateOfALockstepRun) {
  for (const std::string& nodes : {plucked(), sounding(), pushed_beyond_its_travel()}) {
    LiveSession session("lockstep", nodes);
    ChildProcess& launcher = session.start_launcher({"--duration", "1s"});
    ASSERT_EQ(launcher.wait(kPatience), 0) << launcher.output();
    EXPECT_EQ(hash_in(simulate(session, {})), hash_in(launcher.output()));
  }
}

TEST(Numbers, SignalsOfALockstepRunAreThoseOfSimulateRowForRow) {
  LiveSession session("lockstep", plucked());
  const auto live = session.folder() / "live.csv";
  const auto summary = session.folder() / "live.json";
  ChildProcess& launcher = session.start_launcher(
      {"--duration", "1s", "--signals", live.string(), "--summary", summary.string()});
  ASSERT_EQ(launcher.wait(kPatience), 0) << launcher.output();
  const auto offline = session.folder() / "offline.csv";
  simulate(session, {"--csv", offline.string()});

  const auto all = rows_of(offline);
  ASSERT_EQ(all.size(), 1000u);
  const auto rows = rows_of(live);
  ASSERT_EQ(rows.size(), all.size()) << launcher.output();
  ASSERT_GT(rows.front().size(), 1u);
  for (std::size_t tick = 0; tick < rows.size(); ++tick) {
    for (std::size_t column = 0; column < rows[tick].size(); ++column)
      ASSERT_EQ(rows[tick][column], all[tick][column]) << "row " << tick << " column " << column;
  }
  EXPECT_NE(file_text(summary).find("\"complete\": true,"), std::string::npos)
      << file_text(summary);
}

TEST(Numbers, SignalsOfARunBeginWithItsFirstRowUnderEveryClock) {
  const std::string alone = nodes_of("plucked_string", "");
  for (const std::string clock : {"asap", "realtime"}) {
    LiveSession session(clock, clock == "asap" ? alone : plucked());
    const auto live = session.folder() / "live.csv";
    ChildProcess& launcher =
        session.start_launcher({"--duration", "1s", "--signals", live.string()});
    ASSERT_EQ(launcher.wait(kPatience), 0) << launcher.output();
    const auto rows = rows_of(live);
    ASSERT_FALSE(rows.empty()) << launcher.output();
    EXPECT_EQ(rows.front()[0], 0.001) << launcher.output();
    if (clock == "realtime") continue;  // which waits for no reader
    EXPECT_EQ(rows.size(), 1000u) << launcher.output();
  }
}

TEST(Numbers, ARunWithSignalsEndsBesideARecorderThatHasStopped) {
  LiveSession session("asap", nodes_of("plucked_string", ""));
  const std::string take = (session.folder() / "take.mcap").string();
  ChildProcess recorder({program_path("cordis"), "record", "test", "--domain",
                         std::to_string(own_domain()), "--topics", "scene/signals", "-o", take});
  ASSERT_TRUE(recorder.wait_for_output("records into", kPatience));
  // 1800 batches: a second for each eighth of them would be 225 s.
  ChildProcess& launcher = session.start_launcher(
      {"--duration", "30s", "--signals", (session.folder() / "live.csv").string()});
  ASSERT_TRUE(eventually([&] {
    std::error_code absent;
    const auto size = std::filesystem::file_size(take + ".part", absent);
    return !absent && size > 3000;
  })) << "it receives signals";
  recorder.signal(SIGSTOP);
  EXPECT_EQ(launcher.output().find("state hash"), std::string::npos) << "the run goes on";
  EXPECT_EQ(launcher.wait(kPatience), 0) << launcher.output();
  recorder.signal(SIGCONT);
  recorder.signal(SIGINT);
  EXPECT_NE(recorder.wait(kPatience), -1);
}

TEST(Numbers, AFileThatCannotBeWrittenIsRefusedBeforeAnythingStarts) {
  LiveSession session("lockstep", plucked());
  ChildProcess& launcher =
      session.start_launcher({"--duration", "1s", "--signals", "/nowhere/at/all.csv"});
  EXPECT_EQ(launcher.wait(kPatience), 2);
  EXPECT_NE(launcher.output().find("cannot write '/nowhere/at/all.csv'"), std::string::npos)
      << launcher.output();
}

/// Step by step what a reader took, by step number.
class StepLine {
 public:
  void add(std::uint64_t step, double value) {
    if (values_.size() <= step) values_.resize(step + 1, std::nan(""));
    values_[step] = value;
  }
  std::size_t compare_with(const std::vector<std::vector<double>>& rows, std::size_t column,
                           bool as_float) const {
    std::size_t compared = 0;
    for (std::size_t step = 1; step < values_.size() && step <= rows.size(); ++step) {
      if (std::isnan(values_[step])) continue;
      const double expected = rows[step - 1][column];
      EXPECT_EQ(values_[step], as_float ? static_cast<float>(expected) : expected) << step;
      ++compared;
    }
    return compared;
  }

 private:
  std::vector<double> values_;
};

TEST(Numbers, SignalsAndSoundOfEachStepAreThoseOfSimulate) {
  LiveSession session("lockstep", sounding());
  dds::Reader<msg::SceneSignals> signals(session.participant(), dds::Topic::kSignals);
  dds::Reader<msg::SceneSound> sounds(session.participant(), dds::Topic::kSound);
  ChildProcess& launcher = session.start_launcher({"--duration", "1s"});
  StepLine by_step;
  StepLine heard;
  std::uint64_t last_step = 0;
  const auto take = [&] {
    msg::SceneSignals batch;
    while (signals.take(batch)) {
      if (batch.rate() == msg::RATE_GESTURE) {
        EXPECT_EQ(batch.row_step().size() * batch.signal_count(), batch.value().size());
        continue;
      }
      EXPECT_EQ(batch.signal_count(), 1u);
      EXPECT_LE(batch.value().size(), 4096u);
      for (std::size_t i = 0; i < batch.value().size(); ++i)
        by_step.add(batch.first_step() + i, batch.value()[i]);
    }
    msg::SceneSound block;
    while (sounds.take(block)) {
      EXPECT_EQ(block.sound_count(), 1u);
      EXPECT_EQ(block.step_rate_hz(), 44'100.0);
      EXPECT_LE(block.value().size(), 353u);
      EXPECT_EQ(block.dropped_steps(), 0u);
      EXPECT_GT(block.first_step(), last_step);
      last_step = block.first_step() + block.value().size() - 1;
      for (std::size_t i = 0; i < block.value().size(); ++i)
        heard.add(block.first_step() + i, block.value()[i]);
    }
  };
  EXPECT_TRUE(eventually([&] {
    take();
    return launcher.output().find("state hash") != std::string::npos;
  }));
  ASSERT_EQ(launcher.wait(kPatience), 0) << launcher.output();
  take();
  EXPECT_EQ(last_step, 44'100u) << "the sound ends early";

  const auto offline = session.folder() / "offline.csv";
  simulate(session, {"--every", "step", "--csv", offline.string()});
  const auto rows = rows_of(offline);
  ASSERT_EQ(rows.size(), 44'100u);
  EXPECT_GT(by_step.compare_with(rows, 1, /*as_float=*/false), 1000u);
  EXPECT_GT(heard.compare_with(rows, 1, /*as_float=*/true), 1000u);
}

}  // namespace
}  // namespace cordis::test
