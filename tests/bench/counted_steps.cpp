// tests/bench/counted_steps.cpp -- steps of some scenes, whose instructions callgrind counts.
//
// usage: counted_steps, under instruction_counts_test.sh; prints the compiler, then a line for each call of
// cordis_counted_steps(): instruction set, scene, and steps times elements. Lines with `each:` are of one step.
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
constexpr int kSingleSteps = 100;  // several lists of neighbours are made in them

/// Callgrind knows it by this name.
extern "C" [[gnu::noipa]] void cordis_counted_steps(cordis::engine::World& world, int count) {
  for (int n = 0; n < count; ++n) world.step();
}

namespace {

using cordis::engine::Network;
using cordis::engine::NetworkDescription;
using cordis::engine::VectorWidth;
using cordis::engine::World;
using Shared = std::shared_ptr<const Network>;

constexpr int kStepsBefore = 20;  // as lists are made
constexpr std::uint32_t kSide = 50;

/// Links in runs, as a scene's generator makes them, with small viscosity.
NetworkDescription net_in_runs(int dimension) {
  return cordis::cli::square_net(dimension, kSide);
}

NetworkDescription undamped(NetworkDescription network) {
  for (cordis::engine::Link& link : network.links) link.viscosity = 0.0;
  return network;
}

NetworkDescription in_medium(NetworkDescription network) {
  network.medium_viscosity = 0.01;
  return network;
}

/// Links in an order of their own, which a step takes in runs all the same.
NetworkDescription net_in_any_order() {
  NetworkDescription net = net_in_runs(3);
  std::shuffle(net.links.begin(), net.links.end(), std::mt19937_64(1990));
  return net;
}

NetworkDescription shuffled_net() {
  return cordis::bench::with_shuffled_mats(net_in_runs(3));
}

NetworkDescription string_of_masses() {
  NetworkDescription string;
  string.dimension = 1;
  string.step = 1e-3;
  for (std::uint32_t i = 0; i < 2000; ++i) {
    cordis::engine::Mat& mat = string.mats.emplace_back();
    mat.mass = 0.01;
    mat.position.x() = i == 7 ? 0.001 : 0.0;
    if (i > 0) string.links.push_back({i - 1, i, 100.0, 0.01, 0.0});
  }
  return string;
}

/// Balls on a plane, each pressed into it by its weight, with viscosity.
/// @param along  gravity along the plane, of balls with friction [m/s^2]; 0: without friction
NetworkDescription balls_on_a_plane(double height = 0.0099, double along = 0.0) {
  NetworkDescription network;
  network.step = 1e-4;
  network.gravity = cordis::engine::Vec3(along, -9.81, 0.0);
  cordis::engine::SetLiaison set;
  for (std::uint32_t i = 0; i < 2000; ++i) {
    cordis::engine::Mat& mat = network.mats.emplace_back();
    mat.mass = 0.01;
    mat.position = cordis::engine::Vec3(0.02 * (i % 50), height, 0.02 * (i / 50));
    set.set_q.push_back(i);
  }
  cordis::engine::Mat& floor = network.mats.emplace_back();
  floor.kind = cordis::engine::MatKind::kFixed;
  cordis::engine::Surface plane;
  plane.mat = 2000;
  network.surfaces.push_back(plane);
  cordis::engine::StateMachine contact;
  contact.states.emplace_back();
  contact.states[0].stiffness = 1000.0;
  contact.states[0].viscosity = 0.1;
  contact.states[0].pulls = false;
  if (along > 0.0) contact.friction = {0.5, 0.4, 1000.0, 0.1};
  network.state_machines.push_back(contact);
  set.set_p.push_back(plane.mat);
  set.range = 0.01;
  set.rest_length = 0.01;
  network.sets.push_back(set);
  return network;
}

NetworkDescription balls_above_a_plane() {
  return balls_on_a_plane(1.0);
}

NetworkDescription balls_that_stick() {
  return balls_on_a_plane(0.0099, 3.0);
}

NetworkDescription balls_that_slide() {
  return balls_on_a_plane(0.0099, 6.0);
}

Shared by_cordis(const NetworkDescription& network) {
  return std::make_shared<const Network>(network);
}

Shared by_leapfrog(NetworkDescription network) {
  network.integrator = cordis::engine::IntegratorKind::kLeapfrog;
  return std::make_shared<const Network>(network);
}

/// Dampers that are solved implicitly.
Shared heavy_string() {
  NetworkDescription string = string_of_masses();
  for (cordis::engine::Link& link : string.links) link.viscosity = 100.0;
  return by_leapfrog(string);
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
      {"net_in_runs", [] { return by_cordis(net_in_runs(3)); }},
      {"net_in_runs_in_2d", [] { return by_cordis(net_in_runs(2)); }},
      {"net_in_runs_in_1d", [] { return by_cordis(net_in_runs(1)); }},
      {"undamped_net_in_runs", [] { return by_cordis(undamped(net_in_runs(3))); }},
      {"net_in_runs_in_medium", [] { return by_cordis(in_medium(net_in_runs(3))); }},
      {"net_in_any_order", [] { return by_cordis(net_in_any_order()); }},
      {"shuffled_net", [] { return by_cordis(shuffled_net()); }},
      {"string_in_1d", [] { return by_cordis(string_of_masses()); }},
      {"undamped_string_in_1d", [] { return by_cordis(undamped(string_of_masses())); }},
      {"string_in_medium", [] { return by_cordis(in_medium(string_of_masses())); }},
      {"leapfrog_net_in_runs", [] { return by_leapfrog(net_in_runs(3)); }},
      {"leapfrog_net_in_runs_in_2d", [] { return by_leapfrog(net_in_runs(2)); }},
      {"leapfrog_net_in_runs_in_1d", [] { return by_leapfrog(net_in_runs(1)); }},
      {"leapfrog_undamped_net_in_runs", [] { return by_leapfrog(undamped(net_in_runs(3))); }},
      {"leapfrog_net_in_runs_in_medium", [] { return by_leapfrog(in_medium(net_in_runs(3))); }},
      {"leapfrog_shuffled_net", [] { return by_leapfrog(shuffled_net()); }},
      {"leapfrog_string_in_1d", [] { return by_leapfrog(string_of_masses()); }},
      {"leapfrog_undamped_string_in_1d", [] { return by_leapfrog(undamped(string_of_masses())); }},
      {"leapfrog_string_in_medium", [] { return by_leapfrog(in_medium(string_of_masses())); }},
      {"heavy_string", heavy_string},
      {"links_with_states", [] { return net_of(cordis::bench::kConditions); }},
      {"links_with_expressions", [] { return net_of(cordis::bench::kExpression); }},
      {"balls_on_a_plane", [] { return by_cordis(balls_on_a_plane()); }},
      {"balls_above_a_plane", [] { return by_cordis(balls_above_a_plane()); }},
      {"balls_that_stick", [] { return by_cordis(balls_that_stick()); }},
      {"balls_that_slide", [] { return by_cordis(balls_that_slide()); }},
      {"melt", [] { return cordis::bench::melt(5); }},
      {"large_melt", [] { return cordis::bench::melt(11); }}};
  return all;
}

void count(const Scene& scene, VectorWidth width) {
  const Shared network = scene.network();
  World world(network, width);
  for (int n = 0; n < kStepsBefore; ++n) world.step();
  cordis_counted_steps(world, kCountedSteps);
  const NetworkDescription& description = network->description();
  const std::size_t links = description.links.size() + description.state_links.size();
  std::printf("%s %s %zu\n", to_string(width), scene.name,
              (links > 0 ? links : network->mat_count()) * kCountedSteps);
}

/// Lists of neighbours are made in slices, so that no step takes much longer than the others.
void count_each(VectorWidth width) {
  World world(cordis::bench::melt(7), width);
  for (int n = 0; n < kStepsBefore; ++n) world.step();
  for (int n = 0; n < kSingleSteps; ++n) {
    cordis_counted_steps(world, 1);
    std::printf("%s each:melt %zu\n", to_string(width), world.network().mat_count());
  }
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
    count_each(width);
  }
}
