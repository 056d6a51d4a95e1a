// tests/engine/world_test.cpp
#include "sim_node/engine/world.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/engine/scenes.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/rounds.h"

namespace cordis::test {
namespace {

/// A port at 0, a mass at 1 m, a fixed point at 2 m, springs of 10 N/m between them, all at rest; 3
/// dimensions.
NetworkDescription three_in_a_row(double viscosity = 0.0) {
  NetworkDescription scene;
  scene.step = 1e-2;
  scene.mats = {port(Vec3::Zero()), mass(0.5, Vec3(1, 0, 0)), fixed(Vec3(2, 0, 0))};
  scene.links = {{0, 1, 10.0, viscosity, 1.0}, {1, 2, 10.0, viscosity, 1.0}};
  return scene;
}

TEST(World, NeedsANetwork) {
  EXPECT_THROW(World(nullptr), std::invalid_argument);
}

TEST(World, FallsAlongTheExactParabola) {
  // a second-order start puts every sample on the parabola of the free fall
  NetworkDescription scene;
  scene.step = 0.01;
  scene.gravity = Vec3(0, 0, -10.0);
  scene.mats = {mass(0.3, Vec3(1, 0, 5), Vec3(2, 0, 3))};
  World world = make_world(scene);

  for (int n = 1; n <= 300; ++n) {
    world.step();
    const double t = n * scene.step;
    const Vec3 expected(1 + 2 * t, 0, 5 + 3 * t - 5 * t * t);
    ASSERT_LT((world.position(0) - expected).norm(), 1e-15 * n * n) << "step " << n;
  }
}

TEST(World, SlowsDownInAMedium) {
  // v(n+1/2) = (1 - Z dt / m) v(n-1/2)
  NetworkDescription scene;
  scene.step = 0.01;
  scene.medium_viscosity = 0.4;
  scene.mats = {mass(0.5, Vec3::Zero(), Vec3(0, 2, 0))};
  World world = make_world(scene);
  const double before = world.velocity(0).y();

  run(world, 200);

  EXPECT_NEAR(world.velocity(0).y(), before * std::pow(1.0 - 0.4 * 0.01 / 0.5, 200), 1e-12);
}

TEST(World, StartsFromTheViscousForceOfTheInitialSpeed) {
  // Z alone: a0 = -Z v0 / m, so the half-step velocity before step 0 is v0 + Z v0 dt / 2m
  World link = make_world(oscillator(0.5, 0.0, 0.4, 1.0, 2.0, 0.01));
  NetworkDescription scene = oscillator(0.5, 0.0, 0.0, 1.0, 2.0, 0.01);
  scene.medium_viscosity = 0.4;
  World medium = make_world(scene);

  EXPECT_NEAR(link.velocity(1).x(), 2.0 * (1.0 + 0.4 * 0.01 / 1.0), 1e-12);
  EXPECT_NEAR(medium.velocity(1).x(), 2.0 * (1.0 + 0.4 * 0.01 / 1.0), 1e-12);
}

TEST(World, NeverMovesAFixedPointOrAnUntouchedPort) {
  NetworkDescription scene = three_in_a_row();
  scene.gravity = Vec3(0, -9.81, 0);
  World world = make_world(scene);

  run(world, 500);

  EXPECT_EQ(world.position(0), Vec3(0, 0, 0));
  EXPECT_EQ(world.position(2), Vec3(2, 0, 0));
  EXPECT_NE(world.position(1), Vec3(1, 0, 0));
}

TEST(World, PutsAPortInPlaceBeforeTheForces) {
  World world = make_world(three_in_a_row(/*viscosity=*/0.5));

  world.impose_position(0, Vec3(0.1, 0, 0));
  EXPECT_EQ(world.position(0), Vec3(0, 0, 0));
  world.step();

  EXPECT_EQ(world.position(0), Vec3(0.1, 0, 0));
  EXPECT_NEAR(world.velocity(0).x(), 10.0, 1e-12);
  // the spring is 0.1 m short, and its end comes nearer at 10 m/s: it pushes the port back
  EXPECT_NEAR(world.link_force(0).x(), -10.0 * 0.1 - 0.5 * 10.0, 1e-12);

  world.step();
  EXPECT_EQ(world.position(0), Vec3(0.1, 0, 0));
  EXPECT_EQ(world.velocity(0), Vec3(0, 0, 0));
}

TEST(World, TakesTheLastOfSeveralPositions) {
  World world = make_world(three_in_a_row());

  world.impose_position(0, Vec3(5, 5, 5));
  world.impose_position(0, Vec3(0.2, 0, 0));
  world.step();

  EXPECT_EQ(world.position(0), Vec3(0.2, 0, 0));
}

TEST(World, HoldsAnExternalForce) {
  // alone in space: x(n) = f t^2 / 2 m, up to the half step before which there was no force
  NetworkDescription scene;
  scene.step = 0.01;
  scene.mats = {mass(0.5, Vec3::Zero())};
  World world = make_world(scene);

  world.set_external_force(0, Vec3(0, 3, 0));
  run(world, 100);
  EXPECT_NEAR(world.velocity(0).y(), 3.0 / 0.5 * 100 * 0.01, 1e-12);
  EXPECT_EQ(world.link_force(0), Vec3(0, 0, 0));

  world.set_external_force(0, Vec3::Zero());
  run(world, 100);
  EXPECT_NEAR(world.velocity(0).y(), 3.0 / 0.5 * 100 * 0.01, 1e-12);
}

TEST(World, KeepsLinkForceAndExternalForceApart) {
  World world = make_world(three_in_a_row());
  world.set_external_force(1, Vec3(4, 0, 0));
  world.impose_position(0, Vec3(0.1, 0, 0));

  world.step();

  EXPECT_NEAR(world.link_force(1).x(), 1.0, 1e-12);
  EXPECT_NEAR(world.velocity(1).x(), (1.0 + 4.0) / 0.5 * 0.01, 1e-12);
}

TEST(World, HasNoLinkForceBeforeTheFirstStep) {
  NetworkDescription scene = three_in_a_row();
  scene.mats[1].position.x() = 1.5;
  const World world = make_world(scene);

  EXPECT_EQ(world.link_force(1), Vec3(0, 0, 0));
  EXPECT_EQ(world.step_count(), 0U);
}

TEST(World, RefusesInputsThatAreNotFinite) {
  World world = make_world(three_in_a_row());
  world.set_external_force(1, Vec3(1, 0, 0));
  world.impose_position(0, Vec3(kNan, 0, 0));
  world.set_external_force(1, Vec3(0, std::numeric_limits<double>::infinity(), 0));

  EXPECT_EQ(world.step().refused_inputs, 2U);
  EXPECT_EQ(world.position(0), Vec3(0, 0, 0));
  EXPECT_EQ(world.velocity(1), Vec3(0, 0, 0)) << "a force that is not finite counts as none";
  EXPECT_EQ(world.step().refused_inputs, 0U);
}

TEST(World, IgnoresWhatLiesBeyondItsDimension) {
  NetworkDescription scene = three_in_a_row();
  scene.dimension = 1;
  World world = make_world(scene);

  world.impose_position(0, Vec3(0.1, 0.2, 0.3));
  world.set_external_force(1, Vec3(0, 1, 1));
  world.step();

  EXPECT_EQ(world.position(0), Vec3(0.1, 0, 0));
  EXPECT_EQ(world.position(1).tail<2>(), Eigen::Vector2d::Zero());
}

TEST(World, ReportsMatsThatAreNoLongerFinite) {
  for (const int dimension : {1, 3}) {
    NetworkDescription scene = three_in_a_row();
    scene.dimension = dimension;
    scene.step = 10.0;  // far beyond the limit of stability
    scene.mats[1].position.x() = 1.01;
    scene.mats.push_back(mass(1.0, Vec3::Zero()));  // not linked: stays finite
    World world = make_world(scene);
    engine::StepReport report;

    for (int n = 0; n < 500 && report.non_finite_mats == 0; ++n) report = world.step();

    EXPECT_EQ(report.non_finite_mats, 1U);
    EXPECT_EQ(world.position(2), Vec3(2, 0, 0)) << "a fixed point stays where it is";
    EXPECT_EQ(world.step().non_finite_mats, 1U);
  }
}

TEST(World, ShowsItsPositionsAsColumns) {
  World world = make_world(three_in_a_row());
  const engine::Columns& columns = world.positions();
  world.set_external_force(1, Vec3(1, 2, 3));

  run(world, 3);

  ASSERT_EQ(columns.cols(), 3);
  for (std::uint32_t i = 0; i < 3; ++i) {
    EXPECT_EQ(Vec3(columns.col(i).head<3>()), world.position(i));
    EXPECT_EQ(columns(3, i), 0.0);
  }
}

TEST(World, StepsWithoutAllocating) {
  NetworkDescription scene = free_cluster(30, 101, 0.2);
  scene.medium_viscosity = 0.01;
  scene.mats.push_back(port(Vec3::Zero()));
  scene.links.push_back({0, 30, 10.0, 0.1, 0.2});
  World world = make_world(scene);

  const AllocationGuard guard;
  for (int n = 0; n < 10; ++n) {
    world.impose_position(30, Vec3(0.01 * n, 0, 0));
    world.set_external_force(static_cast<std::uint32_t>(n), Vec3(1, 0, 0));
    world.step();
  }
  const double energy = world.energy().total();
  const std::uint64_t hash = world.state_hash();

  EXPECT_EQ(guard.count(), 0U);
  EXPECT_TRUE(std::isfinite(energy));
  EXPECT_NE(hash, 0U);
}

TEST(AllocationGuard, CountsAnAllocation) {
  const AllocationGuard guard;

  const World world = make_world(three_in_a_row());

  EXPECT_GT(guard.count(), 5U);
}

TEST(World, GoesOnAfterAMove) {
  World first = make_world(free_cluster(10, 20, 0.2));
  World second = make_world(free_cluster(10, 20, 0.2));
  run(first, 10);
  run(second, 20);

  World moved = std::move(first);
  run(moved, 10);

  EXPECT_EQ(moved.state_hash(), second.state_hash());
}

/// Three masses on springs and dampers, turning and swinging about a place away from the origin.
NetworkDescription spinning(engine::IntegratorKind integrator, double rate, double viscosity) {
  NetworkDescription scene;
  scene.dimension = 3;
  scene.integrator = integrator;
  scene.step = 1.0 / rate;
  const Vec3 away(0.7, -0.4, 0.2);
  scene.mats = {mass(0.1, away, Vec3(0.3, 1.0, -0.2)),
                mass(0.2, away + Vec3(0.5, 0.1, 0), Vec3(-0.2, -0.6, 0.3)),
                mass(0.15, away + Vec3(0.1, 0.6, 0.3), Vec3(0.1, 0.2, -0.3))};
  scene.links = {
      {0, 1, 40.0, viscosity, 0.4}, {1, 2, 70.0, viscosity, 0.5}, {2, 0, 30.0, viscosity, 0.6}};
  scene.mats[2].velocity = -(0.1 * scene.mats[0].velocity + 0.2 * scene.mats[1].velocity) / 0.15;
  return scene;
}

/// The largest change of its angular momentum in 20 s, over that of the start.
double lost_angular_momentum(const NetworkDescription& scene) {
  World world = make_world(scene);
  world.step();
  const Vec3 start = world.angular_momentum();
  double largest = 0.0;
  for (int n = 0; n < rounds(20); ++n) {
    run(world, static_cast<int>(1.0 / scene.step));
    largest = std::max(largest, (world.angular_momentum() - start).norm() / start.norm());
  }
  return largest;
}

TEST(World, KeepsItsAngularMomentumFor20Seconds) {
  using engine::IntegratorKind;
  for (const IntegratorKind integrator : {IntegratorKind::kCordis, IntegratorKind::kLeapfrog}) {
    for (const double rate : {44'100.0, 192'000.0}) {
      EXPECT_LT(lost_angular_momentum(spinning(integrator, rate, 0.0)), 1e-12) << rate << " Hz";
    }
    for (const double viscosity : {1.0, 3000.0}) {
      EXPECT_LT(lost_angular_momentum(spinning(integrator, 44'100.0, viscosity)), 1e-12)
          << viscosity;
    }
  }
  EXPECT_LT(lost_angular_momentum(spinning(IntegratorKind::kSymplectic4, 44'100.0, 0.0)), 3e-11);
}

/// What turns is damped by the step, as what swings: by w^2 dt / 2, of first order.
TEST(World, LosesAngularMomentumInProportionToTheStepWithImplicit) {
  const double at_44 =
      lost_angular_momentum(spinning(engine::IntegratorKind::kImplicit, 44'100.0, 1.0));
  const double at_88 =
      lost_angular_momentum(spinning(engine::IntegratorKind::kImplicit, 88'200.0, 1.0));
  EXPECT_NEAR(at_44 / at_88, 2.0, 0.1);
  EXPECT_LT(at_44, 0.01);
}

}  // namespace
}  // namespace cordis::test
