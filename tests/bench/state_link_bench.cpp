// tests/bench/state_link_bench.cpp -- time of a step of a million links: linear ones, and the same
// links with states.
#include <cstdint>

#include <benchmark/benchmark.h>

#include "sim_node/engine/world.h"
#include "tests/bench/bench_scenes.h"

namespace {

using cordis::bench::LinkKind;
using cordis::engine::World;

constexpr std::uint32_t kMillionSide = 708;  // of a net with a million links

void step_of_a_million_links(benchmark::State& state) {
  World world(cordis::bench::net_of_links(static_cast<int>(state.range(0)),
                                          static_cast<LinkKind>(state.range(1)), kMillionSide));
  for (int n = 0; n < 3; ++n) world.step();
  std::uint64_t changes = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(world.step());
    changes += world.events().size();
  }
  const auto& network = world.network().description();
  const auto count = static_cast<double>(network.links.size() + network.state_links.size());
  state.counters["per_link"] = benchmark::Counter(
      count, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  state.counters["changes"] =
      benchmark::Counter(static_cast<double>(changes), benchmark::Counter::kAvgIterations);
}
BENCHMARK(step_of_a_million_links)
    ->ArgNames({"dimension", "kind"})
    ->ArgsProduct({{1, 3}, benchmark::CreateDenseRange(0, cordis::bench::kFunctions, 1)})
    ->Unit(benchmark::kMillisecond);

}  // namespace
