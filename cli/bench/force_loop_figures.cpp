// cli/bench/force_loop_figures.cpp
#include "cli/bench/force_loop_figures.h"

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "cli/bench/temporary_folder.h"
#include "cli/exit_code.h"
#include "cli/programs.h"
#include "cli/run/output_watcher.h"
#include "cli/text_file.h"

namespace cordis::cli {
namespace {

namespace fs = std::filesystem;

const char* const kScene = R"(cordis: 1
name: bench
space: 2
step: {rate_hz: 4000}
world: {viscosity_n_s_per_m: 0.004}
matter:
  string: {kind: string, count: 40, mass_kg: 0.02, from_m: [0, 0], to_m: [0.65, 0], ends: fixed,
           stiffness_n_per_m: 4000, viscosity_n_s_per_m: 0.02, tension_n: 18.2}
ports:
  key: {device: key, axes: [0], role: mass, coupling: direct, at_m: [0.2167, -0.1], along: y}
liaisons:
  finger: {kind: spring_damper, stiffness_n_per_m: 80, viscosity_n_s_per_m: 0.05, rest_m: 0.094}
links:
  - {liaison: finger, between: [key, "string[13]"]}
)";

const char* const kDevice = R"(cordis: 1
axes: 1
travel_m: 0.04
rest: top
rate_hz: 1000
driver: mock
mock: {hand: {moves: [{at_s: 0.2, in_s: 0.3, to_m: -0.02}]}}
)";

const char* const kNodes = R"(nodes:
  sim: {node: sim_node, scene: scene.yaml}
  key: {node: device_node, device: key.yaml}
)";

std::optional<double> number_in(const std::string& word) {
  char* end = nullptr;
  const double value = std::strtod(word.c_str(), &end);
  return word.empty() || *end != '\0' ? std::nullopt : std::optional(value);
}

/// @return what the session prints; empty when it does not end well
std::string played(const fs::path& folder, const std::string& clock, double seconds,
                   std::string& reason) {
  constexpr std::chrono::seconds kLongest{60};
  write_text_file(folder / "launch.yaml", "cordis: 1\nsession: bench_" + std::to_string(getpid()) +
                                              "\nclock: " + clock + "\n" + kNodes);
  const std::string program = (program_directory() / "cordis").string();
  StopSignals signals;
  OutputWatcher watcher(1, kLongest);
  const std::vector<Ending> endings =
      supervise({{{program, "run", (folder / "launch.yaml").string(), "--duration",
                   fmt::format("{:g}s", seconds), "--no-color"}}},
                watcher, signals);
  if (watcher.is_interrupted()) {
    reason = "interrupted";
    return {};
  }
  if (endings.front().exit_code() == kSuccess) return watcher.output(0);
  reason = endings.front().text() + "\n" + watcher.output(0);
  return {};
}

}  // namespace

std::optional<TableRow> row_of(const std::string& output, const std::string& node) {
  constexpr std::size_t kCells = 8;  // up to the longest latency
  std::istringstream lines(output);
  std::string line;
  bool in_table = false;
  while (std::getline(lines, line)) {
    in_table = in_table || line.starts_with("node ");
    std::istringstream words(line);
    std::vector<std::string> cells;
    for (std::string word; words >> word;) cells.push_back(word);
    if (!in_table || cells.size() < kCells || cells[0] != node) continue;
    const std::optional<double> rate = number_in(cells[1]);
    if (!rate) return std::nullopt;
    return TableRow{*rate, number_in(cells[3]).value_or(0.0), number_in(cells[5]),
                    number_in(cells[6]), number_in(cells[7])};
  }
  return std::nullopt;
}

std::optional<ForceLoopFigures> measure_force_loop(
    double seconds, const std::function<void(const std::string&)>& progress, std::string& reason) {
  const TemporaryFolder folder;
  write_text_file(folder.path() / "scene.yaml", kScene);
  write_text_file(folder.path() / "key.yaml", kDevice);
  progress("the force loop in lockstep");
  const std::string lockstep = played(folder.path(), "lockstep", seconds, reason);
  if (lockstep.empty()) return std::nullopt;
  progress("the force loop in real time");
  const std::string realtime = played(folder.path(), "realtime", seconds, reason);
  if (realtime.empty()) return std::nullopt;
  const std::optional<TableRow> exchanges = row_of(lockstep, "key");
  const std::optional<TableRow> device = row_of(realtime, "key");
  const std::optional<TableRow> scene = row_of(realtime, "sim");
  if (!exchanges || !device || !scene || !device->p50_us || !device->p99_us ||
      !device->longest_us) {
    reason = "the table of the session has no latency:\n" + realtime;
    return std::nullopt;
  }
  return ForceLoopFigures{exchanges->rate_hz, *device->p50_us, *device->p99_us, *device->longest_us,
                          scene->overruns / (1000.0 * seconds)};
}

}  // namespace cordis::cli
