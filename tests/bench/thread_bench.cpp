// tests/bench/thread_bench.cpp -- a step that threads share, beside a world of its own on each.
#include <memory>
#include <thread>
#include <vector>

#include <benchmark/benchmark.h>

#include "cli/bench/bench_networks.h"
#include "sim_node/engine/core/thread_team.h"
#include "sim_node/engine/world.h"

namespace {

using cordis::cli::square_net;
using cordis::engine::Network;
using cordis::engine::ThreadTeam;
using cordis::engine::World;

std::shared_ptr<const Network> net(const benchmark::State& state) {
  return std::make_shared<const Network>(
      square_net(static_cast<int>(state.range(0)), static_cast<std::uint32_t>(state.range(1))));
}

void count_links(benchmark::State& state, std::size_t link_count) {
  state.counters["per_link"] = benchmark::Counter(
      static_cast<double>(link_count),
      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void step_shared_by_threads(benchmark::State& state) {
  const auto team = std::make_shared<ThreadTeam>(static_cast<std::size_t>(state.range(2)));
  const auto network = net(state);
  World world(network);
  world.share_steps(team);
  for (int n = 0; n < 20; ++n) world.step();
  for (auto _ : state) world.step();
  count_links(state, network->link_count());
}

void step_of_a_world_on_each_thread(benchmark::State& state) {
  const auto threads = static_cast<std::size_t>(state.range(2));
  ThreadTeam team(threads);
  const auto network = net(state);
  std::vector<std::unique_ptr<World>> worlds(threads);
  team.run([&](std::size_t member) { worlds[member] = std::make_unique<World>(network); });
  constexpr int kSteps = 20;
  const auto steps = [&](std::size_t member) {
    for (int n = 0; n < kSteps; ++n) worlds[member]->step();
  };
  team.run(steps);
  for (auto _ : state) team.run(steps);
  count_links(state, network->link_count() * threads * kSteps);
}

const bool kRegistered = [] {
  for (const long side : {110, 160, 320, 1000}) {  // 24,000 links, 51,000, 204,000 and 2 million
    for (const long threads : {1, 2, 4, 8, 16}) {
      if (threads > static_cast<long>(std::thread::hardware_concurrency())) continue;
      for (const bool is_shared : {true, false}) {
        benchmark::RegisterBenchmark(
            is_shared ? "step_shared_by_threads" : "step_of_a_world_on_each_thread",
            is_shared ? step_shared_by_threads : step_of_a_world_on_each_thread)
            ->ArgNames({"dimension", "side", "threads"})
            ->Args({3, side, threads})
            ->UseRealTime();
      }
    }
  }
  return true;
}();

}  // namespace
