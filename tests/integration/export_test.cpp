// tests/integration/export_test.cpp -- the numbers of a take are those of the session.
#include <algorithm>
#include <bit>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "sim_node/engine/core/state_hash.h"
#include "tests/support/child_process.h"
#include "tests/support/eventually.h"
#include "tests/support/test_domain.h"

namespace cordis {
namespace {

namespace fs = std::filesystem;

using test::ChildProcess;
using test::kPatience;

const std::string kProgram = std::string(CORDIS_PROGRAM_DIR) + "/cordis";
const std::string kLaunches = std::string(CORDIS_SOURCE_DIR) + "/launch_configs/";

std::string text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The lines of a table by their first field, the time; the header by "time [s]".
std::map<std::string, std::vector<std::string>> table_of(const fs::path& path) {
  std::istringstream lines(text_of(path));
  std::map<std::string, std::vector<std::string>> table;
  for (std::string line; std::getline(lines, line);) {
    std::vector<std::string> fields;
    std::istringstream parts(line);
    for (std::string field; std::getline(parts, field, ',');) fields.push_back(field);
    table[fields.at(0)] = fields;
  }
  return table;
}

class Export : public testing::Test {
 protected:
  Export() : folder_(fs::temp_directory_path() / ("cordis_export_" + std::to_string(getpid()))) {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~Export() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  /// Plays a launch file in lockstep, without a page. @return the take
  std::string record(const std::string& name, const std::string& device,
                     const std::string& duration) const {
    const std::string take = path(name + ".mcap");
    ChildProcess session({kProgram, "run", kLaunches + name + ".yaml", "clock=lockstep",
                          "domain=" + std::to_string(test::own_domain()), "--only",
                          "sim,record," + device, "--record", take, "--duration", duration});
    EXPECT_EQ(session.wait(kPatience), 0) << session.output();
    return take;
  }

  int run(std::vector<std::string> words) {
    words.insert(words.begin(), kProgram);
    ChildProcess process(words);
    const int code = process.wait(kPatience);
    said_ = process.output();
    return code;
  }
  void simulate(const std::string& name, std::vector<std::string> words) {
    words.insert(words.begin(), {"simulate", kLaunches + name + ".yaml", "--duration", "1s"});
    ASSERT_EQ(run(words), 0) << said_;
  }
  /// Loss is fine, as long as it is said.
  void export_take(std::vector<std::string> words) {
    words.insert(words.begin(), "export");
    const int code = run(words);
    EXPECT_EQ(code, said_.find("lost: ") == std::string::npos ? 0 : 3) << said_;
  }

  fs::path folder_;
  std::string said_;
};

TEST_F(Export, GivesTheTableOfSimulate) {
  const std::string take = record("plucked_string", "keyboard", "1s");
  export_take({take, "--csv", path("take.csv"), "--npz", path("take.npz"), "--mat", "string"});
  const bool lacks_rows = said_.find("rows of signals") != std::string::npos;
  const bool lacks_answers = said_.find("to devices, which are on") != std::string::npos;
  simulate("plucked_string", {"--csv", path("simulate.csv"), "--mat", "string"});
  const auto exported = table_of(path("take.csv"));
  const auto simulated = table_of(path("simulate.csv"));
  ASSERT_EQ(simulated.size(), 1001u);
  ASSERT_GT(exported.size(), 100u);
  if (!lacks_rows) {
    double first_s = 1e9;
    for (const auto& [time, row] : exported) {
      if (time != "time [s]") first_s = std::min(first_s, std::stod(time));
    }
    const auto since_first = [first_s](const auto& line) {
      return line.first == "time [s]" || std::stod(line.first) >= first_s;
    };
    EXPECT_EQ(exported.size(), static_cast<std::size_t>(
                                   std::count_if(simulated.begin(), simulated.end(), since_first)))
        << "from " << first_s << " s on";
    EXPECT_EQ(first_s, 0.001) << "the scene begins before its recorder";
  }
  const std::vector<std::string>& header = simulated.at("time [s]");
  EXPECT_EQ(exported.at("time [s]"), header);
  std::map<std::string, int> compared;
  for (const auto& [time, row] : exported) {
    if (time == "time [s]") continue;
    ASSERT_TRUE(simulated.contains(time)) << time;
    for (std::size_t i = 0; i < header.size(); ++i) {
      const std::string& expected = simulated.at(time).at(i);
      const std::string cell = header[i] + " at " + time + " s";
      if (row.at(i) == "nan") {
        EXPECT_TRUE(header[i].starts_with("string[") ||
                    (header[i].starts_with("keyboard.") && lacks_answers))
            << cell;
        continue;
      }
      if (header[i].starts_with("string[")) {  // a frame has 32 bits per coordinate
        ASSERT_EQ(std::stof(row[i]), static_cast<float>(std::stod(expected))) << cell;
      } else {
        ASSERT_EQ(row[i], expected) << cell;
      }
      ++compared[header[i]];
    }
  }
  for (const std::string& column : header)
    EXPECT_GT(compared[column], column.starts_with("string[") ? 10 : 100) << column;

  std::ofstream(path("read.py")) << R"(import csv, sys, numpy
table = numpy.load(sys.argv[1])
rows = list(csv.reader(open(sys.argv[2])))
numbers = numpy.array(rows[1:], dtype=float)
for i, name in enumerate(table['_columns']):
    unit = table['_units'][i]
    assert rows[0][i] == (f'{name} [{unit}]' if unit else name)
    assert numpy.array_equal(table[name], numbers[:, i], equal_nan=True), name
)";
  ChildProcess python({"/usr/bin/python3", path("read.py"), path("take.npz"), path("take.csv")});
  EXPECT_EQ(python.wait(kPatience), 0) << python.output();

  // In lockstep no frame is lost.
  export_take({take, "--csv", path("frames.csv"), "--every", "frame", "--mat", "string"});
  EXPECT_EQ(said_.find("of the scene"), std::string::npos) << said_;
  EXPECT_GE(table_of(path("frames.csv")).size(), 25u) << "with their header, 25 in a second";

  // A part of the time, and of the rows.
  export_take({take, "--csv", path("part.csv"), "--start-offset", "400ms", "--duration", "200ms",
               "--every", "10ms"});
  EXPECT_EQ(said_.find("is no whole number of gesture periods"), std::string::npos) << said_;
  const auto part = table_of(path("part.csv"));
  EXPECT_LE(part.size(), 21u);
  EXPECT_GT(part.size(), 1u);
  for (const auto& [time, row] : part) {
    if (time == "time [s]") continue;
    EXPECT_GT(std::stod(time), 0.4);
    EXPECT_LE(std::stod(time), 0.6);
    const std::vector<std::string>& whole = exported.at(time);
    EXPECT_TRUE(std::equal(row.begin(), row.end(), whole.begin())) << time;
  }

  // Rows are those of the take.
  for (const std::string span : {"1.5ms", "0.1ms"}) {
    export_take({take, "--csv", path("uneven.csv"), "--every", span});
    EXPECT_NE(said_.find("--every " + span + " is no whole number of gesture periods of 0.001 s"),
              std::string::npos)
        << said_;
  }

  const std::vector<std::pair<std::vector<std::string>, std::string>> mistakes{
      {{take, "--csv", path("x.csv"), "--mat", "strin"}, "no MATs 'strin'; did you mean 'string'?"},
      {{take, "--csv", "/nowhere/x.csv"}, "cannot write '/nowhere/x.csv'"},
      {{take, "--wav", path("x.wav")}, "add 'sound: true' to one of its signals"},
      {{take, "--csv", path("x.csv"), "--every", "step"}, "no signal with 'rate: step'"},
      {{take, "--csv", path("x.csv"), "--every", "often"}, "is none of tick, frame, step"},
      {{take, "--csv", path("x.csv"), "--scene", "2"}, "the take holds 1 scene"},
      {{take, "--csv", path("x"), "--npz", path("x")}, "name the same file"},
      {{take}, "say which file"},
      {{kLaunches + "plucked_string.yaml", "--csv", path("x.csv")}, "plucked_string.yaml"},
      {{path("none.mcap"), "--csv", path("x.csv")}, "none.mcap"},
  };
  for (auto [words, sentence] : mistakes) {
    words.insert(words.begin(), "export");
    EXPECT_EQ(run(words), 2) << sentence;
    EXPECT_NE(said_.find(sentence), std::string::npos) << said_;
  }
  EXPECT_EQ(run({"export", take, "--csv", "/dev/full"}), 1);
  EXPECT_NE(said_.find("cannot write '/dev/full'"), std::string::npos) << said_;
}

TEST_F(Export, GivesWhatIsLeftOfATornTake) {
  const std::string take = record("plucked_string", "keyboard", "8s");  // some chunks of 1 MiB
  export_take({take, "--csv", path("take.csv")});
  const auto exported = table_of(path("take.csv"));
  fs::resize_file(take, fs::file_size(take) * 8 / 10);
  EXPECT_EQ(run({"export", take, "--csv", path("torn.csv")}), 3) << said_;
  EXPECT_NE(said_.find("cordis recover"), std::string::npos) << said_;
  const auto left = table_of(path("torn.csv"));
  EXPECT_GT(left.size(), 100u);
  EXPECT_LT(left.size(), exported.size());
  for (const auto& [time, row] : left) {
    ASSERT_TRUE(exported.contains(time)) << time;
    for (std::size_t i = 0; i < row.size(); ++i) {
      ASSERT_TRUE(row[i] == "nan" || row[i] == exported.at(time).at(i)) << time;
    }
  }
}

TEST_F(Export, GivesTheEventsOfSimulate) {
  const std::string take = record("ratchet", "hand", "1s");
  export_take({take, "--events", path("take.csv")});
  const bool is_whole = said_.find("lost: ") == std::string::npos;
  simulate("ratchet", {"--events", path("simulate.csv")});
  const std::string simulated = text_of(path("simulate.csv"));
  const std::string exported = text_of(path("take.csv"));
  if (is_whole) {
    EXPECT_EQ(exported, simulated);
  }
  std::istringstream lines(exported);
  int count = 0;
  for (std::string line; std::getline(lines, line); ++count)
    EXPECT_NE(simulated.find(line + "\n"), std::string::npos) << line;
  EXPECT_GT(count, 1);
}

/// A signal of the scene says what the device was answered: both come to the same row, however the
/// session was commanded.
TEST_F(Export, PutsAnswersIntoTheirRowsInEachSceneOfASession) {
  const std::string take = path("take.mcap");
  const std::string name = "export_" + std::to_string(getpid());
  ChildProcess session({kProgram, "run", kLaunches + "plucked_string.yaml", "clock=lockstep",
                        "session=" + name, "domain=" + std::to_string(test::own_domain()), "--only",
                        "sim,record,keyboard", "--record", take, "--duration", "1h"});
  const auto command = [&](const std::string& verb, const std::string& word = "") {
    std::vector<std::string> words{"ctl", name, "--timeout", "60s", verb};
    if (!word.empty()) words.push_back(word);
    EXPECT_EQ(run(words), 0) << said_;
  };
  ASSERT_TRUE(test::eventually([&] { return fs::exists(take + ".part"); })) << session.output();
  for (int scene = 1; scene <= 2; ++scene) {
    if (scene == 2) command("reset");
    const auto size = fs::file_size(take + ".part");
    ASSERT_TRUE(test::eventually([&] { return fs::file_size(take + ".part") > size + 200'000; }));
    command("pause");
    command("step", "6");
    command("resume");
    const auto later = fs::file_size(take + ".part");
    ASSERT_TRUE(test::eventually([&] { return fs::file_size(take + ".part") > later + 200'000; }));
  }
  session.signal(SIGINT);
  EXPECT_EQ(session.wait(kPatience), 0) << session.output();

  for (const std::string scene : {"1", "2"}) {
    export_take({take, "--scene", scene, "--csv", path("scene.csv")});
    EXPECT_NE(said_.find("number " + scene + " of the 2 in the take"), std::string::npos) << said_;
    const auto table = table_of(path("scene.csv"));
    const std::vector<std::string>& header = table.at("time [s]");
    const auto column = [&](const std::string& word) {
      return static_cast<std::size_t>(std::ranges::find(header, word) - header.begin());
    };
    const std::size_t signal = column("key_force [N]");
    const std::size_t answer = column("keyboard.force[0] [N]");
    ASSERT_LT(std::max(signal, answer), header.size());
    const bool has_stalled = session.output().find("motors at zero") != std::string::npos;
    int compared = 0;
    for (const auto& [time, row] : table) {
      if (time == "time [s]" || std::stod(time) <= 0.1 || row[answer] == "nan") continue;
      if (has_stalled && row[answer] == "0") continue;
      ASSERT_EQ(row[answer], row[signal]) << "scene " << scene << " at " << time << " s";
      ++compared;
    }
    EXPECT_GT(compared, 100);
  }
}

/// The samples of a WAV file of 32-bit floating point.
std::vector<float> samples_of(const fs::path& path) {
  const std::string bytes = text_of(path);
  const std::size_t data = bytes.find("data");
  if (data == std::string::npos) return {};
  std::uint32_t size = 0;
  std::memcpy(&size, bytes.data() + data + 4, 4);
  std::vector<float> samples(size / 4);
  std::memcpy(samples.data(), bytes.data() + data + 8, samples.size() * 4);
  return samples;
}

TEST_F(Export, GivesTheSoundOfSimulateWithSilenceForWhatIsMissing) {
  const std::string take = record("sounding_string", "hand", "1s");
  export_take({take, "--wav", path("take.wav"), "--csv", path("take.csv"), "--every", "step"});
  const bool is_silent = said_.find("silent in the file") != std::string::npos;
  simulate("sounding_string",
           {"--wav", path("simulate.wav"), "--csv", path("simulate.csv"), "--every", "step"});
  const std::vector<float> exported = samples_of(path("take.wav"));
  const std::vector<float> simulated = samples_of(path("simulate.wav"));
  ASSERT_EQ(simulated.size(), 44'100u);
  // A recorder that joins late on a busy machine misses the first blocks.
  ASSERT_LE(exported.size(), simulated.size()) << said_;
  const std::size_t missed = simulated.size() - exported.size();
  std::size_t equal = 0;
  for (std::size_t i = 0; i < exported.size(); ++i) {
    const bool is_equal = exported[i] == simulated[i + missed];
    equal += is_equal ? 1 : 0;
    EXPECT_TRUE(is_equal || (is_silent && exported[i] == 0.0F)) << i << ": " << exported[i];
  }
  EXPECT_GT(equal, 10'000u);

  const auto by_step = table_of(path("take.csv"));
  const auto expected = table_of(path("simulate.csv"));
  EXPECT_GT(by_step.size(), 1000u);
  for (const auto& [time, row] : by_step) {
    ASSERT_EQ(row.size(), 2u);
    ASSERT_EQ(row[1], expected.at(time)[1]) << time;
  }
}

std::vector<std::string> words_of(const std::string& text) {
  std::istringstream stream(text);
  return {std::istream_iterator<std::string>(stream), {}};
}

/// The text of a file of a state, as if its run had come to it at another step.
std::string at_step(const std::string& text, std::uint64_t step) {
  std::vector<double> all;
  for (const std::string& word : words_of(text.substr(text.find("values:")))) {
    if (word.size() < 18 || word.front() != '"') continue;
    for (std::size_t i = 1; i + 16 < word.size(); i += 16)
      all.push_back(std::bit_cast<double>(std::stoull(word.substr(i, 16), nullptr, 16)));
  }
  all.push_back(std::bit_cast<double>(step));
  const auto before = [&](const std::string& key) { return text.substr(0, text.find(key)); };
  return before("step:") +
         fmt::format("step: {}\ncheck: \"{:016x}\"\n", step, engine::hash_of(all)) +
         text.substr(text.find("values:"));
}

/// 12 days at 4 kHz are behind the scene when it begins, and its steps no longer fit into 32 bits.
TEST_F(Export, CountsStepsBeyond32Bits) {
  const std::string scenes = kLaunches + "scenes/";
  ASSERT_EQ(run({"simulate", scenes + "plucked_string.yaml", "--duration", "1s", "--save-state",
                 path("run.state")}),
            0)
      << said_;
  constexpr std::uint64_t kStart = (std::uint64_t{1} << 32) - 1000;
  std::ofstream(path("late.state")) << at_step(text_of(path("run.state")), kStart);
  std::ofstream(path("scene.yaml"))
      << text_of(scenes + "plucked_string.yaml") << "\nstart_state: late.state\n";
  std::ofstream(path("late.yaml")) << fmt::format(R"(cordis: 1
session: late
clock: lockstep
nodes:
  sim: {{node: sim_node, scene: scene.yaml}}
  keyboard: {{node: device_node, device: {}devices/keyboard.yaml, driver: script}}
)",
                                                  kLaunches);
  ASSERT_EQ(run({"simulate", path("late.yaml"), "--duration", "1s", "--csv", path("simulate.csv"),
                 "--mat", "string"}),
            0)
      << said_;
  EXPECT_NE(said_.find("after 4294970296 steps"), std::string::npos) << said_;
  ASSERT_EQ(run({"run", path("late.yaml"), "domain=" + std::to_string(test::own_domain()),
                 "--record", path("take.mcap"), "--duration", "1s"}),
            0)
      << said_;
  EXPECT_EQ(run({"resim", path("take.mcap")}), 0) << said_;
  export_take({path("take.mcap"), "--csv", path("take.csv"), "--mat", "string"});
  const auto exported = table_of(path("take.csv"));
  const auto simulated = table_of(path("simulate.csv"));
  ASSERT_EQ(simulated.size(), 1001u);
  EXPECT_TRUE(simulated.contains("1073741.824")) << "the time of step 2^32";
  ASSERT_GT(exported.size(), 500u);
  const std::vector<std::string>& header = simulated.at("time [s]");
  int moved = 0;
  for (const auto& [time, row] : exported) {
    ASSERT_TRUE(simulated.contains(time)) << time;
    for (std::size_t i = 0; i < header.size(); ++i) {
      if (time == "time [s]" || !header[i].starts_with("string[") || row.at(i) == "nan") continue;
      ASSERT_EQ(std::stof(row[i]), static_cast<float>(std::stod(simulated.at(time)[i])))
          << header[i] << " at " << time << " s";
      ++moved;
    }
  }
  EXPECT_GT(moved, 500);
}

}  // namespace
}  // namespace cordis
