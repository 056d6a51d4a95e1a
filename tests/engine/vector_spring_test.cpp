// tests/engine/vector_spring_test.cpp -- links whose damper acts on the whole relative velocity.
#include <cmath>

#include <gtest/gtest.h>

#include "tests/engine/scenes.h"
#include "tests/support/allocation_guard.h"

namespace cordis::test {
namespace {

using engine::Energy;
using engine::IntegratorKind;

constexpr double kHoldStiffness = 500.0;  // [N/m]

/// A tool linked to a port, and a free mass linked to the tool.
NetworkDescription held_tools(IntegratorKind integrator, double viscosity) {
  NetworkDescription scene;
  scene.dimension = 3;
  scene.step = 1e-3;
  scene.integrator = integrator;
  scene.mats = {fixed(Vec3::Zero()), mass(0.05, Vec3(0.01, 0, 0), Vec3(0, 1, 0.3)),
                mass(0.08, Vec3(0.01, 0, 0), Vec3(0.2, 0, 0))};
  if (integrator != IntegratorKind::kSymplectic4) scene.mats[0] = port(Vec3::Zero());
  scene.links = {{0, 1, kHoldStiffness, viscosity, 0.0, true}, {1, 2, 300.0, viscosity, 0.0, true}};
  return scene;
}

/// What the scene is along one axis, in 1 dimension.
NetworkDescription along(int axis, NetworkDescription scene) {
  scene.dimension = 1;
  for (Mat& mat : scene.mats) {
    mat.position = Vec3(mat.position[axis], 0, 0);
    mat.velocity = Vec3(mat.velocity[axis], 0, 0);
  }
  for (Link& link : scene.links) link.isotropic = false;
  return scene;
}

struct Case {
  IntegratorKind integrator;
  double viscosity;  // [N s/m]; 16: `leapfrog` damps implicitly
};

class EveryIntegrator : public testing::TestWithParam<Case> {};

TEST_P(EveryIntegrator, MovesAVectorSpringAlongEachAxisAsALinkInOneDimension) {
  const NetworkDescription scene = held_tools(GetParam().integrator, GetParam().viscosity);
  World world = make_world(scene);
  World lines[] = {make_world(along(0, scene)), make_world(along(1, scene)),
                   make_world(along(2, scene))};

  for (int n = 1; n <= 300; ++n) {
    const Vec3 hand = 0.02 * Vec3(std::sin(0.05 * n), std::sin(0.03 * n), 0.0);
    const bool moved = scene.mats[0].kind == MatKind::kPort;
    if (moved) world.impose_position(0, hand);
    world.step();
    Energy sum;
    for (int axis = 0; axis < 3; ++axis) {
      if (moved) lines[axis].impose_position(0, Vec3(hand[axis], 0, 0));
      lines[axis].step();
      for (const std::uint32_t mat : {1U, 2U}) {
        ASSERT_NEAR(world.position(mat)[axis], lines[axis].position(mat).x(), 1e-13) << n;
      }
      ASSERT_NEAR(world.link_force(0)[axis], lines[axis].link_force(0).x(), 1e-10) << n;
      const Energy line = lines[axis].energy();
      sum.kinetic += line.kinetic;
      sum.elastic += line.elastic;
      sum.dissipated += line.dissipated;
      sum.port_work += line.port_work;
    }
    const Energy energy = world.energy();
    ASSERT_NEAR(energy.kinetic, sum.kinetic, 1e-12) << n;
    ASSERT_NEAR(energy.elastic, sum.elastic, 1e-12) << n;
    ASSERT_NEAR(energy.dissipated, sum.dissipated, 1e-12) << n;
    ASSERT_NEAR(energy.port_work, sum.port_work, 1e-12) << n;
  }
}

INSTANTIATE_TEST_SUITE_P(All, EveryIntegrator,
                         testing::Values(Case{IntegratorKind::kCordis, 1.5},
                                         Case{IntegratorKind::kLeapfrog, 1.5},
                                         Case{IntegratorKind::kLeapfrog, 16.0},
                                         Case{IntegratorKind::kSymplectic4, 0.0},
                                         Case{IntegratorKind::kImplicit, 1.5}));

TEST(VectorSpring, CalmsAToolThatCirclesItsHandle) {
  // x, y(n+1) = (2 - K' - Z') x(n) - (1 - Z') x(n-1): a radius that shrinks by sqrt(1 - Z') a step.
  // Another link of rest length 0 keeps the circle.
  constexpr double kToolMass = 0.05;
  constexpr double kViscosity = 1.5;
  for (const bool isotropic : {true, false}) {
    NetworkDescription scene;
    scene.dimension = 2;
    scene.step = 1e-3;
    scene.mats = {port(Vec3::Zero()),
                  mass(kToolMass, Vec3(0.001, 0, 0),
                       Vec3(0, 0.001 * std::sqrt(kHoldStiffness / kToolMass), 0))};
    scene.links = {{0, 1, kHoldStiffness, kViscosity, 0.0, isotropic}};
    World world = make_world(scene);
    const double radius = 1e-3;

    run(world, 200);

    const double shrunk = std::pow(1.0 - kViscosity * scene.step / kToolMass, 100.0);
    EXPECT_LT(shrunk, 0.05);
    // An ellipse by now, Z / 2 sqrt(K m) = 0.15 of its size from a circle.
    EXPECT_NEAR(world.position(1).norm(), radius * (isotropic ? shrunk : 1.0),
                radius * (isotropic ? 0.2 * shrunk : 0.05));
  }
}

TEST(VectorSpring, KeepsMomentumStateAndAccount) {
  NetworkDescription scene = held_tools(IntegratorKind::kCordis, 1.5);
  scene.mats[0] = mass(0.1, Vec3::Zero());
  World world = make_world(scene);
  const Vec3 momentum = world.momentum();

  run(world, 100);
  const engine::Snapshot snapshot = world.snapshot();
  World other = make_world(scene);
  other.restore(snapshot);
  {
    const AllocationGuard guard;
    run(world, 100);
    EXPECT_EQ(guard.count(), 0U);
  }
  run(other, 100);

  EXPECT_LT((world.momentum() - momentum).norm(), 1e-14);
  EXPECT_EQ(world.state_hash(), other.state_hash());
  EXPECT_LT(std::abs(world.energy().residual()), 1e-14);
  EXPECT_EQ(world.energy().dissipated, other.energy().dissipated);
}

TEST(VectorSpring, HasNoRestLength) {
  NetworkDescription scene = held_tools(IntegratorKind::kCordis, 1.5);
  scene.links[1].rest_length = 0.1;

  EXPECT_THROW(make_world(scene), std::invalid_argument);
}

}  // namespace
}  // namespace cordis::test
