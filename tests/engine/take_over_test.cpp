// tests/engine/take_over_test.cpp -- another gravity and another medium while a run goes on.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/engine/scenes.h"

namespace cordis::test {
namespace {

using engine::Energy;
using engine::IntegratorKind;
using engine::kIntegrators;

constexpr double kHungMass = 0.5;         // [kg]
constexpr double kHungStiffness = 200.0;  // [N/m]
constexpr double kHungStep = 1e-4;        // [s]
constexpr double kHungGravity = -9.81;    // [m/s^2]

/// A mass that hangs on a spring at a height, let go where the spring has no tension.
NetworkDescription hanging(IntegratorKind integrator, double height) {
  NetworkDescription scene = oscillator(kHungMass, kHungStiffness, 0.0, -0.1, 0.0, kHungStep);
  scene.mats[0].position.x() = height;
  scene.mats[1].position.x() = height - 0.1;
  scene.links[0].rest_length = -0.1;
  scene.integrator = integrator;
  scene.gravity.x() = kHungGravity;
  return scene;
}

World changed(const World& before, const NetworkDescription& scene) {
  World world = make_world(scene);
  std::vector<double> room;
  room.reserve(world.max_values_of_state());
  EXPECT_TRUE(world.take_over(before, room));
  return world;
}

TEST(TakeOver, OfAnotherGravityGoesOnInIt) {
  for (const IntegratorKind integrator : kIntegrators) {
    SCOPED_TRACE(to_string(integrator));
    World heavy = make_world(hanging(integrator, 0.0));
    run(heavy, 700);
    NetworkDescription scene = hanging(integrator, 0.0);
    scene.gravity.x() = 2.0;
    World light = changed(heavy, scene);

    // The exact motion in both gravities, about the place where each of them hangs.
    const double rate = std::sqrt(kHungStiffness / kHungMass);
    const double sag = kHungMass * kHungGravity / kHungStiffness;
    const double lift = kHungMass * 2.0 / kHungStiffness;
    const double first_s = 700 * kHungStep;
    const double place = sag * (1.0 - std::cos(rate * first_s));
    const double speed = sag * rate * std::sin(rate * first_s);
    double largest = 0.0;
    for (int n = 1; n <= 3000; ++n) {
      light.step();
      const double phase = rate * n * kHungStep;
      const double exact = lift + (place - lift) * std::cos(phase) + speed / rate * std::sin(phase);
      largest = std::max(largest, std::abs(light.position(1).x() + 0.1 - exact));
    }
    EXPECT_LT(largest, 1e-2 * std::abs(sag));
  }
}

TEST(TakeOver, OfAnotherGravityCountsFromTheStartWhateverTheHeight) {
  for (const IntegratorKind integrator : kIntegrators) {
    SCOPED_TRACE(to_string(integrator));
    for (const double height : {0.0, 1000.0}) {
      World heavy = make_world(hanging(integrator, height));
      run(heavy, 700);
      const double fallen = heavy.position(1).x() - (height - 0.1);
      ASSERT_LT(fallen, -1e-3);
      NetworkDescription scene = hanging(integrator, height);
      scene.gravity.x() = 2.0;
      World light = changed(heavy, scene);
      const double expected = kHungMass * (kHungGravity - 2.0) * fallen;
      EXPECT_NEAR(light.energy().switching, expected, 1e-2 * expected) << height;
      run(light, 3000);
      const Energy energy = light.energy();
      // Implicit Euler takes energy itself, in the first order of the step.
      const double share = integrator == IntegratorKind::kImplicit ? 2e-2 : 1e-2;
      EXPECT_LT(std::abs(energy.integration_error()), share * expected) << height;
      EXPECT_NEAR(energy.initial, energy.initial_gravity, 1e-6) << height;
    }
  }
}

TEST(TakeOver, OfAnotherMediumGoesOnInIt) {
  for (const IntegratorKind integrator : kIntegrators) {
    if (integrator == IntegratorKind::kSymplectic4) continue;  // it takes no viscosity
    SCOPED_TRACE(to_string(integrator));
    NetworkDescription scene = hanging(integrator, 0.0);
    World thin = make_world(scene);
    run(thin, 700);
    const double whole = thin.energy().total();
    scene.medium_viscosity = 1.0;
    World thick = changed(thin, scene);
    // Modal finds the half step before by the modes of the new medium.
    const double near = integrator == IntegratorKind::kModal ? 1e-5 : 1e-9;
    EXPECT_NEAR(thick.energy().total(), whole, near);
    EXPECT_NEAR(thick.energy().switching, 0.0, near);
    run(thick, 200'000);
    // At rest where gravity and spring are in balance.
    EXPECT_NEAR(thick.position(1).x(), -0.1 + kHungMass * kHungGravity / kHungStiffness, 1e-6);
    EXPECT_GT(thick.energy().dissipated, 0.01);
    const double share = integrator == IntegratorKind::kImplicit ? 3e-2 : 1e-2;
    EXPECT_LT(std::abs(thick.energy().integration_error()), share * thick.energy().dissipated);
  }
}

TEST(TakeOver, OfTheSameWorldChangesNothing) {
  for (const IntegratorKind integrator : kIntegrators) {
    SCOPED_TRACE(to_string(integrator));
    const NetworkDescription scene = hanging(integrator, 3.0);
    World first = make_world(scene);
    run(first, 50);
    World second = changed(first, scene);
    EXPECT_EQ(second.energy().switching, 0.0);
    run(first, 50);
    run(second, 50);
    EXPECT_EQ(first.state_hash(), second.state_hash());
    EXPECT_EQ(first.energy().total(), second.energy().total());
  }
}

}  // namespace
}  // namespace cordis::test
