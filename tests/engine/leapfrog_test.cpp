// tests/engine/leapfrog_test.cpp -- dampers of second order, whatever their viscosity.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "tests/engine/many_states.h"
#include "tests/engine/scenes.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/reference_data.h"
#include "tests/support/rounds.h"

namespace cordis::test {
namespace {

using engine::Energy;
using engine::IntegratorKind;

NetworkDescription by_leapfrog(NetworkDescription scene) {
  scene.integrator = IntegratorKind::kLeapfrog;
  return scene;
}

double excursion_by_leapfrog(NetworkDescription scene) {
  return largest_excursion(by_leapfrog(std::move(scene)));
}

struct Regime {
  std::string name;
  double bound;  // of the position error [m] with a step of 1 ms
};

class LeapfrogOscillator : public testing::TestWithParam<Regime> {};

TEST_P(LeapfrogOscillator, ConvergesToTheExactMotionWithTheSecondOrder) {
  const nlohmann::json problem = reference("R01_damped_oscillator");
  const auto regime =
      std::find_if(problem["cases"].begin(), problem["cases"].end(),
                   [](const auto& entry) { return entry["name"] == GetParam().name; });
  ASSERT_NE(regime, problem["cases"].end());
  const auto& params = problem["params"];
  const auto largest_error = [&](double step) {
    World world = make_world(
        by_leapfrog(oscillator(number(params["m"]), number(params["k"]), number((*regime)["z"]),
                               number(params["x0"]), number(params["v0"]), step)));
    double largest = 0.0;
    for (const auto& row : (*regime)["t_x_v"]) {
      const int n = static_cast<int>(std::lround(number(row[0]) / step));
      run(world, n - static_cast<int>(world.step_count()));
      largest = std::max(largest, std::abs(world.position(1).x() - number(row[1])));
      EXPECT_NEAR(world.velocity(1).x(), number(row[2]), 100.0 * GetParam().bound);
    }
    return largest;
  };

  const double coarse = largest_error(1e-3);
  const double fine = largest_error(5e-4);

  EXPECT_LT(coarse, GetParam().bound);
  EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.1);
}

// `cordis` needs bounds of 5e-6, 2.5e-5, 5e-5 and 5e-4 m here.
INSTANTIATE_TEST_SUITE_P(Regimes, LeapfrogOscillator,
                         testing::Values(Regime{"undamped", 1.9e-7}, Regime{"light", 1.9e-7},
                                         Regime{"zeta=0.5", 1.9e-7}, Regime{"critical", 1.9e-7},
                                         Regime{"overdamped", 2e-6}));

// Two masses that fly round each other on a damper, in a medium: what a damper sees turns with it.
class LeapfrogInSpace : public testing::TestWithParam<double> {};  // viscosity of the link

TEST_P(LeapfrogInSpace, IsOfSecondOrderWhereDampersTurn) {
  const auto end = [](double step) {
    NetworkDescription scene;
    scene.dimension = 2;
    scene.step = step;
    scene.medium_viscosity = 0.05;
    scene.gravity = Vec3(0, -1, 0);
    scene.mats = {mass(0.1, Vec3(0, 0, 0), Vec3(0, -0.5, 0)),
                  mass(0.3, Vec3(0.2, 0, 0), Vec3(0, 1.5, 0))};
    scene.links = {{0, 1, 20.0, GetParam(), 0.15}};
    World world = make_world(by_leapfrog(scene));
    run(world, static_cast<int>(std::lround(0.4 / step)));
    return Vec3(world.position(1));
  };

  const Vec3 coarse = end(1e-3);
  const Vec3 middle = end(5e-4);
  const Vec3 fine = end(2.5e-4);

  EXPECT_NEAR(std::log2((coarse - middle).norm() / (middle - fine).norm()), 2.0, 0.15);
}

INSTANTIATE_TEST_SUITE_P(ExtrapolatedAndImplicit, LeapfrogInSpace, testing::Values(0.3, 100.0));

// A chain of three masses on heavy dampers, Z' = 40 at 1 ms, thrown up and falling. The reference is Runge and
// Kutta's method of order 4 at 5 us.
TEST(LeapfrogImplicitDamping, IsOfSecondOrderWhereAChainOfHeavyDampersTurns) {
  const Vec3 exact(-0.08853866151797887, 0.10119397163411298, 0);
  const auto error = [&](double step) {
    NetworkDescription scene;
    scene.dimension = 2;
    scene.step = step;
    scene.gravity = Vec3(0, -9.81, 0);
    scene.mats = {fixed(Vec3::Zero())};
    for (std::uint32_t i = 1; i <= 3; ++i) {
      scene.mats.push_back(mass(1e-3, Vec3(0.1 * i, 0, 0), Vec3(0, 2, 0)));
      scene.links.push_back({i - 1, i, 300.0, 20.0, 0.1});
    }
    World world = make_world(by_leapfrog(scene));
    run(world, static_cast<int>(std::lround(1.0 / step)));
    return Vec3(world.position(3) - exact).norm();
  };
  EXPECT_LT(error(1e-3), 0.01);
  const double at_4_khz = error(2.5e-4);
  EXPECT_LT(at_4_khz, 8e-4);
  EXPECT_NEAR(std::log2(at_4_khz / error(6.25e-5)), 4.0, 0.4);
}

/// What goes round on one damper keeps its distance, however heavy the damper is and far a step goes. Angular
/// momentum is kept to rounding.
TEST(LeapfrogImplicitDamping, KeepsTheLengthOfADamperThatTurns) {
  for (const double turn : {0.01, 0.1, 0.5}) {  // [rad] in a step
    for (const double viscosity : {1e2, 1e5}) {
      NetworkDescription scene;
      scene.dimension = 3;
      scene.step = 1.0;
      scene.mats = {mass(1.0, Vec3(0, 0, 0), Vec3(0, -0.1 * turn, 0)),
                    mass(1.0, Vec3(0.2, 0, 0), Vec3(0, 0.1 * turn, 0))};
      scene.links = {{0, 1, 1.0, viscosity, 0.2}};
      World world = make_world(by_leapfrog(scene));
      const auto apart = [&] { return Vec3(world.position(1) - world.position(0)); };
      double farthest = 0.0;
      Vec3 before = apart();
      double swept = 0.0;
      for (int n = 0; n < 2000; ++n) {
        before = apart();
        world.step();
        farthest = std::max(farthest, std::abs(apart().norm() - 0.2));
        const double area = before.cross(apart()).z();
        if (n > 0) {
          EXPECT_NEAR(area, swept, 1e-16 * viscosity);
        }
        swept = area;
      }
      // The centrifugal force of one turn stretches the spring, K' = 2.
      EXPECT_LT(farthest, 0.2 * turn * turn);
    }
  }
}

/// Where a mass of 1 kg on dampers to fixed points comes to under a force, without inertia.
Vec3 crept(const std::vector<Vec3>& ends, double viscosity, const Vec3& force, double time) {
  const auto velocity = [&](const Vec3& place) {
    Eigen::Matrix2d z = Eigen::Matrix2d::Zero();
    for (const Vec3& end : ends) {
      const Eigen::Vector2d along = (end - place).head<2>().normalized();
      z += viscosity * along * along.transpose();
    }
    Vec3 found = Vec3::Zero();
    found.head<2>() = z.inverse() * force.head<2>();
    return found;
  };
  constexpr int kSteps = 4000;
  const double h = time / kSteps;
  Vec3 place = Vec3::Zero();
  for (int n = 0; n < kSteps; ++n) {
    const Vec3 k1 = velocity(place);
    const Vec3 k2 = velocity(place + 0.5 * h * k1);
    const Vec3 k3 = velocity(place + 0.5 * h * k2);
    const Vec3 k4 = velocity(place + h * k3);
    place += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
  }
  return place;
}

// Each damper takes away the kick of the other one. Z' is 100 at 1 kHz.
TEST(LeapfrogImplicitDamping, CreepsAsItShouldOnDampersAcrossEachOther) {
  const std::vector<std::vector<Vec3>> pairs = {{Vec3(0.1, 0, 0), Vec3(0, 0.1, 0)},
                                                {Vec3(0.1, 0.1, 0), Vec3(-0.1, 0.1, 0)},
                                                {Vec3(0.1, 0.05, 0), Vec3(-0.1, 0.05, 0)},
                                                {Vec3(0.1, 0.02, 0), Vec3(0.1, -0.02, 0)}};
  for (const std::vector<Vec3>& ends : pairs) {
    for (const Vec3& force : {Vec3(3000, 0, 0), Vec3(0, 3000, 0), Vec3(-2100, 2100, 0)}) {
      for (const double step : {1e-3, 5e-4, 2.5e-4}) {
        NetworkDescription scene;
        scene.dimension = 2;
        scene.step = step;
        scene.gravity = force;
        scene.mats = {mass(1.0, Vec3::Zero()), fixed(ends[0]), fixed(ends[1])};
        scene.links = {{0, 1, 0.0, 1e5, 0.0}, {0, 2, 0.0, 1e5, 0.0}};
        World world = make_world(by_leapfrog(scene));
        run(world, static_cast<int>(std::lround(0.05 / step)));
        const Vec3 exact = crept(ends, 1e5, force, 0.05);
        EXPECT_LT((world.position(0) - exact).norm(), 5e-3 * exact.norm())
            << ends[1].transpose() << " " << force.transpose() << " " << step;
      }
    }
  }
}

// Its links turn by up to 0.3 rad in a step, which is not certain.
TEST(LeapfrogImplicitDamping, HoldsTheEnergyOfAFastPairBesideAStiffSpring) {
  NetworkDescription scene;
  scene.dimension = 2;
  scene.step = 1e-3;
  scene.mats = {fixed(Vec3(0.02, 0.03, 0)), mass(1.2, Vec3(-0.052, 0.079, 0), Vec3(-8.5, -5.7, 0)),
                mass(7.8, Vec3(-0.045, -0.096, 0), Vec3(11.1, -4.9, 0))};
  scene.links = {{1, 2, 4.6e5, 6.1e3, 0.176}, {2, 0, 3.8e6, 0.0, 0.05}};
  World world = make_world(by_leapfrog(scene));
  const double at_start = world.energy().total();
  for (int n = 0; n < 5000; ++n) {
    world.step();
    ASSERT_LT(world.energy().total(), 1.2 * at_start) << n;
  }
}

TEST(LeapfrogImplicitDamping, IsOfSecondOrderOverDampersThatShareMasses) {
  const auto end = [](double step) {
    NetworkDescription scene;
    scene.dimension = 1;
    scene.step = step;
    scene.mats = {fixed(Vec3::Zero()), mass(1.0, Vec3(0.1, 0, 0)), mass(1.0, Vec3(0.2, 0, 0)),
                  mass(1.0, Vec3(0.3, 0, 0), Vec3(1, 0, 0))};
    scene.links = {{0, 1, 100.0, 42.0, 0.1}, {1, 2, 200.0, 90.0, 0.1}, {2, 3, 100.0, 40.0, 0.1}};
    World world = make_world(by_leapfrog(scene));
    run(world, static_cast<int>(std::lround(0.1 / step)));
    return world.position(1).x();
  };
  const double coarse = end(2.5e-3);
  const double middle = end(2e-3);
  const double fine = end(1.25e-3);                                             // Z' = 0.33
  const double expected = (2.5 * 2.5 - 2.0 * 2.0) / (2.0 * 2.0 - 1.25 * 1.25);  // 0.67 of first
  EXPECT_NEAR((coarse - middle) / (middle - fine), expected, 0.05);
}

// m = 1 and dt = 1: then K is K' and Z is Z'.
TEST(LeapfrogStability, EndsAtStiffnessPlusFourTimesTheExtrapolatedViscosityOfFour) {
  for (const double viscosity : {0.0, 0.1, 0.2, 0.3}) {
    const double limit = 4.0 - 4.0 * viscosity;

    EXPECT_LT(excursion_by_leapfrog(oscillator(1.0, 0.98 * limit, viscosity, 1.0, 0.0, 1.0)),
              100.0);
    EXPECT_GT(excursion_by_leapfrog(oscillator(1.0, 1.02 * limit, viscosity, 1.0, 0.0, 1.0)), 1e3);
  }
}

/// One mass on a pair of a set, which is always extrapolated.
NetworkDescription on_a_pair(double stiffness, double viscosity) {
  NetworkDescription scene = oscillator(1.0, 0.0, 0.0, 10.0, 0.0, 1.0);
  scene.links.clear();
  scene.mats[1].position.x() = 10.5;
  scene.state_machines.push_back(Behaving().state(stiffness, viscosity).state_machine);
  scene.sets = {{0, {0}, {1}, 1e300, 10.0}};
  return scene;
}

TEST(LeapfrogStability, OfSetsEndsAtFourTimesTheirViscosityHoweverLargeItIs) {
  for (const double viscosity : {0.5, 0.9}) {
    const double limit = 4.0 - 4.0 * viscosity;

    EXPECT_LT(excursion_by_leapfrog(on_a_pair(0.98 * limit, viscosity)), 12.0);
    EXPECT_GT(excursion_by_leapfrog(on_a_pair(1.02 * limit, viscosity)),
              15.0);  // through the other
  }
}

TEST(LeapfrogStability, OfStatesEndsAtAStiffnessOfFourOrOfTwiceTheirViscosity) {
  for (const double viscosity : {0.31, 1.0, 1.9, 3.0, 20.0}) {
    const double limit = std::max(4.0, 2.0 * viscosity);
    for (const double side : {0.98, 1.02}) {
      NetworkDescription scene = oscillator(1.0, 0.0, 0.0, 1.0, 0.0, 1.0);
      scene.links.clear();
      scene.state_machines.push_back(Behaving().state(limit * side, viscosity).state_machine);
      scene.state_links = {{0, 1, 0, 0.0}};
      const double largest = excursion_by_leapfrog(scene);

      EXPECT_TRUE(side < 1.0 ? largest < 100.0 : largest > 1e3) << viscosity << ' ' << largest;
    }
  }
}

TEST(LeapfrogStability, HoldsWhereTheDampersMakeCordisDiverge) {
  NetworkDescription scene = oscillator(1.0, 0.1, 1.96, 1.0, 0.0, 1.0);
  World cordis = make_world(scene);
  run(cordis, 5000);

  EXPECT_GT(std::abs(cordis.position(1).x()), 1e20);  // alternates, 1 % more each step
  EXPECT_LT(excursion_by_leapfrog(scene), 1.5);
}

class LeapfrogConservation : public testing::TestWithParam<double> {};  // viscosity of the links

TEST_P(LeapfrogConservation, KeepsMomentumAndAngularMomentum) {
  World world = make_world(by_leapfrog(free_cluster(50, 203, GetParam())));
  run(world, 1);  // before step 0 the velocity is that of x(0), no force has acted
  const Vec3 momentum = world.momentum();
  const Vec3 angular = world.angular_momentum();
  ASSERT_GT(momentum.norm(), 0.1);

  run(world, rounds(10000));

  EXPECT_LT((world.momentum() - momentum).norm(), 5e-11);  // rounding: see conservation_test.cpp
  EXPECT_LT((world.angular_momentum() - angular).norm(), 5e-11);
}

INSTANTIATE_TEST_SUITE_P(ExtrapolatedAndImplicit, LeapfrogConservation, testing::Values(0.3, 30.0));

NetworkDescription account_scene(double step, double viscosity) {
  NetworkDescription scene = string_in_space(20, viscosity, step);
  scene.gravity = Vec3(0.0, 0.0, -9.81);
  scene.medium_viscosity = 1e-4;
  scene.mats.push_back(port(Vec3(0.1, 0.0, 0.02)));
  scene.links.push_back({10, 22, 100.0, 0.0, 0.01});
  scene.maxwell_links = {{4, 9, 50.0, 0.5}};
  return scene;
}

double largest_residual_of_a_stir(double step, double viscosity) {
  World world = make_world(by_leapfrog(account_scene(step, viscosity)));
  const int steps = static_cast<int>(std::lround(0.05 / step));
  double largest = 0.0;
  for (int n = 0; n < steps; ++n) {
    const double t = n * step / 0.05;
    world.impose_position(22, Vec3(0.1, 0.02 * t * t * (3.0 - 2.0 * t), 0.02));
    if (n == 0) world.set_external_force(5, Vec3(0.0, 0.05, 0.0));
    world.step();
    largest = std::max(largest, std::abs(world.energy().residual()) / world.energy().largest);
  }
  EXPECT_GT(world.energy().dissipated, 1e-3 * world.energy().largest);
  EXPECT_GT(std::abs(world.energy().port_work), 1e-3 * world.energy().largest);
  return largest;
}

TEST(LeapfrogEnergy, ClosesWithTheSecondOrder) {
  for (const double viscosity : {0.05, 50.0}) {
    const double coarse = largest_residual_of_a_stir(4e-5, viscosity);
    const double fine = largest_residual_of_a_stir(1e-5, viscosity);

    EXPECT_LT(coarse, 1e-3) << viscosity;
    EXPECT_LT(fine, 0.1 * coarse) << viscosity;  // a 16th
  }
}

TEST(LeapfrogEnergy, TakesNoLossFromBeforeTheStart) {
  // 1 kg at 1 m/s, Z' = 0.1: the whole 0.5 J go into what holds it back
  constexpr double kViscosity = 100.0;
  NetworkDescription of_medium = oscillator(1.0, 0.0, 0.0, 1.0, 1.0, 1e-3);
  of_medium.medium_viscosity = kViscosity;
  NetworkDescription of_state = oscillator(1.0, 0.0, 0.0, 1.0, 1.0, 1e-3);
  engine::LinkState state;
  state.viscosity = kViscosity;
  of_state.state_machines = {Behaving().state(state).state_machine};
  of_state.state_links = {{0, 1, 0, 0.0}};
  const NetworkDescription of_link = oscillator(1.0, 0.0, kViscosity, 1.0, 1.0, 1e-3);
  for (NetworkDescription scene : {of_link, of_medium, of_state}) {
    for (const IntegratorKind integrator : {IntegratorKind::kLeapfrog, IntegratorKind::kImplicit}) {
      scene.integrator = integrator;
      World world = make_world(scene);
      world.step();
      EXPECT_NEAR(world.energy().dissipated, 0.0, 1e-12) << static_cast<int>(integrator);
      run(world, 500);
      // `implicit` is of first order, its dampers lie beyond the account (docs/integrators.md)
      if (integrator == IntegratorKind::kImplicit) continue;
      EXPECT_NEAR(world.energy().dissipated, 0.5, 0.01);
    }
  }
}

TEST(LeapfrogEnergy, CountsWhatChangesOfStateBring) {
  NetworkDescription scene = network_of_many_states(2);
  World world = make_world(by_leapfrog(scene));
  double switching = 0.0;
  for (int n = 0; n < 500; ++n) {
    world.step();
    for (const engine::LinkEvent& event : world.events()) switching += event.energy;
  }

  EXPECT_NE(switching, 0.0);
  EXPECT_NEAR(world.energy().switching, switching, 1e-9 * std::abs(switching));
}

TEST(Leapfrog, GivesAPortTheForceOfItsImplicitDampersToo) {
  NetworkDescription scene;
  scene.dimension = 1;
  scene.step = 1e-3;
  scene.mats = {port(Vec3::Zero()), mass(0.1, Vec3(0.1, 0, 0))};
  scene.links = {{0, 1, 0.0, 2000.0, 0.0}};  // Z' = 20
  World world = make_world(by_leapfrog(scene));
  for (int n = 1; n <= 100; ++n) {
    world.impose_position(0, Vec3(1e-3 * n, 0, 0));  // 1 m/s
    world.step();
  }

  // the mass has the speed of the port: what had to be given to it has come through the damper
  EXPECT_NEAR(world.velocity(1).x(), 1.0, 1e-6);
  const Energy energy = world.energy();
  EXPECT_NEAR(energy.residual(), 0.0, 1e-3 * energy.largest);
  EXPECT_NEAR(energy.kinetic, 0.05, 1e-4);
}

TEST(Leapfrog, GoesOnFromASnapshotBitForBit) {
  for (const double viscosity : {0.05, 5.0}) {
    World first = make_world(by_leapfrog(account_scene(1e-4, viscosity)));
    run(first, 37);
    World second = make_world(by_leapfrog(account_scene(1e-4, viscosity)));
    second.restore(first.snapshot());
    run(first, 50);
    run(second, 50);

    EXPECT_EQ(first.state_hash(), second.state_hash());
    EXPECT_EQ(first.energy().residual(), second.energy().residual());
  }
}

TEST(Leapfrog, IsTakenOverWithItsMotion) {
  World first = make_world(by_leapfrog(account_scene(1e-4, 0.05)));
  run(first, 37);
  World second = make_world(by_leapfrog(account_scene(1e-4, 0.05)));
  std::vector<double> room;
  room.reserve(second.max_values_of_state());
  ASSERT_TRUE(second.take_over(first, room));
  run(first, 50);
  run(second, 50);

  EXPECT_EQ(first.state_hash(), second.state_hash());
  EXPECT_FALSE(make_world(account_scene(1e-4, 0.05)).take_over(first, room));
}

TEST(Leapfrog, StepsWithoutAllocating) {
  for (const double viscosity : {0.05, 5.0}) {
    World world = make_world(by_leapfrog(account_scene(1e-4, viscosity)));
    const AllocationGuard guard;
    run(world, 20);
    EXPECT_EQ(guard.count(), 0u);
  }
}

}  // namespace
}  // namespace cordis::test
