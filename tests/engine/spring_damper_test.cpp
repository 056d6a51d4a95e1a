// tests/engine/spring_damper_test.cpp -- the law of a link, and how links stand together in a
// batch.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/engine/scenes.h"

namespace cordis::test {
namespace {

class SpringDamper : public testing::TestWithParam<VectorWidth> {};

INSTANTIATE_TEST_SUITE_P(Widths, SpringDamper, testing::ValuesIn(engine::supported_vector_widths()),
                         [](const auto& width) { return engine::to_string(width.param); });

TEST_P(SpringDamper, PullsAlongTheLineOfItsEnds) {
  // d = 3 along (1, 2, 2) / 3, K = 7, rest = 2, end b leaves at 0.6 m/s along x: 0.2 m/s along the
  // line
  NetworkDescription scene;
  scene.step = 1e-6;
  scene.mats = {fixed(Vec3(1, 1, 1)), mass(1.0, Vec3(2, 3, 3), Vec3(0.6, 0, 0))};
  scene.links = {{0, 1, 7.0, 5.0, 2.0}};
  World world = make_world(scene, GetParam());

  world.step();

  const Vec3 tension = (7.0 * (3.0 - 2.0) + 5.0 * 0.2) * Vec3(1, 2, 2) / 3.0;
  EXPECT_LT((world.link_force(0) - tension).norm(),
            1e-4);  // of the acceleration during half a step
  EXPECT_LT((world.link_force(1) + tension).norm(), 1e-4);
}

TEST_P(SpringDamper, HasASignInOneDimension) {
  // ends crossed: b - a = -1, rest = 2, hence a tension of -3 K
  NetworkDescription scene;
  scene.dimension = 1;
  scene.step = 1e-3;
  scene.mats = {fixed(Vec3(1, 0, 0)), fixed(Vec3::Zero())};
  scene.links = {{0, 1, 7.0, 5.0, 2.0}};
  World world = make_world(scene, GetParam());

  world.step();

  EXPECT_EQ(world.link_force(0), Vec3(-21, 0, 0));
  EXPECT_EQ(world.link_force(1), Vec3(21, 0, 0));
}

TEST_P(SpringDamper, HasNoForceWhileItsLengthIsZero) {
  for (const double viscosity : {0.0, 2.0}) {
    NetworkDescription scene;
    scene.step = 1e-3;
    scene.mats = {mass(0.1, Vec3(1, 2, 3)), mass(0.1, Vec3(1, 2, 3))};
    scene.links = {{0, 1, 100.0, viscosity, 0.5}};
    World world = make_world(scene, GetParam());

    run(world, 10);

    EXPECT_EQ(world.link_force(0), Vec3(0, 0, 0));
    EXPECT_EQ(world.position(0), Vec3(1, 2, 3));
    EXPECT_EQ(world.position(1), Vec3(1, 2, 3));
    EXPECT_TRUE(std::isfinite(world.energy().dissipated));
  }
}

TEST_P(SpringDamper, PassesThroughLengthZeroWithoutHarm) {
  // a bead through its anchor, placed so that a step falls on it
  NetworkDescription scene;
  scene.step = 0.125;
  scene.mats = {port(Vec3::Zero()), fixed(Vec3(1, 0, 0))};
  scene.links = {{0, 1, 100.0, 2.0, 0.5}};
  World world = make_world(scene, GetParam());

  for (const double x : {0.5, 1.0, 1.5}) {
    world.impose_position(0, Vec3(x, 0, 0));
    const engine::StepReport report = world.step();
    EXPECT_EQ(report.non_finite_mats, 0U);
    EXPECT_TRUE(world.link_force(0).allFinite());
    EXPECT_TRUE(std::isfinite(world.energy().residual()));
  }
}

/// The forces of the first step, added up one link after the other.
std::vector<Vec3> expected_forces(const NetworkDescription& scene) {
  std::vector<Vec3> forces(scene.mats.size(), Vec3::Zero());
  for (const Link& link : scene.links) {
    const Vec3 along = scene.mats[link.mat_b].position - scene.mats[link.mat_a].position;
    const Vec3 tension = link.stiffness * (along.norm() - link.rest_length) * along.normalized();
    forces[link.mat_a] += tension;
    forces[link.mat_b] -= tension;
  }
  return forces;
}

TEST_P(SpringDamper, CountsEveryLinkOnceWhateverTheirNumber) {
  for (std::uint32_t link_count = 0; link_count <= 35; ++link_count) {
    const NetworkDescription scene = free_cluster(9, link_count, 0.0);
    World world = make_world(scene, GetParam());
    const std::vector<Vec3> expected = expected_forces(scene);

    world.step();

    for (std::uint32_t i = 0; i < scene.mats.size(); ++i) {
      EXPECT_LT((world.link_force(i) - expected[i]).norm(), 1e-12) << link_count << " links";
    }
  }
}

TEST_P(SpringDamper, AddsUpWhereLinksOfABatchShareTheirEnds) {
  NetworkDescription scene;
  scene.step = 1e-3;
  scene.mats = {mass(1e9, Vec3::Zero()), mass(1e9, Vec3(2, 0, 0)), mass(1e9, Vec3(0, 3, 0))};
  for (int l = 0; l < 13; ++l) scene.links.push_back({0, 1, 1.0, 0.5, 1.0});
  for (int l = 0; l < 13; ++l) scene.links.push_back({2, 0, 1.0, 0.5, 1.0});
  World world = make_world(scene, GetParam());

  world.step();

  EXPECT_NEAR(world.link_force(0).x(), 13.0, 1e-9);
  EXPECT_NEAR(world.link_force(0).y(), 26.0, 1e-9);
  EXPECT_EQ(world.link_force(1).x(), -world.link_force(0).x());
  EXPECT_EQ(world.link_force(2).y(), -world.link_force(0).y());
}

TEST_P(SpringDamper, MovesAllAlikeInTwoAndThreeDimensions) {
  NetworkDescription flat = free_cluster(20, 61, 0.2, 2);
  NetworkDescription space = flat;
  space.dimension = 3;
  World flat_world = make_world(flat, GetParam());
  World space_world = make_world(space, GetParam());

  run(flat_world, 100);
  run(space_world, 100);

  EXPECT_EQ(flat_world.state_hash(), space_world.state_hash());
}

}  // namespace
}  // namespace cordis::test
