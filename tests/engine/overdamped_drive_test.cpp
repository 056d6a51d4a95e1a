// tests/engine/overdamped_drive_test.cpp -- heavy dampers of `leapfrog` beside driven matter.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "sim_node/engine/integrators/integrator_limits.h"
#include "sim_node/engine/integrators/stiff_friction.h"
#include "tests/engine/many_states.h"
#include "tests/engine/programs.h"
#include "tests/engine/scenes.h"

namespace cordis::test {
namespace {

using engine::Energy;
using engine::IntegratorKind;
using engine::TimeFunction;

constexpr double kDragSwing = 0.01;  // m
constexpr double kDragPulse = 6.0;   // rad/s
constexpr double kDraggedStiffness = 2e4;

Term drag_angle() {
  return Term(kDragPulse) * q(Quantity::kAge);
}
/// 1 - cos: it begins at rest.
Term risen() {
  return Term(1.0) - one(Operation::kCos, drag_angle());
}

void follow(NetworkDescription& scene, std::uint32_t mat, const std::vector<Term>& way) {
  TimeFunction function;
  for (std::size_t axis = 0; axis < way.size(); ++axis) function.formula[axis] = way[axis].program;
  drive_mat(scene, mat, std::move(function));
}

/// A mass of 1 kg on a spring to a wall, pulled by a damper whose other end is driven; Z' at 1 ms.
NetworkDescription dragged_mass(double viscosity, double step) {
  NetworkDescription scene;
  scene.dimension = 1;
  scene.step = step;
  scene.integrator = IntegratorKind::kLeapfrog;
  scene.mats = {fixed(Vec3::Zero()), fixed(Vec3::Zero()), mass(1.0, Vec3::Zero())};
  scene.links = {{1, 2, 0.0, 1e3 * viscosity, 0.0}, {0, 2, kDraggedStiffness, 0.0, 0.0}};
  follow(scene, 1, {Term(kDragSwing) * risen()});
  return scene;
}

Vec3 place_1d(double time) {
  return {kDragSwing * (1.0 - std::cos(kDragPulse * time)), 0.0, 0.0};
}

/// What follows a motion exactly, of one mass of 1 kg: by classical Runge-Kutta at a small step.
struct Follower {
  using Force = std::function<Vec3(double time, const Vec3& x, const Vec3& v)>;
  Force force;
  Vec3 x;
  Vec3 v = Vec3::Zero();
  double time = 0.0;

  void advance(double step, int parts) {
    const double h = step / parts;
    for (int i = 0; i < parts; ++i, time += h) {
      const Vec3 a1 = force(time, x, v);
      const Vec3 v2 = v + 0.5 * h * a1;
      const Vec3 a2 = force(time + 0.5 * h, x + 0.5 * h * v, v2);
      const Vec3 v3 = v + 0.5 * h * a2;
      const Vec3 a3 = force(time + 0.5 * h, x + 0.5 * h * v2, v3);
      const Vec3 v4 = v + h * a3;
      const Vec3 a4 = force(time + h, x + h * v3, v4);
      x += h / 6.0 * (v + 2.0 * v2 + 2.0 * v3 + v4);
      v += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
    }
  }
};

/// The largest error of MAT 2 from 50 ms on, over its largest excursion.
double dragged_error_of(const NetworkDescription& scene, const Follower::Force& force,
                        double viscosity, double seconds) {
  World world = make_world(scene);
  const Vec3 start = scene.mats[2].position;
  Follower exact{force, start};
  const int parts = std::max(1, static_cast<int>(std::ceil(viscosity * 1e3 * scene.step)));
  double error = 0.0;
  double excursion = 0.0;
  const int steps = static_cast<int>(std::lround(seconds / scene.step));
  for (int n = 1; n <= steps; ++n) {
    world.step();
    exact.advance(scene.step, parts);
    excursion = std::max(excursion, (exact.x - start).norm());
    if (n * scene.step >= 0.05) error = std::max(error, (world.position(2) - exact.x).norm());
  }
  return error / excursion;
}

/// The error at 1 kHz, and by what it is more than at 2 kHz.
struct DraggedOrder {
  double error;
  double ratio;
};

DraggedOrder dragged_order_of(const std::function<NetworkDescription(double step)>& scene,
                              const Follower::Force& force, double viscosity) {
  const double coarse = dragged_error_of(scene(1e-3), force, viscosity, 0.5);
  const double fine = dragged_error_of(scene(5e-4), force, viscosity, 0.5);
  std::printf("Z' %5g  %.2e  %.2e  ratio %.2f\n", viscosity, coarse, fine, coarse / fine);
  return {coarse, coarse / fine};
}

Vec3 velocity_1d(double time) {
  return {kDragSwing * kDragPulse * std::sin(kDragPulse * time), 0.0, 0.0};
}

TEST(OverdampedDrive, DragsAMassToSecondOrder) {
  for (const double viscosity : {1.0, 10.0, 100.0}) {
    const auto scene = [&](double step) { return dragged_mass(viscosity, step); };
    ASSERT_TRUE(engine::damps_implicitly(scene(5e-4)));
    const auto force = [&](double time, const Vec3& x, const Vec3& v) {
      return Vec3(1e3 * viscosity * (velocity_1d(time) - v) - kDraggedStiffness * x);
    };
    const DraggedOrder order = dragged_order_of(scene, force, viscosity);
    EXPECT_LT(order.error, 2e-5) << viscosity;
    EXPECT_GT(order.ratio, 3.3) << viscosity;
  }
}

/// Where the driven end is: on a circle about (0.3, 0.2) m.
Vec3 place_2d(double time) {
  return {0.3 + 0.1 * std::sin(kDragPulse * time), 0.2 + 0.1 * (1.0 - std::cos(kDragPulse * time)),
          0.0};
}
Vec3 velocity_2d(double time) {
  return 0.1 * kDragPulse * Vec3(std::cos(kDragPulse * time), std::sin(kDragPulse * time), 0.0);
}

/// A mass in a plane between two springs, and a damper to an end on a circle: it turns.
NetworkDescription circled_mass(double viscosity, double step) {
  NetworkDescription scene;
  scene.dimension = 2;
  scene.step = step;
  scene.integrator = IntegratorKind::kLeapfrog;
  scene.mats = {fixed(Vec3(0.1, 0, 0)), fixed(Vec3(0.3, 0.2, 0)), mass(1.0, Vec3::Zero()),
                fixed(Vec3(0, 0.1, 0))};
  scene.links = {{1, 2, 0.0, 1e3 * viscosity, 0.0},
                 {0, 2, kDraggedStiffness, 0.0, 0.1},
                 {3, 2, kDraggedStiffness, 0.0, 0.1}};
  follow(scene, 1, {Term(0.1) * one(Operation::kSin, drag_angle()), Term(0.1) * risen()});
  return scene;
}

TEST(OverdampedDrive, DragsAMassInAPlaneToSecondOrder) {
  for (const double viscosity : {1.0, 10.0, 100.0}) {
    const auto scene = [&](double step) { return circled_mass(viscosity, step); };
    ASSERT_TRUE(engine::damps_implicitly(scene(5e-4)));
    const auto spring_force = [](const Vec3& from, const Vec3& x) {
      const Vec3 way = from - x;
      return Vec3(kDraggedStiffness * (way.norm() - 0.1) * way / way.norm());
    };
    const auto force = [&](double time, const Vec3& x, const Vec3& v) {
      const Vec3 axis = (place_2d(time) - x).normalized();
      return Vec3(1e3 * viscosity * axis.dot(velocity_2d(time) - v) * axis +
                  spring_force(Vec3(0.1, 0, 0), x) + spring_force(Vec3(0, 0.1, 0), x));
    };
    const DraggedOrder order = dragged_order_of(scene, force, viscosity);
    EXPECT_LT(order.error, 2e-4) << viscosity;
    EXPECT_GT(order.ratio, 3.3) << viscosity;
  }
}

/// Links whose states are dampers of Z' = 3 join the mass to the wall and to its driven end.
NetworkDescription with_solved_links(NetworkDescription scene) {
  engine::LinkState state;
  state.viscosity = 3e3;
  scene.state_machines = {Behaving().state(state).state_machine};
  scene.state_links = {{0, 2, 0, 0.0}, {1, 2, 0, 0.0}};
  return scene;
}

TEST(OverdampedDrive, DragsAMassBesideSolvedFriction) {
  for (const double viscosity : {1.0, 10.0, 100.0}) {
    const auto scene = [&](double step) {
      return with_solved_links(dragged_mass(viscosity, step));
    };
    ASSERT_TRUE(engine::solves_stiff_friction(scene(5e-4)));
    const auto force = [&](double time, const Vec3& x, const Vec3& v) {
      return Vec3(1e3 * viscosity * (velocity_1d(time) - v) + 3e3 * (velocity_1d(time) - 2.0 * v) -
                  kDraggedStiffness * x);
    };
    const DraggedOrder order = dragged_order_of(scene, force, viscosity + 6.0);
    EXPECT_LT(order.error, 6e-4) << viscosity;
  }
}

/// Errors of the account in 0.5 s, over the largest energy.
struct DraggedErrors {
  double port_work = 0.0;
  double dissipated = 0.0;
  double integration = 0.0;
};

DraggedErrors dragged_errors_of(double viscosity, double step) {
  const NetworkDescription scene = dragged_mass(viscosity, step);
  const double z = 1e3 * viscosity;
  World world = make_world(scene);
  double work = 0.0;
  double taken = 0.0;
  Follower exact{[&](double time, const Vec3& x, const Vec3& v) {
                   return Vec3(z * (velocity_1d(time) - v) - kDraggedStiffness * x);
                 },
                 Vec3::Zero()};
  DraggedErrors worst;
  double largest = 0.0;
  const int steps = static_cast<int>(std::lround(0.5 / step));
  const int parts = 2 * std::max(1, static_cast<int>(std::ceil(z * step)));
  const auto powers = [&] {
    const double across = (velocity_1d(exact.time) - exact.v).x();
    return std::array{z * across * velocity_1d(exact.time).x(), z * across * across};
  };
  for (int n = 0; n <= steps; ++n) {
    for (int part = 0; n > 0 && part < parts; ++part) {
      const auto before = powers();
      exact.advance(step / parts, 1);
      const auto after = powers();
      work += 0.5 * step / parts * (before[0] + after[0]);
      taken += 0.5 * step / parts * (before[1] + after[1]);
    }
    world.step();  // the account is that of the last forces, of x(n)
    const Energy energy = world.energy();
    largest = std::max(largest, energy.largest);
    worst.port_work = std::max(worst.port_work, std::abs(energy.port_work - work));
    worst.dissipated = std::max(worst.dissipated, std::abs(energy.dissipated - taken));
    worst.integration = std::max(worst.integration, std::abs(energy.integration_error()));
  }
  return {worst.port_work / largest, worst.dissipated / largest, worst.integration / largest};
}

TEST(OverdampedDrive, AccountsForTheWorkOfTheDrivenEnd) {
  for (const double viscosity : {1.0, 10.0, 100.0}) {
    const DraggedErrors coarse = dragged_errors_of(viscosity, 1e-3);
    const DraggedErrors fine = dragged_errors_of(viscosity, 5e-4);
    std::printf("Z' %5g  work %.1e %.1e  taken %.1e %.1e  integration %.1e %.1e\n", viscosity,
                coarse.port_work, fine.port_work, coarse.dissipated, fine.dissipated,
                coarse.integration, fine.integration);
    EXPECT_LT(coarse.port_work, 2e-5) << viscosity;
    EXPECT_LT(coarse.dissipated, 2e-5) << viscosity;
    EXPECT_LT(coarse.integration, 2e-5) << viscosity;
    EXPECT_GT(coarse.port_work / fine.port_work, 3.3) << viscosity;
  }
}

/// A chain of masses on dampers alone, with a driven end: nothing but the work of dampers can be wrong.
TEST(OverdampedDrive, ClosesTheAccountOfDampersToRounding) {
  NetworkDescription scene = cluster_on_dampers(fixed(Vec3(0.5, 0.5, 0.5)));
  follow(scene, 30,
         {Term(0.1) * one(Operation::kSin, drag_angle()), Term(0.1) * risen(), Term(0.0)});
  ASSERT_TRUE(engine::damps_implicitly(scene));
  World world = make_world(scene);
  for (int n = 0; n < 500; ++n) {
    world.step();
    const Energy energy = world.energy();
    ASSERT_LT(std::abs(energy.residual()), 1e-12 * energy.largest) << n;
  }
  EXPECT_GT(world.energy().dissipated, 1e-3);
  EXPECT_GT(world.energy().port_work, 1e-3);
}

/// A port that is moved as a drive moves matter, but from outside: its next place is not known.
TEST(OverdampedDrive, LeavesPortsThatAreMovedFromOutsideAsTheyWere) {
  NetworkDescription scene = dragged_mass(10.0, 1e-3);
  scene.drives.clear();
  scene.time_functions.clear();
  World world = make_world(scene);
  Follower exact{[&](double time, const Vec3& x, const Vec3& v) {
                   return Vec3(1e4 * (velocity_1d(time) - v) - kDraggedStiffness * x);
                 },
                 Vec3::Zero()};
  double error = 0.0;
  for (int n = 0; n < 500; ++n) {
    world.impose_position(1, place_1d(n * scene.step));
    world.step();
    exact.advance(scene.step, 20);
    error = std::max(error, std::abs(world.position(2).x() - exact.x.x()));
  }
  EXPECT_LT(error, 0.01 * kDragSwing);
}

}  // namespace
}  // namespace cordis::test
