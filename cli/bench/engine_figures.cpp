// cli/bench/engine_figures.cpp
#include "cli/bench/engine_figures.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "cli/bench/bench_networks.h"
#include "cli/bench/plain_loop.h"
#include "cli/bench/turns.h"
#include "sim_node/engine/core/vector_width.h"
#include "sim_node/engine/world.h"

namespace cordis::cli {
namespace {

using engine::Network;
using engine::NetworkDescription;
using engine::World;

constexpr std::uint32_t kSide = 100;    // of the nets in 1, 2 and 3 dimensions
constexpr std::uint32_t kBalls = 2500;  // of the agglomerate
constexpr double kPeriod = 1e-3;        // [s]
constexpr double kShareOfPeriod = 0.8;  // for the steps
constexpr int kAdditions = 10000;

World world_of(const NetworkDescription& network) {
  return World(std::make_shared<const Network>(network));
}

double time_of_addition(int rounds) {
  double sum = 0.0;
  const auto add = [&sum] {
    for (int n = 0; n < kAdditions; ++n) {
      sum += 1e-9;
      asm volatile("" : "+x"(sum));  // each waits for the one before
    }
  };
  return times_in_turns({add}, rounds).front() / kAdditions;
}

LinkTimes times_of_net(int dimension, std::uint32_t side, int rounds) {
  const NetworkDescription network = square_net(dimension, side);
  PlainLoop plain(network);
  World world = world_of(network);
  const std::vector<double> times =
      times_in_turns({[&plain] { plain.step(); }, [&world] { world.step(); }}, rounds);
  const auto links = static_cast<double>(network.links.size());
  return {dimension, side * side, static_cast<std::uint32_t>(network.links.size()),
          times[0] / links, times[1] / links};
}

double step_time_of(const NetworkDescription& network, int rounds) {
  World world = world_of(network);
  return times_in_turns({[&world] { world.step(); }}, rounds).front();
}

/// The size of a scene whose steps of a period take their share of it. It is found from two sizes, of
/// which the second is close to it, so that its caches and memory are those of that size.
LargestScene largest(LargestScene scene, int rounds,
                     const std::function<NetworkDescription(std::uint32_t)>& network_of) {
  constexpr double kFirst = 10000.0;
  constexpr double kMax = 4e6;
  const double allowed_s = kShareOfPeriod * kPeriod / scene.steps_per_period;
  double count = kFirst;
  for (int round = 0; round < 3; ++round) {
    const NetworkDescription network = network_of(static_cast<std::uint32_t>(count));
    scene.step_s = step_time_of(network, rounds);
    count = std::min(kMax, static_cast<double>(network.mats.size()) * allowed_s / scene.step_s);
  }
  scene.count = static_cast<std::uint32_t>(count);
  return scene;
}

NetworkDescription net_of(std::uint32_t masses) {
  return square_net(3, static_cast<std::uint32_t>(std::max(2.0, std::sqrt(masses))));
}

}  // namespace

EngineFigures measure_engine(const BenchEffort& effort,
                             const std::function<void(const std::string&)>& progress) {
  EngineFigures figures;
  figures.vector_width = to_string(engine::best_vector_width());
  progress("the control");
  figures.addition_s = time_of_addition(effort.rounds);
  for (int dimension = 1; dimension <= 3; ++dimension) {
    progress("a net in " + std::to_string(dimension) + "-D");
    figures.by_dimension.push_back(times_of_net(dimension, kSide, effort.rounds));
  }
  for (std::uint32_t side = 32; side < effort.largest_side; side = side * 10 / 3) {
    progress("a net of " + std::to_string(side * side) + " masses");
    figures.by_size.push_back(times_of_net(3, side, effort.rounds));
  }
  progress("a net of " + std::to_string(effort.largest_side * effort.largest_side) + " masses");
  figures.by_size.push_back(times_of_net(3, effort.largest_side, effort.rounds));
  progress("an agglomerate");
  const NetworkDescription paste = agglomerate(kBalls);
  figures.ball_s = step_time_of(paste, effort.rounds) / static_cast<double>(paste.mats.size());
  progress("the largest net at 1 kHz");
  figures.largest.push_back(largest({"net in 3-D", "masses"}, effort.rounds, net_of));
  progress("the largest set of strings at 1 kHz");
  figures.largest.push_back(
      largest({"strings of 200 masses in 3-D", "masses"}, effort.rounds, strings));
  progress("the largest agglomerate at 1 kHz");
  figures.largest.push_back(largest({"agglomerate in 2-D, 4 steps a period", "balls", 0, 0.0, 4},
                                    effort.rounds, agglomerate));
  figures.addition_at_end_s = time_of_addition(effort.rounds);
  return figures;
}

}  // namespace cordis::cli
