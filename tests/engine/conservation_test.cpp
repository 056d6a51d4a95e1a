// tests/engine/conservation_test.cpp -- action and reaction, momentum, angular momentum.
#include <gtest/gtest.h>

#include "tests/engine/scenes.h"

namespace cordis::test {
namespace {

constexpr int kStepsInAll = 10000;

// Each step rounds every position to half an ulp, 1e-16 m here, which is 1e-16 m / dt * 0.1 kg =
// 1e-14 kg m/s of each of the 50 masses at random: 1e-14 * sqrt(50 * 10000) = 7e-12, and as much of
// angular momentum at distances of 1 m. The masses drift some metres away meanwhile, which costs
// another decimal.
constexpr double kDrift = 5e-11;

class FreeNetwork : public testing::TestWithParam<VectorWidth> {};

TEST_P(FreeNetwork, KeepsItsMomentum) {
  World world = make_world(free_cluster(50, 203, 0.3), GetParam());
  const Vec3 before = world.momentum();
  ASSERT_GT(before.norm(), 0.1);

  run(world, kStepsInAll);

  EXPECT_LT((world.momentum() - before).norm(), kDrift);
}

TEST_P(FreeNetwork, KeepsItsAngularMomentum) {
  World world = make_world(free_cluster(50, 203, 0.3), GetParam());
  const Vec3 before = world.angular_momentum();
  ASSERT_GT(before.norm(), 0.1);

  run(world, kStepsInAll);

  EXPECT_LT((world.angular_momentum() - before).norm(), kDrift);
}

TEST_P(FreeNetwork, AnswersEveryActionWithAReaction) {
  NetworkDescription scene = free_cluster(50, 1, 0.3);
  World world = make_world(scene, GetParam());

  for (int n = 0; n < 100; ++n) {
    world.step();
    const Link& link = scene.links[0];
    ASSERT_GT(world.link_force(link.mat_a).norm(), 0.0);
    ASSERT_EQ(world.link_force(link.mat_a), -world.link_force(link.mat_b)) << "step " << n;
  }
}

INSTANTIATE_TEST_SUITE_P(Widths, FreeNetwork, testing::ValuesIn(engine::supported_vector_widths()),
                         [](const auto& width) { return engine::to_string(width.param); });

TEST(Momentum, GrowsByGravityAlone) {
  NetworkDescription scene = free_cluster(20, 60, 0.3);
  scene.gravity = Vec3(0.5, -9.81, 1.0);
  World world = make_world(scene);
  const Vec3 before = world.momentum();
  double total_mass = 0.0;
  for (const Mat& mat : scene.mats) total_mass += mat.mass;

  run(world, 1000);

  const Vec3 expected = before + total_mass * scene.gravity * (1000 * scene.step);
  EXPECT_LT((world.momentum() - expected).norm(), kDrift);
}

}  // namespace
}  // namespace cordis::test
