// tests/engine/driven_force_test.cpp -- forces that depend on place, velocity and variables.
#include <cmath>
#include <functional>
#include <stdexcept>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/engine/programs.h"
#include "tests/engine/scenes.h"
#include "tests/support/allocation_guard.h"

namespace cordis::test {
namespace {

using engine::Drive;
using engine::IntegratorKind;
using engine::TimeFunction;

constexpr double kTurn = 6.28318530717958647692;

Term place(std::size_t axis) {
  return q(engine::kPlaceInForce[axis]);
}
Term velocity_of_mat(std::size_t axis) {
  return q(engine::kVelocityInForce[axis]);
}
Term variable(std::uint32_t number) {
  Term term(0.0);
  term.program.code = {{Operation::kVariable, Quantity::kDistance, 0.0, number}};
  return term;
}

/// -stiffness x - viscosity v along each axis.
TimeFunction well(double stiffness, double viscosity, int dimension) {
  TimeFunction function;
  for (std::size_t axis = 0; axis < static_cast<std::size_t>(dimension); ++axis) {
    function.formula[axis] =
        (Term(-stiffness) * place(axis) - Term(viscosity) * velocity_of_mat(axis)).program;
  }
  return function;
}

/// One mass under a force, in 2 dimensions.
NetworkDescription one_mass(const Mat& mat, TimeFunction function, double step,
                            IntegratorKind integrator) {
  NetworkDescription scene;
  scene.dimension = 2;
  scene.step = step;
  scene.integrator = integrator;
  scene.mats = {mat};
  scene.time_functions = {std::move(function)};
  scene.drives = {{0, 0, true}};
  return scene;
}

TEST(DrivenForce, OfAWellIsTheEllipseOfTheScheme) {
  const double dt = 1e-3;
  const double stiffness = 80.0;
  const double mass_kg = 0.2;
  // x(n) = x0 cos(n a) + v0 dt sin(n a) / sin a with cos a = 1 - K dt^2 / 2 m, for both schemes
  const double a = std::acos(1.0 - 0.5 * stiffness * dt * dt / mass_kg);
  for (const auto integrator : {IntegratorKind::kCordis, IntegratorKind::kLeapfrog}) {
    SCOPED_TRACE(to_string(integrator));
    World world = make_world(one_mass(mass(mass_kg, Vec3(0.3, -0.1, 0), Vec3(1.0, 2.0, 0)),
                                      well(stiffness, 0.0, 2), dt, integrator));
    for (int n = 1; n <= 3000; ++n) {
      world.step();
      const double c = std::cos(n * a);
      const double s = dt * std::sin(n * a) / std::sin(a);
      ASSERT_NEAR(world.position(0).x(), 0.3 * c + 1.0 * s, 1e-11) << n;  // rounding
      ASSERT_NEAR(world.position(0).y(), -0.1 * c + 2.0 * s, 1e-11) << n;
    }
    const engine::Energy energy = world.energy();
    EXPECT_LT(std::abs(energy.residual()), 4e-4 * energy.largest);  // K dt^2 / m
  }
}

TEST(DrivenForce, DoesTheWorkOfTheKineticEnergy) {
  // The account of `cordis` closes to rounding, whatever the force.
  TimeFunction whirl;
  whirl.formula = {(Term(-9.0) * place(1) * place(1) - Term(0.4) * velocity_of_mat(1)).program,
                   (Term(5.0) * place(0) - Term(0.7) * velocity_of_mat(1)).program,
                   {}};
  World world = make_world(
      one_mass(mass(0.5, Vec3(0.3, 0.2, 0), Vec3(1, 0, 0)), whirl, 1e-3, IntegratorKind::kCordis));
  run(world, 1500);
  const engine::Energy energy = world.energy();
  EXPECT_GT(std::abs(energy.port_work), 0.1);
  EXPECT_LT(std::abs(energy.residual()), 1e-12 * energy.largest);
}

/// A planet about the origin, G M = 1, from its perihelion; masses fall alike.
NetworkDescription planet(double eccentricity, double step) {
  const double mass_kg = 2.0;
  const Term cube = [] {
    Term square = place(0) * place(0) + place(1) * place(1);
    return square * one(Operation::kSqrt, square);
  }();
  TimeFunction field;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    field.formula[axis] = two(Operation::kDivide, Term(-mass_kg) * place(axis), cube).program;
  }
  const double speed = std::sqrt((1.0 + eccentricity) / (1.0 - eccentricity));
  return one_mass(mass(mass_kg, Vec3(1.0 - eccentricity, 0, 0), Vec3(0, speed, 0)), field, step,
                  IntegratorKind::kLeapfrog);
}

/// How far a planet with semi-major axis 1 is from its perihelion after a turn [m].
double error_after_a_turn(double eccentricity, int steps) {
  NetworkDescription scene = planet(eccentricity, kTurn / steps);
  const Vec3 perihelion = scene.mats[0].position;
  World world = make_world(scene);
  run(world, steps);
  return (world.position(0) - perihelion).norm();
}

TEST(DrivenForce, OfACentreIsAnOrbitOfKepler) {
  for (const double eccentricity : {0.0, 0.3, 0.6}) {
    SCOPED_TRACE(eccentricity);
    const int steps = 40'000;
    World world = make_world(planet(eccentricity, kTurn / steps));
    double farthest = 0.0;
    double along_axis = 0.0;  // of the angular momentum, over what it is
    const double exact = 2.0 * std::sqrt(1.0 - eccentricity * eccentricity);
    for (int n = 0; n < steps; ++n) {
      world.step();
      farthest = std::max(farthest, world.position(0).norm());
      along_axis = std::max(along_axis, std::abs(world.angular_momentum().z() / exact - 1.0));
    }
    // The period is 2 pi, the aphelion 1 + e; errors are of order step^2.
    EXPECT_LT((world.position(0) - Vec3(1.0 - eccentricity, 0, 0)).norm(), 2e-5);
    EXPECT_NEAR(farthest, 1.0 + eccentricity, 1e-6);
    EXPECT_LT(along_axis, 1e-10);  // the law of areas; rounding
  }
}

TEST(DrivenForce, OfACentreConvergesAsItsScheme) {
  const double coarse = error_after_a_turn(0.3, 4000);
  const double fine = error_after_a_turn(0.3, 8000);
  EXPECT_NEAR(coarse / fine, 4.0, 0.1);
}

TEST(DrivenForce, OfTheVelocityIsThatOfAMedium) {
  for (const auto integrator : {IntegratorKind::kCordis, IntegratorKind::kLeapfrog}) {
    SCOPED_TRACE(to_string(integrator));
    const Mat flying = mass(0.4, Vec3(1, 2, 0), Vec3(3, -1, 0));
    NetworkDescription dragged = one_mass(flying, well(0.0, 0.3, 2), 1e-3, integrator);
    NetworkDescription in_medium = dragged;
    in_medium.drives.clear();
    in_medium.time_functions.clear();
    in_medium.medium_viscosity = 0.3;
    World first = make_world(dragged);
    World second = make_world(in_medium);
    for (int n = 0; n < 2000; ++n) {
      first.step();
      second.step();
      ASSERT_LT((first.position(0) - second.position(0)).norm(), 1e-12) << n;
    }
    EXPECT_NEAR(-first.energy().port_work, second.energy().dissipated, 1e-9);
  }
}

TEST(DrivenForce, AsksForVariablesAsTheyAreNow) {
  // A mass that flies on at 2 m/s, and one that is pushed by where that is: x'' = K (1 + 2 t) / m.
  NetworkDescription scene;
  scene.dimension = 1;
  scene.step = 1e-3;
  scene.mats = {mass(1.0, Vec3(1, 0, 0), Vec3(2, 0, 0)), mass(0.5, Vec3::Zero())};
  engine::Variable of_first;
  of_first.quantity = engine::VariableKind::kPosition;
  of_first.direction = Vec3::UnitX();
  scene.variables = {of_first};
  TimeFunction function;
  function.formula[0] = (Term(3.0) * variable(0)).program;
  scene.time_functions = {function};
  scene.drives = {{1, 0, true}};
  World world = make_world(scene);
  // The sum of all kicks, f(0) counted by half: x(n) = 6 dt^2 (n^2 / 2 + 2 dt (n^3 - n) / 6).
  for (int n = 1; n <= 1000; ++n) {
    world.step();
    const double k = n;
    const double dt = scene.step;
    ASSERT_NEAR(world.position(1).x(), 6.0 * dt * dt * (0.5 * k * k + dt * (k * k * k - k) / 3.0),
                1e-10)
        << n;
  }
  EXPECT_LT(std::abs(world.energy().residual()), 1e-12 * world.energy().largest);
}

TEST(DrivenForce, AsksForAVelocityAsForThatOfItsMass) {
  for (const auto integrator : {IntegratorKind::kCordis, IntegratorKind::kLeapfrog}) {
    SCOPED_TRACE(to_string(integrator));
    const Mat flying = mass(0.4, Vec3(10, 2, 0), Vec3(3, -1, 0));
    NetworkDescription own = one_mass(flying, well(0.0, 0.3, 2), 1e-3, integrator);
    own.time_functions[0].formula[1] = {};
    NetworkDescription asked = own;
    asked.time_functions[0].formula[0] = (Term(0.0) - Term(0.3) * variable(0)).program;
    engine::Variable of_mass;
    of_mass.quantity = engine::VariableKind::kVelocity;
    of_mass.direction = Vec3::UnitX();
    asked.variables = {of_mass};
    World first = make_world(own);
    World second = make_world(asked);
    for (int n = 0; n < 500; ++n) {
      first.step();
      second.step();
      ASSERT_NEAR(first.position(0).x(), second.position(0).x(), 1e-12) << n;  // rounding
    }
  }
}

TEST(DrivenForce, IsThatOfItsFrame) {
  // Turned by a quarter and moved, the well of a frame along its x axis pulls along y about its origin.
  TimeFunction along;
  along.formula[0] = (Term(-40.0) * place(0)).program;
  NetworkDescription scene =
      one_mass(mass(1.0, Vec3(7.0, 5.1, 0)), along, 1e-3, IntegratorKind::kCordis);
  scene.drives[0].origin = Vec3(6, 5, 0);
  scene.drives[0].turn = {0, -1, 0, 1, 0, 0, 0, 0, 1};
  EXPECT_LT((force_at(scene, scene.drives[0], {0.0, Vec3(7.0, 5.1, 0), Vec3::Zero(), nullptr}) -
             Vec3(0, -4, 0))
                .norm(),
            1e-13);
  World world = make_world(scene);
  run(world, 1000);
  EXPECT_EQ(world.position(0).x(), 7.0);
  EXPECT_NEAR(world.position(0).y(), 5.0 + 0.1 * std::cos(std::sqrt(40.0)), 1e-5);
}

TEST(DrivenForce, GoesOnFromASnapshotBitForBit) {
  World world = make_world(planet(0.4, 1e-3));
  run(world, 700);
  const engine::Snapshot snapshot = world.snapshot();
  run(world, 900);
  World other = make_world(planet(0.4, 1e-3));
  other.restore(snapshot);
  run(other, 900);
  EXPECT_EQ(other.state_hash(), world.state_hash());
}

TEST(DrivenForce, ThatIsNoNumberIsCountedAndDoesNothing) {
  TimeFunction wall;  // no number beyond x = 0
  wall.formula[0] = one(Operation::kSqrt, Term(0.0) - place(0)).program;
  World world = make_world(
      one_mass(mass(1.0, Vec3(-0.01, 0, 0), Vec3(1, 0, 0)), wall, 1e-3, IntegratorKind::kCordis));
  std::uint32_t refused = 0;
  for (int n = 0; n < 100; ++n) refused += world.step().refused_drives;
  EXPECT_GT(refused, 80u);
  EXPECT_TRUE(world.position(0).allFinite());
}

TEST(DrivenForce, StepsWithoutAllocating) {
  World world = make_world(planet(0.4, 1e-3));
  run(world, 5);
  const AllocationGuard guard;
  run(world, 100);
  EXPECT_EQ(guard.count(), 0u);
}

TEST(DrivenForce, IsRefusedWhereItMakesNoSense) {
  const auto message_of = [](const std::function<void(NetworkDescription&)>& spoil) {
    NetworkDescription scene = planet(0.3, 1e-3);
    scene.integrator = IntegratorKind::kCordis;
    spoil(scene);
    try {
      make_world(scene);
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(message_of([](NetworkDescription&) {}), "");
  EXPECT_NE(message_of([](auto& s) { s.drives[0].turn[0] = 2.0; }).find("a rotation"),
            std::string::npos);
  EXPECT_NE(message_of([](auto& s) {
              s.time_functions[0].formula[0] = place(2).program;
            }).find("a place or velocity along an axis of the network"),
            std::string::npos);
  EXPECT_NE(message_of([](auto& s) { s.time_functions[0].formula[0] = variable(0).program; }), "");
  EXPECT_NE(message_of([](auto& s) {
              s.mats[0] = port(s.mats[0].position);
              s.drives[0].is_force = false;
            }).find("one of time alone"),
            std::string::npos);
  EXPECT_NE(
      message_of([](auto& s) { s.mats[0].position = Vec3::Zero(); }).find("value at the start"),
      std::string::npos);
  EXPECT_NE(message_of([](auto& s) {
              s.integrator = IntegratorKind::kSymplectic4;
            }).find("what is driven"),
            std::string::npos);
  NetworkDescription modal = oscillator(1.0, 10.0, 0.0, 0.1, 0.0, 1e-3);
  modal.integrator = IntegratorKind::kModal;
  modal.time_functions = {well(1.0, 0.0, 1)};
  modal.drives = {{1, 0, true}};
  EXPECT_THROW(make_world(modal), std::invalid_argument);
}

}  // namespace
}  // namespace cordis::test
