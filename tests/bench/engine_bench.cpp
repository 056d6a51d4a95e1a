// tests/bench/engine_bench.cpp -- time of a step per link, mass update included: square grids of
// spring-dampers with their MATs in order and shuffled, on each vector width; and one short
// string, where what a step costs at least shows; the integrators against each other; modes.
//
// usage: engine_bench --benchmark_repetitions=9 --benchmark_report_aggregates_only=true
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <vector>

#include <benchmark/benchmark.h>

#include "sim_node/engine/world.h"
#include "tests/bench/bench_scenes.h"

namespace {

using cordis::engine::IntegratorKind;
using cordis::engine::Link;
using cordis::engine::Mat;
using cordis::engine::MatKind;
using cordis::engine::Network;
using cordis::engine::NetworkDescription;
using cordis::engine::Vec3;
using cordis::engine::VectorWidth;
using cordis::engine::World;

constexpr std::uint32_t kSide = 100;

Link spring_damper(std::uint32_t a, std::uint32_t b, double rest) {
  return {a, b, 100.0, 0.01, rest};
}

/// 100 x 100 masses, each linked to its right and its upper neighbour: 19,800 links; with diagonals
/// 29,601.
NetworkDescription grid(int dimension, bool diagonals, std::uint32_t side = kSide) {
  NetworkDescription network;
  network.dimension = dimension;
  network.step = 1e-3;
  for (std::uint32_t row = 0; row < side; ++row) {
    for (std::uint32_t column = 0; column < side; ++column) {
      Mat mat;
      mat.mass = 0.01;
      mat.position = dimension == 1 ? Vec3(0.001 * (row * column % 7), 0.0, 0.0)
                                    : Vec3(0.01 * column, 0.01 * row, 0.0);
      network.mats.push_back(mat);
      const std::uint32_t here = row * side + column;
      const double rest = dimension == 1 ? 0.0 : 0.0099;
      if (column > 0) network.links.push_back(spring_damper(here - 1, here, rest));
      if (row > 0) network.links.push_back(spring_damper(here - side, here, rest));
      if (diagonals && row > 0 && column > 0) {
        network.links.push_back(spring_damper(here - side - 1, here, 1.4142 * rest));
      }
    }
  }
  return network;
}

/// 40 masses in a row between two fixed points: the size of the scene that a hand plucks.
NetworkDescription string() {
  constexpr std::uint32_t kMats = 42;
  NetworkDescription network;
  network.dimension = 2;
  network.step = 0.25e-3;
  for (std::uint32_t i = 0; i < kMats; ++i) {
    Mat mat;
    mat.kind = i == 0 || i + 1 == kMats ? MatKind::kFixed : MatKind::kMass;
    mat.mass = 0.0005;
    mat.position = Vec3(0.01 * i, i == kMats / 2 ? 0.001 : 0.0, 0.0);
    network.mats.push_back(mat);
    if (i > 0) network.links.push_back(spring_damper(i - 1, i, 0.009));
  }
  return network;
}

void step(benchmark::State& state, const NetworkDescription& description, VectorWidth width) {
  const auto network = std::make_shared<const Network>(description);
  std::unique_ptr<World> world;
  try {
    world = std::make_unique<World>(network, width);
  } catch (const std::invalid_argument& error) {
    state.SkipWithError(error.what());
    return;
  }
  for (auto _ : state) benchmark::DoNotOptimize(world->step());
  state.counters["per_link"] = benchmark::Counter(
      static_cast<double>(network->link_count()),
      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void step_of_a_grid(benchmark::State& state) {
  const auto dimension = static_cast<int>(state.range(0));
  step(state, grid(dimension, false), cordis::engine::best_vector_width());
}
BENCHMARK(step_of_a_grid)->ArgName("dimension")->DenseRange(1, 3);

void step_of_a_grid_with_diagonals(benchmark::State& state) {
  step(state, grid(3, true), cordis::engine::best_vector_width());
}
BENCHMARK(step_of_a_grid_with_diagonals);

void step_of_a_shuffled_grid(benchmark::State& state) {
  step(state, cordis::bench::with_shuffled_mats(grid(3, true)),
       cordis::engine::best_vector_width());
}
BENCHMARK(step_of_a_shuffled_grid);

void step_by_width(benchmark::State& state) {
  const auto width = static_cast<VectorWidth>(state.range(0));
  state.SetLabel(cordis::engine::to_string(width));
  step(state, grid(3, false), width);
}
BENCHMARK(step_by_width)->ArgName("width")->DenseRange(0, 2);

void step_of_a_string(benchmark::State& state) {
  step(state, string(), cordis::engine::best_vector_width());
}
BENCHMARK(step_of_a_string);

/// Nets in 1 and 2 dimensions; without viscosity all three take them. 2: `leapfrog` damps implicitly.
void step_by_integrator(benchmark::State& state) {
  const auto dimension = static_cast<int>(state.range(1));
  const auto side = static_cast<std::uint32_t>(state.range(2));
  NetworkDescription network = grid(dimension, false, side);
  network.integrator = static_cast<IntegratorKind>(state.range(0));
  if (state.range(3) == 0) {
    for (Link& link : network.links) link.viscosity = 0.0;
  }
  if (state.range(3) == 2) {
    for (Link& link : network.links) link.viscosity = 20.0;
  }
  state.SetLabel(to_string(network.integrator));
  step(state, network, cordis::engine::best_vector_width());
}
BENCHMARK(step_by_integrator)
    ->ArgNames({"integrator", "dimension", "side", "viscous"})
    ->ArgsProduct({{static_cast<long>(IntegratorKind::kCordis),
                    static_cast<long>(IntegratorKind::kLeapfrog)},
                   {1, 2},
                   {20, 60, 100},
                   {0, 1}})
    ->ArgsProduct({{static_cast<long>(IntegratorKind::kLeapfrog)}, {1, 2}, {20, 60}, {2}})
    ->ArgsProduct({{static_cast<long>(IntegratorKind::kSymplectic4)}, {1, 2}, {20, 60, 100}, {0}});

/// 400 modes of a string; so many of its points linked to a fixed one by a link with states.
void step_of_modes(benchmark::State& state) {
  constexpr std::uint32_t kModes = 400;
  NetworkDescription network;
  network.dimension = 1;
  network.step = 1.0 / 44100.0;
  network.integrator = IntegratorKind::kModal;
  for (std::uint32_t i = 0; i < kModes + 2; ++i) {
    Mat mat;
    mat.kind = i == 0 || i > kModes ? MatKind::kFixed : MatKind::kMass;
    mat.mass = 1e-4;
    mat.position = Vec3(i == 100 ? 0.001 : 0.0, 0.0, 0.0);
    network.mats.push_back(mat);
    if (i > 0) network.links.push_back({i - 1, i, 1e4, 1e-4, 0.0});
  }
  network.state_machines.emplace_back();
  network.state_machines[0].states.emplace_back();
  network.state_machines[0].states[0].stiffness = 20.0;
  network.state_machines[0].states[0].viscosity = 0.01;
  for (std::uint32_t l = 0; l < state.range(0); ++l) {
    network.state_links.push_back({50 + 100 * l, 0, 0, 0.0});
  }
  step(state, network, cordis::engine::best_vector_width());
  state.counters["per_mode"] = benchmark::Counter(
      kModes, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(step_of_modes)->ArgName("driven")->DenseRange(0, 3);

/// What a loop of 50,000 masses has to do for a status, beside a step. 0: energy and state hash;
/// 1: a copy of the state, of which another thread finds both. Between two of them a step is done.
void what_a_status_takes(benchmark::State& state) {
  NetworkDescription net = grid(3, false, 224);  // 50,176 masses
  World world(std::make_shared<const Network>(net));
  std::vector<double> room(world.max_values_of_state());
  double longest_s = 0.0;
  for (auto _ : state) {
    state.PauseTiming();
    world.step();
    state.ResumeTiming();
    const auto begin = std::chrono::steady_clock::now();
    if (state.range(0) == 0) {
      benchmark::DoNotOptimize(world.energy());
      benchmark::DoNotOptimize(world.state_hash());
    } else {
      world.copy_state(room);
    }
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
    longest_s = std::max(longest_s, taken.count());
  }
  state.counters["longest"] = longest_s;
}
BENCHMARK(what_a_status_takes)->ArgName("copy")->DenseRange(0, 1)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
