// tests/engine/symplectic4_test.cpp -- the fourth order, for scenes that conserve their energy.
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "tests/engine/many_states.h"
#include "tests/engine/scenes.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/reference_data.h"

namespace cordis::test {
namespace {

using engine::IntegratorKind;

NetworkDescription by_symplectic4(NetworkDescription scene) {
  scene.integrator = IntegratorKind::kSymplectic4;
  return scene;
}

double excursion_by_symplectic4(double stiffness) {
  return largest_excursion(by_symplectic4(oscillator(1.0, stiffness, 0.0, 1.0, 0.0, 1.0)));
}

TEST(Symplectic4, FollowsTheExactMotionWithTheFourthOrder) {
  const nlohmann::json problem = reference("R01_damped_oscillator");
  const auto& params = problem["params"];
  const auto& rows = problem["cases"][0]["t_x_v"];
  ASSERT_EQ(problem["cases"][0]["name"], "undamped");
  const auto largest_error = [&](double step) {
    World world =
        make_world(by_symplectic4(oscillator(number(params["m"]), number(params["k"]), 0.0,
                                             number(params["x0"]), number(params["v0"]), step)));
    double largest = 0.0;
    for (const auto& row : rows) {
      const int n = static_cast<int>(std::lround(number(row[0]) / step));
      run(world, n - static_cast<int>(world.step_count()));
      largest = std::max(largest, std::abs(world.position(1).x() - number(row[1])));
      largest = std::max(largest, std::abs(world.velocity(1).x() - number(row[2])));
    }
    return largest;
  };

  const double coarse = largest_error(0.05);
  const double fine = largest_error(0.025);

  EXPECT_LT(coarse, 2e-7);
  EXPECT_NEAR(std::log2(coarse / fine), 4.0, 0.1);
}

TEST(Symplectic4, IsOfTheFourthOrderForANetInSpaceWithALaw) {
  const auto end = [](double step) {
    NetworkDescription scene = string_in_space(6, 0.0, step);
    scene.gravity = Vec3(0, 0, -9.81);
    scene.state_machines.push_back(Behaving().state(50.0).state_machine);
    scene.state_machines[0].states[0].elasticity = power_law(1e5, 3.0);
    scene.state_links = {{0, 4, 0, 0.04}, {2, 6, 0, 0.04}};
    World world = make_world(by_symplectic4(scene));
    run(world, static_cast<int>(std::lround(0.02 / step)));
    return Vec3(world.position(3));
  };

  const Vec3 coarse = end(4e-4);
  const Vec3 middle = end(2e-4);
  const Vec3 fine = end(1e-4);

  EXPECT_NEAR(std::log2((coarse - middle).norm() / (middle - fine).norm()), 4.0, 0.3);
}

TEST(Symplectic4, LosesNoEnergyWhereRoundingIsAllThatIsLeft) {
  World world = make_world(by_symplectic4(string_in_space(20, 0.0, 1e-4)));
  double largest = 0.0;
  for (int n = 0; n < 20000; ++n) {
    world.step();
    largest = std::max(largest, std::abs(world.energy().residual()));
  }

  EXPECT_LT(largest, 1e-7 * world.energy().largest);  // `cordis` and `leapfrog`: 1e-3 of it
}

TEST(Symplectic4, KeepsMomentumAndAngularMomentum) {
  World world = make_world(by_symplectic4(free_cluster(50, 203, 0.0)));
  const Vec3 momentum = world.momentum();
  const Vec3 angular = world.angular_momentum();

  run(world, 5000);

  EXPECT_LT((world.momentum() - momentum).norm(), 5e-11);
  EXPECT_LT((world.angular_momentum() - angular).norm(), 5e-11);
}

TEST(Symplectic4, IsStableUpToItsLimitResonatesThereAndEndsBeyond) {
  // m = 1 and dt = 1: the root of K is w dt
  EXPECT_LT(excursion_by_symplectic4(3.16 * 3.16), 100.0);
  EXPECT_GT(excursion_by_symplectic4(3.166 * 3.166), 1e3);  // 0.24 % a step
  EXPECT_LT(excursion_by_symplectic4(5.02 * 5.02), 100.0);
  EXPECT_GT(excursion_by_symplectic4(5.04 * 5.04), 1e20);
}

TEST(Symplectic4, CountsTheWorkOfAForceFromOutside) {
  NetworkDescription scene;
  scene.step = 0.01;
  scene.mats = {mass(2.0, Vec3::Zero(), Vec3(1, 0, 0))};
  World world = make_world(by_symplectic4(scene));
  world.set_external_force(0, Vec3(3, 0, 0));
  run(world, 100);

  // v = 1 + 1.5 t, x = t + 0.75 t^2
  EXPECT_NEAR(world.velocity(0).x(), 2.5, 1e-12);
  EXPECT_NEAR(world.energy().port_work, 3.0 * 1.75, 1e-12);
  EXPECT_NEAR(world.energy().residual(), 0.0, 1e-12);
}

TEST(Symplectic4, RefusesWhatDoesNotConserveTheEnergy) {
  const auto refusal = [](const NetworkDescription& scene) -> std::string {
    try {
      const World world = make_world(by_symplectic4(scene));
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  const std::string start = "the integrator symplectic4 does not take ";
  NetworkDescription scene = free_cluster(3, 3, 0.0);
  EXPECT_EQ(refusal(scene), "");
  EXPECT_EQ(refusal(free_cluster(3, 3, 0.1)), start + "viscosity");
  NetworkDescription in_medium = scene;
  in_medium.medium_viscosity = 0.1;
  EXPECT_EQ(refusal(in_medium), start + "viscosity");
  NetworkDescription with_port = scene;
  with_port.mats.push_back(port(Vec3::Zero()));
  EXPECT_EQ(refusal(with_port), start + "a port with the role mass");
  NetworkDescription with_maxwell = scene;
  with_maxwell.maxwell_links = {{0, 1, 1.0, 1.0}};
  EXPECT_EQ(refusal(with_maxwell), start + "viscosity");
  NetworkDescription with_states = network_of_many_states(3);
  with_states.links.clear();
  with_states.medium_viscosity = 0.0;
  with_states.mats.back() = fixed(Vec3::Zero());
  EXPECT_EQ(refusal(with_states), start + "states");
}

TEST(Symplectic4, GoesOnFromASnapshotBitForBitAndAllocatesNothing) {
  World first = make_world(by_symplectic4(string_in_space(20, 0.0, 1e-4)));
  {
    const AllocationGuard guard;
    run(first, 37);
    EXPECT_EQ(guard.count(), 0u);
  }
  World second = make_world(by_symplectic4(string_in_space(20, 0.0, 1e-4)));
  second.restore(first.snapshot());
  run(first, 50);
  run(second, 50);

  EXPECT_EQ(first.state_hash(), second.state_hash());
  EXPECT_EQ(first.energy().residual(), second.energy().residual());
}

TEST(Symplectic4, StepsToTheSameBitsOnEveryWidth) {
  NetworkDescription scene = by_symplectic4(free_cluster(40, 157, 0.0));
  World narrow = make_world(scene, VectorWidth::kSse2);
  run(narrow, 200);
  for (const VectorWidth width : engine::supported_vector_widths()) {
    World world = make_world(scene, width);
    run(world, 200);
    EXPECT_EQ(world.state_hash(), narrow.state_hash()) << engine::to_string(width);
  }
}

}  // namespace
}  // namespace cordis::test
