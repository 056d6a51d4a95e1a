// tests/engine/weightless_test.cpp -- masses that gravity leaves alone, beside others that it
// pulls.
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "tests/engine/scenes.h"

namespace cordis::test {
namespace {

using engine::Energy;
using engine::IntegratorKind;

constexpr double kGravity = -9.81;  // along x [m/s^2]
constexpr double kSpring = 500.0;   // [N/m]
constexpr double kTool = 0.05;      // [kg]
constexpr double kHungOnIt = 0.2;   // [kg]

/// A tool on a spring, a weight hung on it, and another tool and another weight by themselves.
NetworkDescription tool_with_weight(IntegratorKind integrator, double viscosity) {
  NetworkDescription scene;
  scene.dimension = 1;
  scene.step = 1e-3;
  scene.integrator = integrator;
  scene.gravity.x() = kGravity;
  scene.mats = {fixed(Vec3::Zero()), mass(kTool, Vec3::Zero()), mass(kHungOnIt, Vec3::Zero()),
                mass(kTool, Vec3(1, 0, 0)), mass(kTool, Vec3(2, 0, 0))};
  scene.mats[1].weightless = scene.mats[3].weightless = true;
  scene.links = {{0, 1, kSpring, viscosity, 0.0}, {1, 2, kSpring, viscosity, 0.0}};
  return scene;
}

struct Hung {
  IntegratorKind integrator;
  double viscosity;  // [N s/m]; 40: `leapfrog` damps implicitly
  double freeze = 0.0;
};

class Weightless : public testing::TestWithParam<Hung> {};

TEST_P(Weightless, CarriesWhatHangsOnItAndFallsNot) {
  NetworkDescription scene = tool_with_weight(GetParam().integrator, GetParam().viscosity);
  scene.freeze_tolerance = GetParam().freeze;
  World world = make_world(scene);
  constexpr int kSteps = 4000;
  double sum = 0.0;
  for (int n = 0; n < kSteps; ++n) {
    world.step();
    sum += world.position(1).x();
    const Energy energy = world.energy();
    const double of_weights =
        -kGravity * (kHungOnIt * world.position(2).x() + kTool * world.position(4).x());
    ASSERT_NEAR(energy.gravity, of_weights, 0.02) << n;  // half a step apart
    ASSERT_NEAR(energy.residual(), 0.0, 1e-2 * energy.largest) << n;
  }
  const double sag = kHungOnIt * kGravity / kSpring;
  EXPECT_NEAR(sum / kSteps, sag, 0.05 * std::abs(sag));
  if (GetParam().viscosity > 0.0) {
    EXPECT_NEAR(world.position(1).x(), sag, 1e-3 * std::abs(sag));
  }
  EXPECT_EQ(world.position(3).x(), 1.0);
  if (GetParam().integrator != IntegratorKind::kModal) {  // which knows no mass without a link
    const double time = kSteps * scene.step;
    EXPECT_NEAR(world.position(4).x(), 2.0 + 0.5 * kGravity * time * time, 0.05);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Engine, Weightless,
    testing::Values(Hung{IntegratorKind::kCordis, 2.0}, Hung{IntegratorKind::kCordis, 2.0, 1e-6},
                    Hung{IntegratorKind::kLeapfrog, 2.0}, Hung{IntegratorKind::kLeapfrog, 40.0},
                    Hung{IntegratorKind::kLeapfrog, 2.0, 1e-6},
                    Hung{IntegratorKind::kSymplectic4, 0.0}, Hung{IntegratorKind::kImplicit, 2.0},
                    Hung{IntegratorKind::kModal, 2.0}),
    [](const auto& tested) {
      return std::string(to_string(tested.param.integrator)) + std::to_string(tested.index);
    });

TEST(Weightless, FallsAsleepWhereItIsTiedToNothingButASpring) {
  NetworkDescription scene = tool_with_weight(IntegratorKind::kCordis, 2.0);
  scene.freeze_tolerance = 1e-6;
  scene.links.pop_back();
  World world = make_world(scene);
  run(world, 100);
  EXPECT_TRUE(world.is_asleep(1));
  EXPECT_FALSE(world.is_asleep(4));
  EXPECT_EQ(world.position(1).x(), 0.0);
}

}  // namespace
}  // namespace cordis::test
