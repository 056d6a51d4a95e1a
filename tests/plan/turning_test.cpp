// tests/plan/turning_test.cpp -- links that energy may press so short that they turn about.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

#include <gtest/gtest.h>

#include "sim_node/plan/plan.h"
#include "tests/plan/networks.h"

namespace cordis::test {
namespace {

constexpr int kNetSide = 3;  // masses
constexpr double kNetStiffness = 1000.0;

/// A triangular net of springs of 1 m, all its masses at their places times a scale.
NetworkDescription net_at(double scale, int dimension) {
  NetworkDescription scene;
  scene.dimension = dimension;
  scene.step = 1e-3;
  std::mt19937 random(1);
  const auto little = [&random] { return 0.3 * (static_cast<double>(random()) / 4294967296.0); };
  for (int i = 0; i < kNetSide; ++i) {
    for (int j = 0; j < kNetSide; ++j) {
      const Vec3 place(std::sqrt(0.75) * i, j + 0.5 * i, 0);
      const Vec3 away(little(), little(), dimension > 2 ? little() : 0.0);
      scene.mats.push_back(mass(1.0, scale < 1.0 ? Vec3(scale * (place + away)) : place));
    }
  }
  const auto join = [&scene](int a, int b) {
    scene.links.push_back(
        {static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b), kNetStiffness, 0.0, 1.0});
  };
  for (int i = 0; i < kNetSide; ++i) {
    for (int j = 0; j < kNetSide; ++j) {
      const int here = kNetSide * i + j;
      if (i + 1 < kNetSide) join(here, here + kNetSide);
      if (j + 1 < kNetSide) join(here, here + 1);
      if (i + 1 < kNetSide && j > 0) join(here, here + kNetSide - 1);
    }
  }
  return scene;
}

plan::Stability turning_stability(const NetworkDescription& scene) {
  return plan::stability_of(scene, plan::liaison_graph(scene));
}

/// The largest energy in 20,000 steps over that of the start.
double turning_growth(const NetworkDescription& scene) {
  World world = make_world(scene);
  const double start = world.energy().initial;
  double largest = start;
  for (int n = 0; n < 20'000; ++n) {
    world.step();
    largest = std::max(largest, start + world.energy().integration_error());
  }
  return largest / start;
}

TEST(Turning, OfACrumpledNetGainsEnergyBelowTheCertifiedStepAndIsToldBefore) {
  for (const int dimension : {2, 3}) {
    NetworkDescription scene = net_at(0.1, dimension);
    scene.step = 0.7 * turning_stability(scene).certified.step;
    EXPECT_GT(turning_growth(scene), 10.0) << "what is not claimed to be stable";
    const plan::Stability stability = turning_stability(scene);
    EXPECT_TRUE(stability.holds()) << "each of its tangents is stable";
    EXPECT_TRUE(stability.turning.liaison.has_value());
    EXPECT_DOUBLE_EQ(stability.turning.energy, kNetStiffness / 32.0);
  }
}

TEST(Turning, ComesOfNoNetWhoseEnergyIsTooLittleForIt) {
  for (const int dimension : {2, 3}) {
    NetworkDescription scene = net_at(1.0, dimension);
    // 4.5 J, and 9 J of two that meet; 31.25 J press a link by a quarter.
    scene.mats[0].velocity = Vec3(1.8, 2.4, 0.0);
    scene.step = 0.98 * turning_stability(scene).certified.step;
    EXPECT_LT(turning_growth(scene), 2.0) << "a swing near the limit";
    EXPECT_FALSE(turning_stability(scene).turning.liaison.has_value());
    EXPECT_DOUBLE_EQ(turning_stability(scene).turning.energy, kNetStiffness / 32.0);

    scene.mats[0].velocity *= 2.0;
    EXPECT_TRUE(turning_stability(scene).turning.liaison.has_value());
  }
}

TEST(Turning, IsNothingInOneDimensionWithoutARestLengthOrBetweenFixedPoints) {
  NetworkDescription line = net_at(0.1, 2);
  line.dimension = 1;
  for (engine::Mat& mat : line.mats) mat.position = Vec3(mat.position.x(), 0.0, 0.0);
  NetworkDescription of_points = net_at(0.1, 2);
  for (engine::Link& link : of_points.links) link.rest_length = 0.0;
  NetworkDescription still = net_at(0.1, 2);
  for (engine::Mat& mat : still.mats) mat = fixed(mat.position);
  for (const NetworkDescription& scene : {line, of_points, still}) {
    EXPECT_FALSE(turning_stability(scene).turning.liaison.has_value());
    EXPECT_TRUE(std::isinf(turning_stability(scene).turning.energy));
  }
}

TEST(Turning, IsThatOfLinksWithStatesThatPushToo) {
  NetworkDescription scene = net_at(0.1, 2);
  engine::StateMachine machine = state_machine(kNetStiffness);
  for (const engine::Link& link : scene.links)
    scene.state_links.push_back({link.mat_a, link.mat_b, 0, link.rest_length});
  scene.links.clear();
  scene.state_machines = {machine};
  EXPECT_TRUE(turning_stability(scene).turning.liaison.has_value());
  scene.state_machines[0].states[0].pushes = false;
  EXPECT_FALSE(turning_stability(scene).turning.liaison.has_value());
}

}  // namespace
}  // namespace cordis::test
