#include "sim_node/plan/reduction/modal_truncation.h"

#include <cmath>
#include <numbers>

#include "sim_node/engine/integrators/modal_block.h"
#include "tests/reduction/scenes.h"

namespace cordis::plan {
namespace {

std::string membrane_in_modes(const std::string& modes) {
  return "cordis: 1\nspace: 1\n"
         "step: {rate_hz: 2000, integrator: modal" +
         modes +
         "}\n"
         "matter:\n"
         "  net: {kind: grid, rows: 9, columns: 9, border: fixed, mass_kg: 0.001, "
         "stiffness_n_per_m: 100, rest_m: 0}\n";
}

/// How far the MAT goes under a force that grows slowly and swings with this frequency.
std::vector<double> driven(const scene::Scene& scene, std::uint32_t mat, double frequency_hz) {
  engine::World world(std::make_shared<const engine::Network>(scene.network));
  std::vector<double> moved;
  for (int n = 0; n < 2000; ++n) {
    const double t = n * scene.network.step;
    const double grown = std::min(1.0, t / 0.5);
    const double force =
        grown * grown * (3.0 - 2.0 * grown) * std::sin(2.0 * std::numbers::pi * frequency_hz * t);
    world.set_external_force(mat, engine::Vec3(force, 0, 0));
    world.step();
    moved.push_back(world.position(mat).x());
  }
  return moved;
}

TEST(ModalTruncation, WhatIsLeftOutIsWrongByItsBudgetAtMost) {
  constexpr double kBand = 10.0;
  constexpr std::uint32_t kMat = 3 * 9 + 2;
  const scene::Scene whole = loaded(membrane_in_modes(""));
  const scene::Scene cut = loaded(membrane_in_modes(", modes_to_hz: 50"));

  const auto reduction = modal_truncation(cut, kBand);
  ASSERT_TRUE(reduction.has_value());
  const std::size_t kept = engine::ModalBlock(cut.network).mode_count();
  EXPECT_EQ(reduction->count, 49u - kept);
  EXPECT_NEAR(reduction->budget, 0.04 / 0.96, 1e-12);
  EXPECT_FALSE(modal_truncation(whole, kBand).has_value());

  const double share = engine::ModalBlock(cut.network).residual(kMat, kMat);  // of 1 N
  const std::vector<double> with = driven(whole, kMat, kBand);
  const std::vector<double> without = driven(cut, kMat, kBand);
  double largest = 0.0;
  for (std::size_t n = 0; n < with.size(); ++n) {
    largest = std::max(largest, std::abs(with[n] - without[n]));
  }
  EXPECT_LT(largest, reduction->budget * share);
  EXPECT_GT(largest, 0.2 * reduction->budget * share);
}

TEST(ModalTruncation, ModesWithinTheBandAreDoubted) {
  const auto reduction = modal_truncation(loaded(membrane_in_modes(", modes_to_hz: 50")), 60.0);
  ASSERT_TRUE(reduction.has_value());
  EXPECT_FALSE(reduction->doubts.empty());
}

}  // namespace
}  // namespace cordis::plan
