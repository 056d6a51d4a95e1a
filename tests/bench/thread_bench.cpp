// tests/bench/thread_bench.cpp -- a step that threads share, beside a world of its own on each.
#include <cstdint>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

#include "cli/bench/bench_networks.h"
#include "sim_node/engine/core/thread_team.h"
#include "sim_node/engine/world.h"
#include "tests/bench/bench_scenes.h"

namespace {

using cordis::bench::melt;
using cordis::bench::pack;
using cordis::cli::square_net;
using cordis::engine::Link;
using cordis::engine::Network;
using cordis::engine::NetworkDescription;
using cordis::engine::Operation;
using cordis::engine::Quantity;
using cordis::engine::StateMachine;
using cordis::engine::ThreadTeam;
using cordis::engine::Transition;
using cordis::engine::World;

/// A network that is stepped, and what its time is divided by.
struct Measured {
  std::shared_ptr<const Network> network;
  std::size_t elements;
};

Measured net(const benchmark::State& state) {
  auto network =
      std::make_shared<const Network>(square_net(3, static_cast<std::uint32_t>(state.range(0))));
  const std::size_t links = network->link_count();
  return {std::move(network), links};
}

/// A net whose links have two states, the second of which none enters.
Measured net_of_states(const benchmark::State& state) {
  NetworkDescription scene = square_net(3, static_cast<std::uint32_t>(state.range(0)));
  StateMachine machine;
  machine.states.resize(2);
  machine.states[0].stiffness = scene.links.front().stiffness;
  machine.states[0].viscosity = scene.links.front().viscosity;
  machine.states[0].last_exit = 1;
  machine.states[1].first_exit = machine.states[1].last_exit = 1;
  Transition breaks;
  breaks.when.code = {{Operation::kQuantity, Quantity::kElongation, 0.0, 0},
                      {Operation::kConstant, Quantity::kDistance, 1.0, 0},
                      {Operation::kGreater, Quantity::kDistance, 0.0, 0}};
  breaks.target = 1;
  machine.exits = {breaks};
  scene.state_machines = {machine};
  for (const Link& link : scene.links)
    scene.state_links.push_back({link.mat_a, link.mat_b, 0, link.rest_length});
  scene.links.clear();
  const std::size_t links = scene.state_links.size();
  return {std::make_shared<const Network>(std::move(scene)), links};
}

Measured net_of_maxwell_elements(const benchmark::State& state) {
  NetworkDescription scene = square_net(3, static_cast<std::uint32_t>(state.range(0)));
  for (const Link& link : scene.links)
    scene.maxwell_links.push_back({link.mat_a, link.mat_b, link.stiffness, 1.0, 0.0});
  scene.links.clear();
  const std::size_t links = scene.maxwell_links.size();
  return {std::make_shared<const Network>(std::move(scene)), links};
}

Measured balls_of_a_melt(const benchmark::State& state) {
  auto network = melt(static_cast<int>(state.range(0)));
  const std::size_t balls = network->mat_count();
  return {std::move(network), balls};
}

template <int kDimension>
Measured balls_of_a_pack(const benchmark::State& state) {
  auto network = pack(kDimension, static_cast<std::uint32_t>(state.range(0)));
  const std::size_t balls = network->mat_count();
  return {std::move(network), balls};
}

void count_elements(benchmark::State& state, std::size_t count) {
  state.counters["per_element"] =
      benchmark::Counter(static_cast<double>(count), benchmark::Counter::kIsIterationInvariantRate |
                                                         benchmark::Counter::kInvert);
}

/// Steps before the first that is measured: nets and packs move, a lattice melts.
constexpr int kFirstSteps = 50;

void step(World& world, int steps) {
  for (int n = 0; n < steps; ++n) {
    if (world.step().wants_room) world.make_room();
  }
}

template <Measured (*kMake)(const benchmark::State&)>
void step_shared_by_threads(benchmark::State& state) {
  const auto team = std::make_shared<ThreadTeam>(static_cast<std::size_t>(state.range(1)));
  const Measured measured = kMake(state);
  World world(measured.network);
  world.share_steps(team);
  step(world, kFirstSteps);
  for (auto _ : state) step(world, 1);
  count_elements(state, measured.elements);
}

template <Measured (*kMake)(const benchmark::State&)>
void step_of_a_world_on_each_thread(benchmark::State& state) {
  const auto threads = static_cast<std::size_t>(state.range(1));
  ThreadTeam team(threads);
  const Measured measured = kMake(state);
  std::vector<std::unique_ptr<World>> worlds(threads);
  team.run([&](std::size_t member) {
    worlds[member] = std::make_unique<World>(measured.network);
    step(*worlds[member], kFirstSteps);
  });
  constexpr int kSteps = 20;
  const auto steps = [&](std::size_t member) { step(*worlds[member], kSteps); };
  for (auto _ : state) team.run(steps);
  count_elements(state, measured.elements * threads * kSteps);
}

template <Measured (*kMake)(const benchmark::State&)>
void register_pairs(const std::string& what, const char* size, const std::vector<long>& sizes) {
  for (const long of_size : sizes) {
    for (const long threads : {1, 2, 4, 8, 16}) {
      if (threads > static_cast<long>(std::thread::hardware_concurrency())) continue;
      for (const bool is_shared : {true, false}) {
        const std::string name =
            is_shared ? "step_shared_by_threads/" : "step_of_a_world_on_each_thread/";
        benchmark::RegisterBenchmark(
            (name + what).c_str(),
            is_shared ? step_shared_by_threads<kMake> : step_of_a_world_on_each_thread<kMake>)
            ->ArgNames({size, "threads"})
            ->Args({of_size, threads})
            ->UseRealTime();
      }
    }
  }
}

const bool kRegistered = [] {
  register_pairs<net>("net", "side", {110, 160, 320, 1000});  // 24,000 links to 2 million
  register_pairs<net_of_states>("net_of_states", "side", {110, 160, 320});
  register_pairs<net_of_maxwell_elements>("net_of_maxwell_elements", "side", {110, 160, 320});
  register_pairs<balls_of_a_melt>("melt", "cells", {11, 20});  // 5,324 and 32,000 balls
  register_pairs<balls_of_a_pack<3>>("pack_3d", "balls", {5000, 32000, 200000});
  register_pairs<balls_of_a_pack<2>>("pack_2d", "balls", {5000, 32000, 200000});
  return true;
}();

}  // namespace
