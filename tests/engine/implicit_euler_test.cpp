// tests/engine/implicit_euler_test.cpp -- stiff cables at large steps.
#include <algorithm>
#include <cmath>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "tests/engine/many_states.h"
#include "tests/engine/scenes.h"
#include "tests/support/allocation_guard.h"

namespace cordis::test {
namespace {

using engine::IntegratorKind;

NetworkDescription by_implicit(NetworkDescription scene) {
  scene.integrator = IntegratorKind::kImplicit;
  return scene;
}

/// A chain of 60 masses that hangs from one end, let go when it lies level.
NetworkDescription cable(double stiffness, double step) {
  NetworkDescription scene;
  scene.dimension = 3;
  scene.step = step;
  scene.gravity = Vec3(0, 0, -9.81);
  scene.medium_viscosity = 0.02;
  for (std::uint32_t i = 0; i < 60; ++i) {
    const Vec3 place(0.01 * i, 0, 0);
    scene.mats.push_back(i == 0 ? fixed(place) : mass(0.01, place));
    if (i > 0) scene.links.push_back({i - 1, i, stiffness, 0.1, 0.01});
  }
  return scene;
}

TEST(ImplicitEuler, FollowsItsRecurrence) {
  // (1 + Z' + K') x(n+1) = (2 + Z') x(n) - x(n-1), from x(-1) = x0 - dt v0
  const double stiffness = 30.0;
  const double viscosity = 7.0;
  World world = make_world(by_implicit(oscillator(1.0, stiffness, viscosity, 0.1, -0.2, 1.0)));
  double before = 0.1 + 0.2;
  double now = 0.1;
  for (int n = 0; n < 40; ++n) {
    const double next = ((2.0 + viscosity) * now - before) / (1.0 + viscosity + stiffness);
    before = now;
    now = next;
    world.step();
    ASSERT_NEAR(world.position(1).x(), now, 1e-14) << n;
  }
}

TEST(ImplicitEuler, SolvesANetworkAsDenseAlgebraDoes) {
  NetworkDescription scene = free_cluster(30, 80, 0.5, 1);
  for (Link& link : scene.links) link.stiffness *= 1e6;
  scene.mats[7] = fixed(scene.mats[7].position);
  scene.medium_viscosity = 0.3;
  const auto count = static_cast<Eigen::Index>(scene.mats.size());
  const double dt = scene.step;
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(count, count);
  Eigen::VectorXd push = Eigen::VectorXd::Zero(count);
  const auto velocity = [&](std::uint32_t i) { return scene.mats[i].velocity.x(); };
  for (const Link& link : scene.links) {
    const double weight = dt * link.viscosity + dt * dt * link.stiffness;
    const auto a = static_cast<Eigen::Index>(link.mat_a);
    const auto b = static_cast<Eigen::Index>(link.mat_b);
    matrix(a, a) += weight;
    matrix(b, b) += weight;
    matrix(a, b) -= weight;
    matrix(b, a) -= weight;
    const double apart = scene.mats[link.mat_b].position.x() - scene.mats[link.mat_a].position.x();
    const double speed = velocity(link.mat_b) - velocity(link.mat_a);
    const double tension =
        link.stiffness * (apart - link.rest_length + dt * speed) + link.viscosity * speed;
    push[a] += dt * tension;
    push[b] -= dt * tension;
  }
  for (std::uint32_t i = 0; i < scene.mats.size(); ++i) {
    matrix(i, i) += scene.mats[i].kind == MatKind::kMass
                        ? scene.mats[i].mass + dt * scene.medium_viscosity
                        : 1e300;
    push[i] -= dt * scene.medium_viscosity * velocity(i);
  }
  const Eigen::VectorXd change = matrix.ldlt().solve(push);

  World world = make_world(by_implicit(scene));
  world.step();

  for (std::uint32_t i = 0; i < scene.mats.size(); ++i) {
    const double expected = i == 7 ? 0.0 : velocity(i) + change[i];
    EXPECT_NEAR(world.velocity(i).x(), expected, 1e-8) << i;
  }
}

TEST(ImplicitEuler, LetsACableFallAtStepsWhereExplicitOnesDiverge) {
  const double step = 2e-3;  // 20 times the limit of 0.1 ms
  World explicit_world = make_world(cable(1e6, step));
  run(explicit_world, 500);
  World world = make_world(by_implicit(cable(1e6, step)));
  double longest = 0.0;
  for (int n = 0; n < 2000; ++n) {
    world.step();
    for (std::uint32_t i = 1; i < 60; ++i) {
      longest = std::max(longest, (world.position(i) - world.position(i - 1)).norm());
    }
  }

  EXPECT_FALSE(std::abs(explicit_world.position(59).z()) < 1e6);
  EXPECT_LT(longest, 0.0105);                        // the cable does not give way
  EXPECT_NEAR(world.position(59).z(), -0.59, 1e-3);  // and hangs at last
  EXPECT_LT(world.energy().residual(), 0.0);         // the scheme takes energy, never gives it
}

TEST(ImplicitEuler, IsOfFirstOrder) {
  const auto end = [](double step) {
    World world = make_world(by_implicit(cable(1e3, step)));
    run(world, static_cast<int>(std::lround(0.1 / step)));
    return Vec3(world.position(30));
  };

  const Vec3 coarse = end(1e-3);
  const Vec3 middle = end(5e-4);
  const Vec3 fine = end(2.5e-4);

  EXPECT_NEAR(std::log2((coarse - middle).norm() / (middle - fine).norm()), 1.0, 0.2);
}

/// A mass that circles a fixed point by this angle in a step, on a spring with a damper.
NetworkDescription circling(double stiffness, double viscosity, double angle, bool with_states) {
  constexpr double kStep = 0.01;
  NetworkDescription scene;
  scene.dimension = 2;
  scene.step = kStep;
  scene.mats = {fixed(Vec3::Zero()), mass(1.0, Vec3(0.1, 0, 0), Vec3(0, 0.1 * angle / kStep, 0))};
  const double whole = stiffness / (kStep * kStep);
  if (!with_states) {
    scene.links = {{0, 1, whole, viscosity / kStep, 0.1}};
  } else {
    scene.state_machines.emplace_back();
    scene.state_machines[0].states.emplace_back();
    scene.state_machines[0].states[0].stiffness = whole;
    scene.state_machines[0].states[0].viscosity = viscosity / kStep;
    scene.state_links = {{0, 1, 0, 0.1}};
  }
  return by_implicit(scene);
}

/// A damper that turns takes nothing while its length stays.
TEST(ImplicitEuler, EntersNoLossThatADamperOnlySeemsToHaveWhileItTurns) {
  for (const bool with_states : {false, true}) {
    for (const double stiffness : {0.1, 0.7, 30.0}) {
      for (const double viscosity : {0.1, 0.7, 50.0}) {
        if (with_states && stiffness + 2.0 * viscosity > 3.0) continue;  // it would diverge
        for (const double angle : {0.05, 0.2}) {
          SCOPED_TRACE(testing::Message() << "K' " << stiffness << " Z' " << viscosity << " angle "
                                          << angle << " states " << with_states);
          World world = make_world(circling(stiffness, viscosity, angle, with_states));
          double most = 0.0;
          for (int n = 0; n < 5000; ++n) {
            world.step();
            most = std::max(most, world.energy().integration_error() / world.energy().largest);
          }
          // the first step leaves the circle, and stretches the spring by angle^2 / 2 of its length
          const double stretched = stiffness * angle * angle / 4.0;
          // what is not solved sees the way of the last period
          const double late = with_states ? 4.0 * angle * angle : 1e-4;
          EXPECT_LT(most, 1.1 * stretched + late);
        }
      }
    }
  }
}

TEST(ImplicitEuler, KeepsMomentumUnderInnerForces) {
  NetworkDescription scene = free_cluster(50, 203, 3.0);
  for (Link& link : scene.links) link.stiffness *= 1e4;
  World world = make_world(by_implicit(scene));
  const Vec3 momentum = world.momentum();

  run(world, 1000);

  EXPECT_LT((world.momentum() - momentum).norm(), 1e-9);  // rounding, times K' of 1e2
}

// m = 1 and dt = 1: then K is K'.
TEST(ImplicitEuler, LeavesTheLimitOfStatesAsItIsAndLaterByWhatIsImplicit) {
  // 4 M + dt^2 K1 + 2 dt Z1 - dt^2 K2 - 2 dt Z2 > 0
  for (const double linear : {0.0, 10.0}) {
    for (const double side : {0.98, 1.02}) {
      NetworkDescription scene = oscillator(1.0, linear, 0.5, 1.0, 0.0, 1.0);
      if (linear == 0.0) scene.links.clear();
      const double stiffness = linear == 0.0 ? 4.0 : 4.0 + linear + 2.0 * 0.5;
      scene.state_machines.push_back(Behaving().state(side * stiffness).state_machine);
      scene.state_links = {{0, 1, 0, 0.0}};
      World world = make_world(by_implicit(scene));
      double largest = 0.0;
      for (int n = 0; n < 5000 && largest < 1e50; ++n) {
        world.step();
        largest = std::max(largest, std::abs(world.position(1).x()));
      }
      EXPECT_TRUE(side < 1.0 ? largest < 100.0 : largest > 1e3) << linear << ' ' << largest;
    }
  }
}

TEST(ImplicitEuler, GoesOnFromASnapshotBitForBitAndAllocatesNothing) {
  World first = make_world(by_implicit(cable(1e5, 1e-3)));
  {
    const AllocationGuard guard;
    run(first, 37);
    EXPECT_EQ(guard.count(), 0u);
  }
  World second = make_world(by_implicit(cable(1e5, 1e-3)));
  second.restore(first.snapshot());
  run(first, 50);
  run(second, 50);

  EXPECT_EQ(first.state_hash(), second.state_hash());
  EXPECT_EQ(first.energy().residual(), second.energy().residual());
}

TEST(ImplicitEuler, GivesAPortTheForceOfItsLinks) {
  NetworkDescription scene = oscillator(0.1, 1e5, 1.0, 0.0, 0.0, 1e-3);
  scene.mats[0] = port(Vec3::Zero());
  World world = make_world(by_implicit(scene));
  for (int n = 1; n <= 200; ++n) {
    world.impose_position(0, Vec3(1e-4 * n, 0, 0));  // 0.1 m/s
    world.step();
  }

  EXPECT_NEAR(world.velocity(1).x(), 0.1, 1e-3);
  EXPECT_NEAR(world.energy().kinetic, 0.5 * 0.1 * 0.01, 1e-5);
}

/// Two masses in 2 dimensions, each on a spring of its own.
NetworkDescription two_apart() {
  NetworkDescription scene;
  scene.dimension = 2;
  scene.step = 1e-3;
  for (std::uint32_t i = 0; i < 2; ++i) {
    const Vec3 anchor(10.0 * i, 0, 0);
    scene.mats.push_back(fixed(anchor));
    scene.mats.push_back(mass(0.01, anchor + Vec3(0.1, 0.02, 0)));
    scene.links.push_back({2 * i, 2 * i + 1, 1e5, 0.1, 0.09});
  }
  return scene;
}

TEST(ImplicitEuler, KeepsWhatIsNotJoinedToAMassThatIsNoLongerFinite) {
  for (const std::uint32_t lost : {1U, 3U}) {
    const std::uint32_t other = 4 - lost;
    World sound = make_world(by_implicit(two_apart()));
    World world = make_world(by_implicit(two_apart()));
    world.set_external_force(lost, Vec3(1e308, 0, 0));
    run(sound, 100);
    run(world, 50);
    ASSERT_FALSE(world.position(lost).allFinite());
    World restored = make_world(by_implicit(two_apart()));
    restored.restore(world.snapshot());
    run(world, 50);
    run(restored, 50);

    EXPECT_EQ(world.position(other), sound.position(other)) << lost;
    EXPECT_EQ(restored.position(other), sound.position(other)) << lost;
  }
}

}  // namespace
}  // namespace cordis::test
