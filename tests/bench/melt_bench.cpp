// tests/bench/melt_bench.cpp -- time of a step per ball of a Lennard-Jones melt, on each vector
// width.
//
// usage: engine_bench --benchmark_filter=melt --benchmark_repetitions=5
#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

#include <benchmark/benchmark.h>

#include "sim_node/engine/world.h"
#include "sim_node/plan/reference/thread_time.h"
#include "tests/bench/bench_scenes.h"

namespace {

using cordis::bench::melt;
using cordis::engine::VectorWidth;
using cordis::engine::World;

std::size_t pairs_in_range(const World& world, double range) {
  std::size_t count = 0;
  const auto& x = world.positions();
  for (Eigen::Index a = 0; a < x.cols(); a += 64) {  // of a sample
    for (Eigen::Index b = 0; b < x.cols(); ++b) {
      count += a != b && (x.col(a) - x.col(b)).squaredNorm() < range * range ? 1U : 0U;
    }
  }
  return 64 * count / 2;
}

void step_of_a_melt(benchmark::State& state) {
  const auto width = static_cast<VectorWidth>(state.range(0));
  const auto supported = cordis::engine::supported_vector_widths();
  if (std::find(supported.begin(), supported.end(), width) == supported.end()) {
    state.SkipWithError("this processor lacks the width");
    return;
  }
  World world(melt(), width);
  for (int n = 0; n < 100; ++n) world.step();  // as the lattice melts
  for (auto _ : state) benchmark::DoNotOptimize(world.step());
  const auto balls = static_cast<double>(world.network().mat_count());
  state.counters["per_ball"] = benchmark::Counter(
      balls, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  state.counters["pairs_per_ball"] = static_cast<double>(pairs_in_range(world, 2.5)) / balls;
}
BENCHMARK(step_of_a_melt)
    ->ArgName("width")
    ->DenseRange(0, 2)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(200);

/// Median, 99th percentile and longest of 1,000 steps of the melt of 4 cells^3 balls [us]. Cold
/// balls move slowly, and their neighbour list lasts long.
void slowest_step_of_a_melt(benchmark::State& state) {
  World world(melt(static_cast<int>(state.range(0)), 1e-3 * static_cast<double>(state.range(1))));
  for (int n = 0; n < 100; ++n) world.step();
  std::vector<double> times;
  for (auto _ : state) {
    const double from = cordis::plan::thread_nsec();
    benchmark::DoNotOptimize(world.step());
    times.push_back(1e-3 * (cordis::plan::thread_nsec() - from));
  }
  std::sort(times.begin(), times.end());
  double sum = 0.0;
  for (const double time : times) sum += time;
  const double median = times[times.size() / 2];
  state.counters["mean_us"] = sum / static_cast<double>(times.size());
  state.counters["median_us"] = median;
  state.counters["p99_us"] = times[times.size() * 99 / 100];
  state.counters["worst_us"] = times.back();
  state.counters["worst_over_median"] = times.back() / median;
}
BENCHMARK(slowest_step_of_a_melt)
    ->ArgNames({"cells", "milli_t"})
    ->ArgsProduct({{13, 23}, {1440, 14}})
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1000);

}  // namespace
