// tests/bench/run_bench.cpp -- generated matter, its links in runs, beside the plain loop over the
// same matter in the same process.
#include <memory>
#include <string>

#include <benchmark/benchmark.h>

#include "cli/bench/bench_networks.h"
#include "cli/bench/plain_loop.h"
#include "sim_node/engine/world.h"
#include "sim_node/scene/sections/scene_reader.h"
#include "tests/support/filled.h"

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

struct Matter {
  const char* name;
  int space;
  const char* keys;
};

constexpr Matter kMatter[] = {
    {"beam", 3, "beam, from_m: [0, 0, 0], to_m: [10, 0, 0], cells: 1000, height_m: 0.01"},
    {"triangular", 2,
     "lattice, structure: triangular, corner_m: [0, 0], counts: [100, 100], spacing_m: 0.01"},
    {"cubic", 3,
     "lattice, structure: cubic, corner_m: [0, 0, 0], counts: [20, 20, 20], spacing_m: 0.01"},
    {"sheared_cubic", 3,
     "lattice, structure: cubic, corner_m: [0, 0, 0], counts: [13, 13, 13], spacing_m: 0.01, "
     "shear_stiffness_n_per_m: 50"},
    {"fcc", 3,
     "lattice, structure: fcc, corner_m: [0, 0, 0], counts: [16, 16, 16], spacing_m: 0.01"},
    {"large_sheared_cubic", 3,
     "lattice, structure: cubic, corner_m: [0, 0, 0], counts: [60, 60, 60], spacing_m: 0.01, "
     "shear_stiffness_n_per_m: 50"},
    {"large_cubic", 3,
     "lattice, structure: cubic, corner_m: [0, 0, 0], counts: [88, 88, 88], spacing_m: 0.01"},
};

NetworkDescription generated(const Matter& matter) {
  cordis::config::Problems problems;
  const std::string text =
      cordis::test::filled(R"(
cordis: 1
name: matter
space: <space>
step: {rate_hz: 1000}
matter:
  m: {mass_kg: 0.01, stiffness_n_per_m: 100, viscosity_n_s_per_m: 0.01, kind: <keys>}
)",
                           {{"space", std::to_string(matter.space)}, {"keys", matter.keys}});
  cordis::scene::Scene scene = cordis::scene::load_scene_text(text, matter.name, problems);
  problems.throw_if_any();
  scene.network.mats[0].velocity.x() = 0.01;
  return scene.network;
}

/// One link with states between two more points: the other links are gathered, in their own order.
NetworkDescription gathered(NetworkDescription network) {
  const auto first = static_cast<std::uint32_t>(network.mats.size());
  for (const double x : {0.0, 1.0}) {
    cordis::engine::Mat& mat = network.mats.emplace_back();
    mat.kind = cordis::engine::MatKind::kFixed;
    mat.position.x() = x;
  }
  network.state_machines.emplace_back().states.emplace_back();
  network.state_links.push_back({first, first + 1, 0, 0.0});
  return network;
}

/// Names end with the matter and its dimension: step_of_matter/beam:3.
void register_matter(const Matter& matter) {
  const auto named = [&](benchmark::internal::Benchmark* bench) {
    bench->ArgName(matter.name)->Arg(matter.space);
  };
  named(benchmark::RegisterBenchmark("step_of_matter", [&](benchmark::State& state) {
    const NetworkDescription network = generated(matter);
    World world(std::make_shared<const Network>(network));
    step(state, world, network.links.size());
  }));
  named(benchmark::RegisterBenchmark("gathered_matter", [&](benchmark::State& state) {
    const NetworkDescription network = generated(matter);
    World world(std::make_shared<const Network>(gathered(network)));
    step(state, world, network.links.size());
  }));
  named(benchmark::RegisterBenchmark("plain_loop_over_matter", [&](benchmark::State& state) {
    const NetworkDescription network = generated(matter);
    PlainLoop loop(network);
    step(state, loop, network.links.size());
  }));
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
  for (const Matter& matter : kMatter) register_matter(matter);
  for (const VectorWidth width : cordis::engine::supported_vector_widths()) {
    benchmark::RegisterBenchmark("runs_by_width", runs_by_width)
        ->ArgName("width")
        ->Arg(static_cast<long>(width));
  }
  return true;
}();

}  // namespace
