// tests/engine/modal_test.cpp -- linear networks in 1 dimension by their modes.
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "sim_node/engine/integrators/integrator_limits.h"
#include "sim_node/engine/integrators/modal_block.h"
#include "tests/engine/many_states.h"
#include "tests/engine/scenes.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/reference_data.h"

namespace cordis::test {
namespace {

using engine::IntegratorKind;

NetworkDescription by_modes(NetworkDescription scene) {
  scene.integrator = IntegratorKind::kModal;
  return scene;
}

/// 20 masses in a row between fixed ends, plucked, moving, under gravity.
NetworkDescription string(double viscosity, double step) {
  NetworkDescription scene = string_in_space(20, viscosity, step);
  scene.dimension = 1;
  scene.gravity = Vec3(-1, 0, 0);
  scene.medium_viscosity = viscosity > 0.0 ? 1e-4 : 0.0;
  for (std::uint32_t i = 0; i < scene.mats.size(); ++i) {
    scene.mats[i].position = Vec3(scene.mats[i].position.y(), 0, 0);
    if (scene.mats[i].kind == MatKind::kMass) scene.mats[i].velocity.x() = 0.1 * (i % 3);
  }
  for (Link& link : scene.links) link.rest_length = 0.0;
  return scene;
}

/// The largest distance of a MAT of the string from where `leapfrog` has it with tiny steps.
double error_after(double time, const NetworkDescription& scene) {
  NetworkDescription exact = scene;
  exact.step = 4e-6;
  exact.integrator = IntegratorKind::kLeapfrog;
  World reference = make_world(exact);
  run(reference, static_cast<int>(std::lround(time / exact.step)));
  World world = make_world(by_modes(scene));
  run(world, static_cast<int>(std::lround(time / scene.step)));
  return (world.positions() - reference.positions()).cwiseAbs().maxCoeff();
}

TEST(Modal, FollowsEveryRegimeOfAnOscillatorExactly) {
  const nlohmann::json problem = reference("R01_damped_oscillator");
  const auto& params = problem["params"];
  for (const auto& regime : problem["cases"]) {
    World world = make_world(
        by_modes(oscillator(number(params["m"]), number(params["k"]), number(regime["z"]),
                            number(params["x0"]), number(params["v0"]), 0.1)));
    for (const auto& row : regime["t_x_v"]) {
      const int n = static_cast<int>(std::lround(number(row[0]) / 0.1));
      run(world, n - static_cast<int>(world.step_count()));
      EXPECT_NEAR(world.position(1).x(), number(row[1]), 1e-13) << regime["name"];
    }
  }
}

TEST(Modal, KeepsAStartVelocityHoweverFastItDecays) {
  for (const double decay : {0.5, 1.0, 5.0, 30.0, 36.0, 100.0, 1e4}) {  // Z' = Z dt / m
    constexpr double kStep = 1e-3;
    constexpr double kSpeed = 2.0;
    NetworkDescription scene = oscillator(0.1, 4.0, 0.0, 0.03, kSpeed, kStep);
    scene.medium_viscosity = decay * 0.1 / kStep;
    const double rate = 0.5 * decay / kStep;
    const double spread = std::sqrt(rate * rate - 40.0);
    const double slow = 40.0 / (rate + spread);
    const double fast = rate + spread;
    World world = make_world(by_modes(scene));
    EXPECT_NEAR(world.energy().initial, 0.5 * 0.1 * kSpeed * kSpeed + 0.5 * 4.0 * 0.03 * 0.03,
                decay < 0.7 ? 0.5 : 0.02)
        << decay;
    for (int n = 1; n <= 200; ++n) {
      world.step();
      const double t = n * kStep;
      const double x = (0.03 * (fast * std::exp(-slow * t) - slow * std::exp(-fast * t)) +
                        kSpeed * (std::exp(-slow * t) - std::exp(-fast * t))) /
                       (fast - slow);
      ASSERT_NEAR(world.position(1).x(), x, 2e-15 + 1e-12 * std::abs(x)) << decay << ", step " << n;
      ASSERT_NEAR(world.energy().residual(), 0.0, 1e-12 * world.energy().largest) << decay;
    }
    EXPECT_NEAR(world.energy().dissipated, world.energy().initial - world.energy().elastic,
                1e-3 * world.energy().initial)
        << decay;
  }
}

TEST(Modal, StartsFromASnapshotOfTheStart) {
  NetworkDescription scene = oscillator(0.1, 4.0, 0.0, 0.03, 2.0, 1e-3);
  scene.medium_viscosity = 5e3;
  World world = make_world(by_modes(scene));
  const engine::Snapshot start = world.snapshot();
  run(world, 20);
  const std::uint64_t hash = world.state_hash();
  world.restore(start);
  run(world, 20);

  EXPECT_EQ(world.state_hash(), hash);
}

TEST(Modal, IsExactAtStepsFarBeyondTheLimitOfTheOthers) {
  // 1.6 ms is the limit of `cordis`; what is left is the error of the reference
  EXPECT_LT(error_after(0.02, string(0.0, 5e-3)), 5e-8);
  EXPECT_LT(error_after(0.02, string(0.02, 5e-3)), 5e-8);
}

NetworkDescription driven_string(double step) {
  NetworkDescription scene = string(0.02, step);
  scene.state_machines.push_back(Behaving().state(200.0).state_machine);
  scene.state_links = {{0, 7, 0, 0.0}};
  return scene;
}

TEST(Modal, IsOfSecondOrderInWhatIsFastenedToIt) {
  const double coarse = error_after(0.01, driven_string(2e-4));
  const double fine = error_after(0.01, driven_string(1e-4));

  EXPECT_LT(coarse, 1e-5);
  EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.1);
}

/// docs/integrators.md: the account multiplies neighbouring positions.
TEST(Modal, CountsTheEnergyOfAFastModeTooLow) {
  constexpr double kMass = 0.01;
  constexpr double kStep = 1e-3;
  for (const double turn : {0.1, 1.0, 2.12, 3.0}) {  // of the mode in a step [rad]
    const double stiffness = kMass * turn * turn / (kStep * kStep);
    World world = make_world(by_modes(oscillator(kMass, stiffness, 0.0, 0.0, 1.0, kStep)));
    const double half = std::cos(0.5 * turn);
    for (int n = 0; n < 50; ++n) {
      world.step();
      ASSERT_NEAR(world.energy().total(), 0.5 * kMass * half * half, 1e-12) << turn;
    }
  }
}

TEST(Modal, KeepsItsAccountToRounding) {
  World world = make_world(by_modes(driven_string(2e-4)));
  world.set_external_force(12, Vec3(0.5, 0, 0));
  double largest = 0.0;
  for (int n = 0; n < 2000; ++n) {
    world.step();
    largest = std::max(largest, std::abs(world.energy().residual()) / world.energy().largest);
  }

  EXPECT_LT(largest, 2e-12);
  EXPECT_GT(world.energy().dissipated, 0.0);
  EXPECT_NE(world.energy().port_work, 0.0);
}

TEST(Modal, BearsWhatIsFastenedToItUpToItsLimit) {
  for (const double side : {0.98, 1.02}) {
    NetworkDescription scene = driven_string(4e-4);
    const engine::ModalBlock block(by_modes(scene));
    scene.state_machines[0].states[0].stiffness = side * block.max_stiffness(7);
    World world = make_world(by_modes(scene));
    double largest = 0.0;
    for (int n = 0; n < 20000 && largest < 1e50; ++n) {
      world.step();
      largest = std::max(largest, std::abs(world.position(7).x()));
    }
    EXPECT_TRUE(side < 1.0 ? largest < 100.0 : largest > 1e3) << side << ' ' << largest;
  }
}

TEST(Modal, MovesAsFarAsASteadyForceShouldMoveIt) {
  // a steady force on one of 20 masses moves it by its compliance
  NetworkDescription scene = string(0.02, 2e-4);
  scene.medium_viscosity = 0.5;  // comes to rest soon
  scene.gravity = Vec3::Zero();
  for (Mat& mat : scene.mats) mat.position = mat.velocity = Vec3::Zero();
  World world = make_world(by_modes(scene));
  world.set_external_force(10, Vec3(1, 0, 0));
  run(world, 20000);

  // two springs of 10 and of 11 links side by side: K = 400 / 10 + 400 / 11
  const double compliance = 1.0 / (40.0 + 400.0 / 11.0);
  EXPECT_NEAR(world.position(10).x(), compliance, 1e-9);
  EXPECT_NEAR(world.position(11).x(), compliance * 10.0 / 11.0, 1e-9);
}

TEST(Modal, RefusesWhatHasNoModes) {
  const auto refusal = [](const NetworkDescription& scene) -> std::string {
    try {
      const World world = make_world(by_modes(scene));
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  const std::string start = "the integrator modal does not take ";
  EXPECT_EQ(refusal(string(0.1, 1e-4)), "");
  EXPECT_EQ(refusal(string_in_space(5, 0.0, 1e-4)), start + "2 or 3 dimensions");
  NetworkDescription uneven = string(0.1, 1e-4);
  uneven.links[3].viscosity = 0.2;
  EXPECT_EQ(refusal(uneven),
            start + "a viscosity that is not in the same proportion to the stiffness");
  NetworkDescription heavy = string(0.1, 1e-4);
  heavy.mats[4].mass = 0.1;
  EXPECT_EQ(refusal(heavy), start + "different masses in a medium");
  NetworkDescription crowd = string(0.0, 1e-4);  // whose modes would take hours, and all memory
  crowd.mats.resize(engine::kMaxModalMasses + 5, crowd.mats[5]);
  EXPECT_EQ(refusal(crowd), start + "more than 2000 masses");
}

TEST(Modal, GoesOnFromASnapshotBitForBitAndAllocatesNothing) {
  World first = make_world(by_modes(driven_string(2e-4)));
  first.set_external_force(12, Vec3(0.5, 0, 0));
  {
    const AllocationGuard guard;
    run(first, 37);
    EXPECT_EQ(guard.count(), 0u);
  }
  World second = make_world(by_modes(driven_string(2e-4)));
  second.restore(first.snapshot());
  run(first, 50);
  run(second, 50);

  EXPECT_EQ(first.state_hash(), second.state_hash());
  EXPECT_EQ(first.energy().total(), second.energy().total());
}

TEST(Modal, StepsToTheSameBitsOnEveryWidth) {
  World narrow = make_world(by_modes(driven_string(2e-4)), VectorWidth::kSse2);
  run(narrow, 200);
  for (const VectorWidth width : engine::supported_vector_widths()) {
    World world = make_world(by_modes(driven_string(2e-4)), width);
    run(world, 200);
    EXPECT_EQ(world.state_hash(), narrow.state_hash()) << engine::to_string(width);
    EXPECT_EQ(world.energy().dissipated, narrow.energy().dissipated);
  }
}

}  // namespace
}  // namespace cordis::test
