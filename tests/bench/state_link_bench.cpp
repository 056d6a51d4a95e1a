// tests/bench/state_link_bench.cpp -- time of a step of a million links: linear ones, and the same
// links with states.
#include <cstdint>
#include <memory>

#include <benchmark/benchmark.h>

#include "sim_node/engine/world.h"

namespace {

using cordis::engine::LinkState;
using cordis::engine::Network;
using cordis::engine::NetworkDescription;
using cordis::engine::Operation;
using cordis::engine::Program;
using cordis::engine::Quantity;
using cordis::engine::StateMachine;
using cordis::engine::Transition;
using cordis::engine::Vec3;
using cordis::engine::World;

enum Kind : int {
  kLinear = 0,
  kConditions = 1,     // two states with one condition each; few links change
  kManyChange = 2,     // every link changes every tenth step or so
  kTableOfForces = 3,  // conditions, and an elasticity given as a table
  kMixed = 4,          // conditions; neighbouring links are in different states
};

/// |quantity| against a threshold.
Program size_compared(Quantity quantity, Operation comparison, double threshold) {
  return {{{Operation::kQuantity, quantity, 0.0, 0},
           {Operation::kAbs, {}, 0.0, 0},
           {Operation::kConstant, {}, threshold, 0},
           {comparison, {}, 0.0, 0}}};
}

StateMachine collophane(Kind kind) {
  StateMachine state_machine;
  LinkState hooked;
  hooked.stiffness = 100.0;
  hooked.viscosity = 0.01;
  hooked.last_exit = 1;
  if (kind == kTableOfForces) {
    hooked.stiffness = 0.0;
    hooked.elasticity.kind = cordis::engine::Law::Kind::kTable;
    hooked.elasticity.table = {{-0.01, -0.001, 0.0, 0.001, 0.01}, {-2.0, -0.1, 0.0, 0.1, 2.0}};
  }
  LinkState unhooked;
  unhooked.viscosity = 0.02;
  unhooked.first_exit = 1;
  unhooked.last_exit = 2;
  const double hold = kind == kManyChange ? 1e-7 : 0.005;
  const double slow = kind == kMixed ? -1.0 : kind == kManyChange ? 10.0 : 1e-6;
  state_machine.states = {hooked, unhooked};
  state_machine.exits = {
      {size_compared(Quantity::kElongation, Operation::kGreater, hold), 1, {}, {}, {}},
      {size_compared(Quantity::kSpeed, Operation::kLess, slow), 0, {}, {}, Quantity::kSpeed}};
  return state_machine;
}

/// 708 x 708 masses, each tied to its right and its upper neighbour: a million links.
std::shared_ptr<const Network> grid(int dimension, Kind kind) {
  constexpr std::uint32_t kLatticeSide = 708;
  NetworkDescription network;
  network.dimension = dimension;
  network.step = 1e-3;
  if (kind != kLinear) network.state_machines = {collophane(kind), collophane(kind)};
  if (kind == kMixed) network.state_machines[1].start = 1;
  const auto tie = [&](std::uint32_t a, std::uint32_t b) {
    const double rest = dimension == 1 ? 0.0 : 0.0099;
    if (kind == kLinear) {
      network.links.push_back({a, b, 100.0, 0.01, rest});
    } else {
      const auto count = static_cast<std::uint32_t>(network.state_links.size());
      network.state_links.push_back({a, b, kind == kMixed ? count * 2654435761U >> 31 : 0U, rest});
    }
  };
  for (std::uint32_t row = 0; row < kLatticeSide; ++row) {
    for (std::uint32_t column = 0; column < kLatticeSide; ++column) {
      cordis::engine::Mat mat;
      mat.mass = 0.01;
      mat.position = dimension == 1 ? Vec3(1e-4 * (row * column % 7), 0.0, 0.0)
                                    : Vec3(0.01 * column, 0.01 * row, 0.0);
      network.mats.push_back(mat);
      const std::uint32_t here = row * kLatticeSide + column;
      if (column > 0) tie(here - 1, here);
      if (row > 0) tie(here - kLatticeSide, here);
    }
  }
  return std::make_shared<const Network>(network);
}

void step_of_a_million_links(benchmark::State& state) {
  World world(grid(static_cast<int>(state.range(0)), static_cast<Kind>(state.range(1))));
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
    ->ArgsProduct({{1, 3}, {kLinear, kConditions, kManyChange, kTableOfForces, kMixed}})
    ->Unit(benchmark::kMillisecond);

}  // namespace
