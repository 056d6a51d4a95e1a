// tests/bench/engine_bench.cpp -- time of a step per link, mass update included: a square grid of
// spring-dampers.
//
// usage: engine_bench --benchmark_repetitions=9 --benchmark_report_aggregates_only=true
#include <cstdint>
#include <memory>

#include <benchmark/benchmark.h>

#include "sim_node/engine/world.h"

namespace {

using cordis::engine::Network;
using cordis::engine::NetworkDescription;
using cordis::engine::Vec3;
using cordis::engine::World;

/// 100 x 100 masses, each tied to its right and its upper neighbour: 19,800 links.
std::shared_ptr<const Network> grid(int dimension) {
  constexpr std::uint32_t kSide = 100;
  NetworkDescription network;
  network.dimension = dimension;
  network.step = 1e-3;
  for (std::uint32_t row = 0; row < kSide; ++row) {
    for (std::uint32_t column = 0; column < kSide; ++column) {
      cordis::engine::Mat mat;
      mat.mass = 0.01;
      mat.position = dimension == 1 ? Vec3(0.001 * (row * column % 7), 0.0, 0.0)
                                    : Vec3(0.01 * column, 0.01 * row, 0.0);
      network.mats.push_back(mat);
      const std::uint32_t here = row * kSide + column;
      const double rest = dimension == 1 ? 0.0 : 0.0099;
      if (column > 0) network.links.push_back({here - 1, here, 100.0, 0.01, rest});
      if (row > 0) network.links.push_back({here - kSide, here, 100.0, 0.01, rest});
    }
  }
  return std::make_shared<const Network>(network);
}

void step_of_a_grid(benchmark::State& state) {
  World world(grid(static_cast<int>(state.range(0))));
  for (auto _ : state) benchmark::DoNotOptimize(world.step());
  state.counters["per_link"] = benchmark::Counter(
      static_cast<double>(world.network().link_count()),
      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(step_of_a_grid)->ArgName("dimension")->Arg(1)->Arg(2)->Arg(3);

}  // namespace

BENCHMARK_MAIN();
