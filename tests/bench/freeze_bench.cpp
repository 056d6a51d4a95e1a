// tests/bench/freeze_bench.cpp -- time of a step of 20,000 balls of which a tenth move, with and
// without leaving out those that rest.
//
// usage: engine_bench --benchmark_filter=agglomerate --benchmark_repetitions=5
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <random>
#include <vector>

#include <benchmark/benchmark.h>

#include "sim_node/engine/world.h"

namespace {

using cordis::engine::LinkState;
using cordis::engine::Mat;
using cordis::engine::MatKind;
using cordis::engine::Network;
using cordis::engine::NetworkDescription;
using cordis::engine::StateMachine;
using cordis::engine::Vec3;
using cordis::engine::World;

constexpr double kSpacing = 0.01;  // [m]
constexpr std::uint32_t kLong = 70;
constexpr std::uint32_t kWide = 20;
constexpr std::uint32_t kStirred = kLong / 10;

/// Balls packed as densely as can be, kLong by kWide on each of 15 floors, the lowest fixed, under
/// gravity. Neighbours attract and repel each other and lose energy.
std::shared_ptr<const Network> agglomerate(double tolerance) {
  NetworkDescription network;
  network.step = 2e-4;
  network.gravity = Vec3(0, 0, -9.81);
  network.medium_viscosity = 0.05;
  network.freeze_tolerance = tolerance;
  for (std::uint32_t z = 0; z < 15; ++z) {
    for (std::uint32_t y = 0; y < kWide; ++y) {
      for (std::uint32_t x = 0; x < kLong; ++x) {
        Mat ball;
        ball.kind = z == 0 ? MatKind::kFixed : MatKind::kMass;
        ball.mass = z == 0 ? 0.0 : 1e-3;
        ball.position =
            kSpacing * Vec3(x + 0.5 * ((y + z) % 2), std::sqrt(0.75) * (y + z % 2 / 3.0),
                            std::sqrt(2.0 / 3.0) * z);
        network.mats.push_back(ball);
      }
    }
  }
  LinkState paste;
  const double diameter = kSpacing / std::pow(2.0, 1.0 / 6.0);
  paste.elasticity = cordis::engine::LennardJones{200.0 * diameter * diameter / 57.14628, diameter};
  paste.viscosity = 0.2;
  StateMachine state_machine;
  state_machine.states = {paste};
  network.state_machines = {state_machine};
  cordis::engine::SetLiaison set;
  for (std::uint32_t i = 0; i < network.mats.size(); ++i) set.set_p.push_back(i);
  set.range = 1.35 * kSpacing;
  network.sets = {set};
  return std::make_shared<const Network>(network);
}

/// Shakes each ball of one end by a force of its own, at a frequency that the crystal does not
/// carry on.
class Stirrer {
 public:
  explicit Stirrer(const Network& network) {
    constexpr double kForce = 0.05;  // [N]
    for (std::size_t k = 0; k < kPeriod; ++k) {
      const double turn = 2.0 * std::numbers::pi * static_cast<double>(k) / kPeriod;
      force_[k] = kForce * Vec3(std::cos(turn), std::sin(turn), 0);
    }
    std::mt19937 random(3);
    for (std::uint32_t i = 0; i < network.mat_count(); ++i) {
      if (network.description().mats[i].kind != MatKind::kMass || i % kLong >= kStirred) continue;
      mats_.push_back(i);
      phase_.push_back(random() % kPeriod);
    }
  }

  void step(World& world) {
    const std::size_t now = world.step_count() % kPeriod;
    for (std::size_t k = 0; k < mats_.size(); ++k) {
      world.set_external_force(mats_[k], force_[(now + phase_[k]) % kPeriod]);
    }
    benchmark::DoNotOptimize(world.step());
  }

 private:
  static constexpr std::size_t kPeriod = 12;  // steps
  std::array<Vec3, kPeriod> force_;
  std::vector<std::uint32_t> mats_;
  std::vector<std::size_t> phase_;
};

void step_of_an_agglomerate(benchmark::State& state) {
  World world(agglomerate(static_cast<double>(state.range(0)) * 1e-7));
  Stirrer stirrer(world.network());
  for (int n = 0; n < 2000; ++n) world.step();  // as it settles
  for (int n = 0; n < 800; ++n) stirrer.step(world);
  double asleep = 0.0;
  for (auto _ : state) {
    stirrer.step(world);
    asleep += world.asleep_count();
  }
  const double balls = 14.0 * kLong * kWide;
  state.counters["awake"] = 1.0 - asleep / balls / static_cast<double>(state.iterations());
}
BENCHMARK(step_of_an_agglomerate)
    ->ArgName("tolerance_100nm")
    ->Arg(0)
    ->Arg(5)
    ->Arg(20)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(300);

}  // namespace
