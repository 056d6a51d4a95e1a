// tests/bench/surface_bench.cpp -- time of a step of balls that lie on a surface, or far from it.
#include <cstdint>
#include <limits>
#include <memory>

#include <benchmark/benchmark.h>

#include "sim_node/engine/world.h"

namespace {

using cordis::engine::Mat;
using cordis::engine::MatKind;
using cordis::engine::Network;
using cordis::engine::NetworkDescription;
using cordis::engine::SetLiaison;
using cordis::engine::StateMachine;
using cordis::engine::Surface;
using cordis::engine::SurfaceKind;
using cordis::engine::Vec3;
using cordis::engine::World;

enum Kind : int { kNoSurface = 0, kPlane = 1, kBox = 2, kCylinder = 3 };

constexpr std::uint32_t kSide = 100;
constexpr double kRadius = 0.01;  // [m]

/// 10,000 balls side by side, each pressed into the surface by its weight, or 1 m above it.
/// @param along  weight along the surface, of balls with friction [N]; 0: without friction
std::shared_ptr<const Network> balls_on(Kind kind, bool far, double along = 0.0) {
  constexpr double kStiffness = 1000.0;
  constexpr double kMass = 0.01;
  constexpr double kGravity = 9.81;
  NetworkDescription network;
  network.dimension = 3;
  network.step = 1e-4;
  if (!far) network.gravity = Vec3(along / kMass, -kGravity, 0.0);
  const double height = far ? 1.0 : kRadius - kMass * kGravity / kStiffness;
  SetLiaison set;
  for (std::uint32_t i = 0; i < kSide * kSide; ++i) {
    Mat mat;
    mat.mass = kMass;
    mat.position = Vec3(2.0 * kRadius * (i % kSide), height, 2.0 * kRadius * (i / kSide));
    if (kind == kCylinder && !far)
      mat.position.x() = 0.0;  // balls of one set do not touch each other
    set.set_q.push_back(static_cast<std::uint32_t>(network.mats.size()));
    network.mats.push_back(mat);
    network.radius.push_back(kRadius);
  }
  if (kind == kNoSurface) return std::make_shared<const Network>(network);
  Surface surface;
  surface.mat = static_cast<std::uint32_t>(network.mats.size());
  Mat place;
  place.kind = MatKind::kFixed;
  if (kind == kBox) {
    surface.kind = SurfaceKind::kBox;
    surface.half_size = Vec3(10.0, 1.0, 10.0);
    place.position = Vec3(0.0, -1.0, 0.0);
  } else if (kind == kCylinder) {
    surface.kind = SurfaceKind::kCylinder;
    surface.axis = Vec3::UnitZ();
    surface.half_size = Vec3(1.0, std::numeric_limits<double>::infinity(), 0.0);
    place.position = Vec3(0.0, -1.0, 0.0);
  }
  network.mats.push_back(place);
  network.radius.push_back(0.0);
  network.surfaces.push_back(surface);
  StateMachine contact;
  contact.states.emplace_back();
  contact.states[0].stiffness = kStiffness;
  contact.states[0].viscosity = 0.1;
  contact.states[0].pulls = false;
  if (along > 0.0) contact.friction = {0.5, 0.4, kStiffness, 0.1};
  network.state_machines.push_back(contact);
  set.set_p.push_back(surface.mat);
  set.range = kRadius;
  set.rest_length = -1.0;
  network.sets.push_back(set);
  return std::make_shared<const Network>(network);
}

void step_of_balls_on_a_surface(benchmark::State& state) {
  World world(balls_on(static_cast<Kind>(state.range(0)), state.range(1) != 0));
  for (int n = 0; n < 3; ++n) world.step();
  for (auto _ : state) benchmark::DoNotOptimize(world.step());
  state.counters["per_ball"] = benchmark::Counter(
      kSide * kSide, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(step_of_balls_on_a_surface)
    ->ArgNames({"kind", "far"})
    ->ArgsProduct({{kNoSurface, kPlane, kBox, kCylinder}, {0, 1}})
    ->Unit(benchmark::kMicrosecond);

/// Balls on a plane with friction, which stick or slide under a part of their weight along it; beside
/// step_of_balls_on_a_surface.
void step_of_balls_that_rub(benchmark::State& state) {
  World world(balls_on(kPlane, false, state.range(0) != 0 ? 0.06 : 0.03));  // the limit is 0.049
  for (int n = 0; n < 3; ++n) world.step();
  for (auto _ : state) benchmark::DoNotOptimize(world.step());
  state.counters["per_ball"] = benchmark::Counter(
      kSide * kSide, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(step_of_balls_that_rub)->ArgName("slide")->Arg(0)->Arg(1)->Unit(benchmark::kMicrosecond);

/// A block of balls in a cubic packing, each pressed into the six beside it, with friction or without.
void step_of_a_heap(benchmark::State& state) {
  constexpr std::uint32_t kEdge = 20;
  NetworkDescription network;
  network.dimension = 3;
  network.step = 1e-4;
  SetLiaison set;
  for (std::uint32_t i = 0; i < kEdge * kEdge * kEdge; ++i) {
    Mat mat;
    mat.mass = 0.01;
    mat.position = 1.999 * kRadius * Vec3(i % kEdge, i / kEdge % kEdge, i / kEdge / kEdge);
    mat.velocity = Vec3(1e-3 * (i % 7), -1e-3 * (i % 5), 1e-3 * (i % 3));
    set.set_p.push_back(i);
    network.mats.push_back(mat);
    network.radius.push_back(kRadius);
  }
  StateMachine contact;
  contact.states.emplace_back();
  contact.states[0].stiffness = 1000.0;
  contact.states[0].viscosity = 0.1;
  contact.states[0].pulls = false;
  if (state.range(0) != 0) contact.friction = {0.5, 0.4, 1000.0, 0.1};
  network.state_machines.push_back(contact);
  set.range = 2.0 * kRadius;
  set.rest_length = -1.0;
  network.sets.push_back(set);
  auto shared = std::make_shared<const Network>(network);
  World world(shared);
  const auto begin = world.snapshot();
  int steps = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(world.step());
    if (++steps % 50 != 0) continue;
    state.PauseTiming();
    world.restore(begin);  // before it has come apart
    state.ResumeTiming();
  }
  state.counters["per_ball"] =
      benchmark::Counter(kEdge * kEdge * kEdge, benchmark::Counter::kIsIterationInvariantRate |
                                                    benchmark::Counter::kInvert);
}
BENCHMARK(step_of_a_heap)->ArgName("rub")->Arg(0)->Arg(1)->Unit(benchmark::kMicrosecond);

}  // namespace
