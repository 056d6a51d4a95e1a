// tests/bench/scene_bench.cpp -- how much faster than real time the launch files are played on one
// core, with their own devices, their signals read at every gesture.
//
// usage: scene_bench --benchmark_filter=plasticine
#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "cli/offline/offline_session.h"

namespace {

constexpr double kGesturePeriod = 1e-3;  // [s]
constexpr int kPeriods = 4000;

const std::string kFolder = std::string(CORDIS_SOURCE_DIR) + "/launch_configs/";

/// The counter `reserve` is simulated time over time.
void one_gesture_period(benchmark::State& state, const std::string& launch_file) {
  cordis::cli::OfflineSession session(kFolder + launch_file);
  for (auto _ : state) session.play_until(session.time_s() + kGesturePeriod);
  state.counters["reserve"] =
      benchmark::Counter(kGesturePeriod, benchmark::Counter::kIsIterationInvariantRate);
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(kFolder)) {
    if (entry.path().extension() == ".yaml") files.push_back(entry.path().filename());
  }
  std::sort(files.begin(), files.end());
  for (const std::string& file : files) {
    benchmark::RegisterBenchmark(file.c_str(), one_gesture_period, file)
        ->Unit(benchmark::kMicrosecond)
        ->Iterations(kPeriods);
  }
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
