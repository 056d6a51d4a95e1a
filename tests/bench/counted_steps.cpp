// tests/bench/counted_steps.cpp -- steps of some scenes, whose instructions callgrind counts.
//
// usage: counted_steps, under instruction_counts_test.sh; prints the compiler, then a line for each call of
// cordis_counted_steps(): instruction set, scene, and steps times elements.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <memory>
#include <random>
#include <vector>

#include "cli/bench/bench_networks.h"
#include "sim_node/engine/world.h"
#include "tests/bench/bench_scenes.h"

constexpr int kCountedSteps = 40;

/// Callgrind knows it by this name.
extern "C" [[gnu::noinline]] void cordis_counted_steps(cordis::engine::World& world) {
  for (int n = 0; n < kCountedSteps; ++n) world.step();
}

namespace {

using cordis::engine::Network;
using cordis::engine::NetworkDescription;
using cordis::engine::VectorWidth;
using cordis::engine::World;
using Shared = std::shared_ptr<const Network>;

constexpr int kStepsBefore = 20;  // as lists are made
constexpr std::uint32_t kSide = 50;

/// Links in runs, as a scene's generator makes them.
Shared net_in_runs() {
  return std::make_shared<const Network>(cordis::cli::square_net(3, kSide));
}

/// Links that fit in no run.
Shared shuffled_net() {
  NetworkDescription net = cordis::cli::square_net(3, kSide);
  std::shuffle(net.links.begin(), net.links.end(), std::mt19937_64(1990));
  return std::make_shared<const Network>(net);
}

Shared string_in_1d() {
  NetworkDescription string;
  string.dimension = 1;
  string.step = 1e-3;
  for (std::uint32_t i = 0; i < 2000; ++i) {
    cordis::engine::Mat& mat = string.mats.emplace_back();
    mat.mass = 0.01;
    mat.position.x() = i == 7 ? 0.001 : 0.0;
    if (i > 0) string.links.push_back({i - 1, i, 100.0, 0.01, 0.0});
  }
  return std::make_shared<const Network>(string);
}

Shared net_of(cordis::bench::LinkKind kind) {
  return cordis::bench::net_of_links(3, kind, kSide);
}

struct Scene {
  const char* name;
  std::function<Shared()> network;
};

const std::vector<Scene>& scenes() {
  static const std::vector<Scene> all{
      {"net_in_runs", net_in_runs},
      {"shuffled_net", shuffled_net},
      {"string_in_1d", string_in_1d},
      {"links_with_states", [] { return net_of(cordis::bench::kConditions); }},
      {"links_with_expressions", [] { return net_of(cordis::bench::kExpression); }},
      {"melt", [] { return cordis::bench::melt(5); }},
      {"large_melt", [] { return cordis::bench::melt(11); }}};
  return all;
}

void count(const Scene& scene, VectorWidth width) {
  const Shared network = scene.network();
  World world(network, width);
  for (int n = 0; n < kStepsBefore; ++n) world.step();
  cordis_counted_steps(world);
  const NetworkDescription& description = network->description();
  const std::size_t links = description.links.size() + description.state_links.size();
  std::printf("%s %s %zu\n", to_string(width), scene.name,
              (links > 0 ? links : network->mat_count()) * kCountedSteps);
}

}  // namespace

int main() {
#ifdef __clang__
  std::printf("compiler %s\n", __VERSION__);
#else
  std::printf("compiler g++ %s\n", __VERSION__);
#endif
  for (const VectorWidth width : cordis::engine::supported_vector_widths()) {
    if (width == VectorWidth::kAvx512) continue;  // callgrind does not know it
    for (const Scene& scene : scenes()) count(scene, width);
  }
}
