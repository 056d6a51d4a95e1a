// tests/bench/melt_bench.cpp -- time of a step per ball of a Lennard-Jones melt, on each vector
// width.
//
// usage: engine_bench --benchmark_filter=melt --benchmark_repetitions=5
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <random>
#include <vector>

#include <benchmark/benchmark.h>

#include "sim_node/engine/world.h"
#include "sim_node/plan/reference/thread_time.h"

namespace {

using cordis::engine::Network;
using cordis::engine::NetworkDescription;
using cordis::engine::Vec3;
using cordis::engine::VectorWidth;
using cordis::engine::World;

/// The melt of LAMMPS' bench/in.lj: 4 x 20^3 balls of mass 1 on an fcc lattice of density 0.8442,
/// Lennard-Jones with cut 2.5, dt 0.005, velocities of temperature 1.44. There it fills a periodic
/// box; here it is a drop in free space, and the balls at its surface have fewer neighbours, so the
/// counter `pairs_per_ball` stands beside the time (27.6 in the bulk).
std::shared_ptr<const Network> melt(int cells = 20, double temperature = 1.44) {
  NetworkDescription network;
  network.step = 0.005;
  const double side = std::cbrt(4.0 / 0.8442);
  std::mt19937 random(87287);
  const auto uniform = [&random] { return static_cast<double>(random()) / 4294967296.0 - 0.5; };
  const auto place = [&](int x, int y, int z) {
    cordis::engine::Mat mat;
    mat.mass = 1.0;
    mat.position = 0.5 * side * Vec3(x, y, z);
    mat.velocity = Vec3(uniform(), uniform(), uniform()) * std::sqrt(12.0 * temperature);
    network.mats.push_back(mat);
  };
  for (int z = 0; z < 2 * cells; ++z) {
    for (int y = 0; y < 2 * cells; ++y) {
      for (int x = (y + z) % 2; x < 2 * cells; x += 2) place(x, y, z);
    }
  }
  cordis::engine::StateMachine state_machine;
  state_machine.states.resize(1);
  state_machine.states[0].elasticity = cordis::engine::LennardJones{1.0, 1.0, 2.5};
  network.state_machines = {state_machine};
  cordis::engine::SetLiaison set;
  for (std::uint32_t i = 0; i < network.mats.size(); ++i) set.set_p.push_back(i);
  set.range = 2.5;
  network.sets = {set};
  return std::make_shared<const Network>(network);
}

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
