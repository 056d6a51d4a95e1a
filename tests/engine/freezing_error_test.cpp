// tests/engine/freezing_error_test.cpp -- how far off a motion is from which what rests is left
// out.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "tests/engine/programs.h"
#include "tests/engine/struck_chain.h"
#include "tests/support/rounds.h"

namespace cordis::test {
namespace {

using engine::IntegratorKind;

struct Difference {
  double largest = 0.0;  // of positions, over the peak
  double usual = 0.0;    // root of the mean square
  double awake = 0.0;    // mean part
};

Difference difference_after_strike(IntegratorKind integrator, double tolerance) {
  constexpr std::uint32_t kCount = 200;
  NetworkDescription scene = bedded_chain(kCount);
  scene.integrator = integrator;
  World whole = make_world(scene);
  World part = make_world(frozen(scene, tolerance));
  Difference difference;
  constexpr int kSteps = 2000;
  for (int n = 0; n < kSteps; ++n) {
    for (World* world : {&whole, &part}) {
      strike(*world, kCount + 1, scene.mats[kCount + 1].position);
      world->step();
    }
    difference.awake += (1.0 - part.asleep_count() / double{kCount}) / kSteps;
    for (std::uint32_t i = 1; i <= kCount; ++i) {
      const double error = (whole.position(i) - part.position(i)).norm() / kPeak;
      difference.largest = std::max(difference.largest, error);
      difference.usual += error * error / (kSteps * kCount);
    }
  }
  difference.usual = std::sqrt(difference.usual);
  return difference;
}

TEST(FreezingError, IsOffByLessThanThreeTolerances) {
  for (const IntegratorKind integrator : {IntegratorKind::kCordis, IntegratorKind::kLeapfrog}) {
    double awake_before = 1.0;
    for (const double tolerance : {4.5e-5, 4.5e-4, 4.5e-3}) {  // of the peak
      const Difference difference = difference_after_strike(integrator, tolerance * kPeak);
      EXPECT_LT(difference.usual, 3.0 * tolerance) << to_string(integrator) << tolerance;
      EXPECT_LT(difference.largest, 12.0 * tolerance) << to_string(integrator) << tolerance;
      EXPECT_LT(difference.awake, awake_before) << to_string(integrator);
      RecordProperty(to_string(integrator) + std::to_string(std::lround(1e6 * tolerance)),
                     std::to_string(difference.usual / tolerance) + ", at most " +
                         std::to_string(difference.largest / tolerance) + ", awake " +
                         std::to_string(difference.awake));
      awake_before = difference.awake;
    }
    EXPECT_LT(awake_before, 0.65);
  }
}

/// Masses at rest, each on a spring of its own or on links to others, of all kinds.
NetworkDescription resting_network(std::uint32_t seed) {
  constexpr std::uint32_t kCount = 40;
  NetworkDescription scene;
  scene.dimension = static_cast<int>(seed % 3) + 1;
  scene.step = 1e-3;
  scene.medium_viscosity = 0.3;
  std::mt19937 random(seed);
  const auto uniform = [&random](double low, double high) {
    return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
  };
  const auto point = [&] {
    Vec3 place = Vec3::Zero();
    for (int axis = 0; axis < scene.dimension; ++axis) place[axis] = uniform(0.0, 1.0);
    return place;
  };
  const auto distance = [&scene](std::uint32_t a, std::uint32_t b) {
    const Vec3 along = scene.mats[b].position - scene.mats[a].position;
    return scene.dimension == 1 ? along.x() : along.norm();
  };
  for (std::uint32_t i = 0; i < kCount; ++i)
    scene.mats.push_back(mass(uniform(0.05, 0.2), point()));
  for (std::uint32_t i = 0; i < 12; ++i) scene.mats.push_back(fixed(point()));
  Behaving slack;  // pulls beyond a stretch
  slack.state(0.0).exit(q(engine::Quantity::kElongation) > 0.01, 1);
  slack.state(20.0, 0.2).exit(q(engine::Quantity::kElongation) < 0.005, 0);
  scene.state_machines = {slack.state_machine};
  for (std::uint32_t i = 0; i < 160; ++i) {
    const auto a = static_cast<std::uint32_t>(random() % kCount);
    const auto b = static_cast<std::uint32_t>(random() % scene.mats.size());
    if (a == b) continue;
    if (i % 8 == 0) {
      scene.maxwell_links.push_back({a, b, uniform(5.0, 20.0), uniform(0.1, 1.0)});
    } else if (i % 8 == 1) {
      scene.state_links.push_back({a, b, 0, distance(a, b)});
    } else {
      scene.links.push_back({a, b, uniform(20.0, 200.0), uniform(0.0, 0.3), distance(a, b)});
    }
  }
  return scene;
}

TEST(FreezingError, IsOffByLessThanTenTolerancesInAnyNetwork) {
  constexpr double kTolerance = 1e-5;
  for (std::uint32_t seed = 1; seed <= static_cast<std::uint32_t>(rounds(24)); ++seed) {
    NetworkDescription scene = resting_network(seed);
    scene.integrator = seed % 2 == 0 ? IntegratorKind::kCordis : IntegratorKind::kLeapfrog;
    World whole = make_world(scene);
    World part = make_world(frozen(scene, kTolerance));
    double square = 0.0;
    double largest = 0.0;
    double farthest = 0.0;
    std::uint32_t max_asleep = 0;
    constexpr int kSteps = 8000;
    for (int n = 0; n < kSteps; ++n) {
      for (World* world : {&whole, &part}) {
        world->set_external_force(5, n < 100 ? Vec3(2.0, 0, 0) : Vec3(Vec3::Zero()));
        world->step();
      }
      for (std::uint32_t i = 0; i < 40; ++i) {
        const double error = (whole.position(i) - part.position(i)).norm() / kTolerance;
        square += error * error / (40.0 * kSteps);
        largest = std::max(largest, error);
        farthest = std::max(farthest, (whole.position(i) - scene.mats[i].position).norm());
      }
      max_asleep = std::max(max_asleep, part.asleep_count());
      if (scene.integrator != IntegratorKind::kCordis) continue;
      const engine::Energy energy = part.energy();
      ASSERT_LT(std::abs(energy.residual()), 1e-9 * energy.largest) << seed << ", step " << n;
    }
    EXPECT_LT(std::sqrt(square), 10.0) << seed;
    EXPECT_LT(largest, 100.0) << seed;
    EXPECT_GT(farthest, 100.0 * kTolerance) << seed;
    EXPECT_GT(max_asleep, 5U) << seed;
    RecordProperty("network" + std::to_string(seed),
                   std::to_string(std::sqrt(square)) + ", at most " + std::to_string(largest));
  }
}

}  // namespace
}  // namespace cordis::test
