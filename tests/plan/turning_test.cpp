// tests/plan/turning_test.cpp -- links that energy may press so short that they turn about.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
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

/// Masses that are all within range of each other, all their places times a scale, each pair at rest at 1 m.
NetworkDescription crowd_at(double scale, int dimension, const engine::StateMachine& machine) {
  NetworkDescription scene;
  scene.dimension = dimension;
  scene.step = 1e-3;
  std::mt19937 random(2);
  const auto place = [&] { return scale * static_cast<double>(random()) / 4294967296.0; };
  engine::SetLiaison set;
  for (std::uint32_t i = 0; i < 10; ++i) {
    Vec3 position = Vec3::Zero();
    for (int axis = 0; axis < dimension; ++axis) position[axis] = place();
    scene.mats.push_back(mass(1.0, position));
    set.set_p.push_back(i);
  }
  set.rest_length = 1.0;
  set.range = 100.0;
  scene.state_machines = {machine};
  scene.sets = {set};
  return scene;
}

TEST(Turning, OfACrumpledSetGainsEnergyBelowTheCertifiedStepAndIsToldBefore) {
  for (const int dimension : {1, 2, 3}) {
    SCOPED_TRACE(dimension);
    const double scale = dimension == 1 ? 2.0 : 0.1;  // a row of masses that pass each other
    NetworkDescription scene = crowd_at(scale, dimension, state_machine(kNetStiffness));
    scene.step = 0.9 * turning_stability(scene).certified.step;
    EXPECT_GT(turning_growth(scene), 10.0) << "what is not claimed to be stable";
    const plan::Stability stability = turning_stability(scene);
    EXPECT_TRUE(stability.holds()) << "each of its tangents is stable";
    ASSERT_TRUE(stability.turning.liaison.has_value());
    EXPECT_EQ(stability.turning.liaison->kind, engine::LiaisonKind::kSet);
    // in 1 dimension all of it would do at a short step; at 0.9 energy swings
    const double energy = dimension == 1 ? (1.0 - 0.9 * 0.9) / 2.0 : 1.0 / 32.0;
    EXPECT_NEAR(stability.turning.energy, energy * kNetStiffness, 1e-6 * kNetStiffness);
  }
}

TEST(Turning, OfAPairInOneDimensionCountsHowFarItsEnergySwings) {
  NetworkDescription scene = crowd_at(1.0, 1, state_machine(kNetStiffness));
  scene.mats.resize(2);
  scene.sets[0].set_p = {0, 1};
  scene.mats[0].position = Vec3(0, 0, 0);
  scene.mats[1].position = Vec3(0.05, 0, 0);
  scene.mats[0].velocity = Vec3(1, 0, 0);  // 452 J, of 500 J that let the ends pass each other
  for (const auto kind : {engine::IntegratorKind::kCordis, engine::IntegratorKind::kImplicit}) {
    scene.integrator = kind;
    scene.step = 1e-3;
    const double longest = turning_stability(scene).certified.step;
    scene.step = 0.05 * longest;
    EXPECT_FALSE(turning_stability(scene).turning.liaison.has_value());
    EXPECT_LT(turning_growth(scene), 1.1);
    scene.step = 0.5 * longest;
    EXPECT_TRUE(turning_stability(scene).turning.liaison.has_value());
  }
}

TEST(Turning, OfASetIsHeldAgainstTheEnergyOfAllItsPairs) {
  NetworkDescription scene = crowd_at(1.0, 2, state_machine(kNetStiffness));
  scene.mats.resize(3);
  scene.sets[0].set_p = {0, 1, 2};
  scene.mats[0].position = Vec3(0, 0, 0);
  scene.mats[1].position = Vec3(1, 0, 0);
  scene.mats[2].position = Vec3(0.5, std::sqrt(0.75), 0);
  EXPECT_FALSE(turning_stability(scene).turning.liaison.has_value());
  for (engine::Mat& mat : scene.mats) mat.position *= 0.8;  // 20 J each
  EXPECT_TRUE(turning_stability(scene).turning.liaison.has_value()) << "31.25 J";
}

TEST(Turning, OfASetOfPointsAndBallsIsThatOfTheShortestPairWithALength) {
  NetworkDescription scene = crowd_at(1.0, 2, state_machine(kNetStiffness));
  scene.sets[0].rest_length = -1.0;  // the radii of both
  scene.radius.assign(scene.mats.size(), 0.5);
  scene.radius[0] = scene.radius[1] = 0.0;
  EXPECT_DOUBLE_EQ(turning_stability(scene).turning.energy, kNetStiffness * 0.5 * 0.5 / 32.0);
  scene.radius.assign(scene.mats.size(), 0.0);
  EXPECT_TRUE(std::isinf(turning_stability(scene).turning.energy)) << "points alone";
}

TEST(Turning, IsThatOfLawsThatPushLikeASpring) {
  using engine::Ring;
  const engine::StateMachine lines[] = {
      state_machine(0.0, engine::Power{kNetStiffness, 1.0}),
      state_machine(0.0, engine::Rings{{Ring{kNetStiffness, 1.0}}}),
      state_machine(0.0, engine::Table({-1.0, 1.0}, {-kNetStiffness, kNetStiffness})),
      state_machine(0.5 * kNetStiffness, engine::Power{0.5 * kNetStiffness, 1.0})};
  for (const engine::StateMachine& line : lines) {
    const NetworkDescription crowd = crowd_at(0.1, 2, line);
    EXPECT_NEAR(turning_stability(crowd).turning.energy, kNetStiffness / 32.0,
                0.15 * kNetStiffness / 32.0);
    EXPECT_TRUE(turning_stability(crowd).turning.liaison.has_value());
    const NetworkDescription row = crowd_at(0.1, 1, line);
    EXPECT_NEAR(turning_stability(row).turning.energy, kNetStiffness / 2.0, 0.05 * kNetStiffness);
    NetworkDescription net = net_at(0.1, 2);
    for (const engine::Link& link : net.links)
      net.state_links.push_back({link.mat_a, link.mat_b, 0, link.rest_length});
    net.links.clear();
    net.state_machines = {line};
    EXPECT_NEAR(turning_stability(net).turning.energy, kNetStiffness / 32.0,
                0.15 * kNetStiffness / 32.0);
  }
  // So steep where it pushes that its push over the length never comes near its slope.
  const auto balls = state_machine(0.0, engine::LennardJones{1.0, 1.0, 3.0});
  EXPECT_TRUE(std::isinf(turning_stability(crowd_at(2.0, 2, balls)).turning.energy));
  engine::StateMachine thread = state_machine(kNetStiffness);
  thread.states[0].pushes = false;
  EXPECT_TRUE(std::isinf(turning_stability(crowd_at(0.1, 2, thread)).turning.energy));
}

/// On a face the direction stays; at a corner it turns as about a point.
TEST(Turning, OfASurfaceComesOfItsEdges) {
  for (const bool has_edge : {false, true}) {
    NetworkDescription scene;
    scene.dimension = 2;
    scene.step = 1e-3;
    scene.mats = {fixed(Vec3::Zero()), mass(1.0, Vec3(0.5, 0.5, 0))};
    scene.surfaces.emplace_back();
    scene.surfaces[0].mat = 0;
    if (has_edge) {
      scene.surfaces[0].kind = engine::SurfaceKind::kBox;
      scene.surfaces[0].half_size = Vec3(0.1, 0.1, 0);
    }
    engine::SetLiaison set;
    set.set_p = {0};
    set.set_q = {1};
    set.rest_length = 1.0;
    set.range = 1.0;
    scene.sets = {set};
    scene.state_machines = {contact(kNetStiffness)};
    EXPECT_EQ(turning_stability(scene).turning.energy,
              has_edge ? kNetStiffness / 32.0 : std::numeric_limits<double>::infinity());
  }
}

}  // namespace
}  // namespace cordis::test
