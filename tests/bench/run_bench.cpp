// tests/bench/run_bench.cpp -- a grid as the scene's generator makes it, its links in runs, beside
// the plain loop over the same grid in the same process.
#include <memory>

#include <benchmark/benchmark.h>

#include "cli/bench/bench_networks.h"
#include "cli/bench/plain_loop.h"
#include "sim_node/engine/world.h"

namespace {

using cordis::cli::PlainLoop;
using cordis::cli::square_net;
using cordis::engine::Network;
using cordis::engine::NetworkDescription;
using cordis::engine::VectorWidth;
using cordis::engine::World;

template <class Loop>
void step(benchmark::State& state, Loop& loop, std::size_t link_count) {
  for (int n = 0; n < 10; ++n) loop.step();
  for (auto _ : state) {
    loop.step();
    benchmark::ClobberMemory();
  }
  state.counters["per_link"] = benchmark::Counter(
      static_cast<double>(link_count),
      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void step_of_a_generated_grid(benchmark::State& state) {
  const NetworkDescription network =
      square_net(static_cast<int>(state.range(0)), static_cast<std::uint32_t>(state.range(1)));
  World world(std::make_shared<const Network>(network));
  step(state, world, network.links.size());
}

void plain_loop_over_a_generated_grid(benchmark::State& state) {
  const NetworkDescription network =
      square_net(static_cast<int>(state.range(0)), static_cast<std::uint32_t>(state.range(1)));
  PlainLoop loop(network);
  step(state, loop, network.links.size());
}

void runs_by_width(benchmark::State& state) {
  const auto width = static_cast<VectorWidth>(state.range(0));
  state.SetLabel(cordis::engine::to_string(width));
  const NetworkDescription network = square_net(3, 100);
  World world(std::make_shared<const Network>(network), width);
  step(state, world, network.links.size());
}

/// The plain loop follows ours at once in each size and dimension, on the same machine.
const bool kRegistered = [] {
  for (const long side : {30, 100, 450, 1000}) {
    for (const long dimension : {1, 2, 3}) {
      benchmark::RegisterBenchmark("step_of_a_generated_grid", step_of_a_generated_grid)
          ->ArgNames({"dimension", "side"})
          ->Args({dimension, side});
      benchmark::RegisterBenchmark("plain_loop_over_a_generated_grid",
                                   plain_loop_over_a_generated_grid)
          ->ArgNames({"dimension", "side"})
          ->Args({dimension, side});
    }
  }
  for (const VectorWidth width : cordis::engine::supported_vector_widths()) {
    benchmark::RegisterBenchmark("runs_by_width", runs_by_width)
        ->ArgName("width")
        ->Arg(static_cast<long>(width));
  }
  return true;
}();

}  // namespace
