// tests/plan/bend_test.cpp -- certified and diverging steps where matter resists bending.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "sim_node/plan/plan.h"
#include "sim_node/plan/reference/reference_integrator.h"
#include "sim_node/plan/settle.h"
#include "sim_node/plan/stability/start_tangent.h"
#include "sim_node/plan/stability/step_bound.h"
#include "tests/engine/beams.h"
#include "tests/engine/programs.h"
#include "tests/plan/networks.h"
#include "tests/support/rounds.h"

namespace cordis::test {
namespace {

using plan::certified_bound;
using plan::liaison_graph;

double certified_step(const NetworkDescription& scene) {
  return certified_bound(scene, liaison_graph(scene)).step;
}

TEST(BendBound, OfABeamIsItsLimit) {
  for (int dimension = 1; dimension <= 3; ++dimension) {
    const NetworkDescription scene = CantileverBeam(dimension).network();

    const double certified = certified_step(scene);
    const double limit = plan::StartTangent(scene).diverging_step();

    EXPECT_LE(certified, limit * (1.0 + 1e-6)) << dimension;
    EXPECT_GT(certified, 0.99 * limit) << dimension;
  }
}

TEST(BendBound, OfThreeFreeMassesIsExact) {
  // M^-1 K has the eigenvalue 6 B / (m h^2) alone.
  NetworkDescription scene;
  scene.dimension = 2;
  scene.step = 1e-4;
  scene.mats = {mass(0.01, Vec3::Zero()), mass(0.01, Vec3(0.1, 0, 0)), mass(0.01, Vec3(0.2, 0, 0))};
  scene.bends = {{0, 1, 2, 0.03, 0.0, 0.0, 0.1, 0.1}};
  const double exact = 2.0 / std::sqrt(6.0 * 0.03 / (0.01 * 0.01));

  EXPECT_NEAR(certified_step(scene), exact, 1e-6 * exact);
  EXPECT_NEAR(plan::StartTangent(scene).diverging_step(), exact, 1e-6 * exact);
}

/// Masses anywhere, with bends of unequal sides and some springs, at rest.
NetworkDescription random_bends(unsigned seed, int dimension) {
  std::mt19937 random(seed);
  const auto uniform = [&random] { return static_cast<double>(random()) / 4294967296.0; };
  const auto decades = [&](double low, double high) {
    return low * std::pow(high / low, uniform());
  };
  NetworkDescription scene;
  scene.dimension = dimension;
  scene.step = 1e-3;
  const auto count = static_cast<std::uint32_t>(3 + random() % 8);
  for (std::uint32_t i = 0; i < count; ++i) {
    Vec3 place = Vec3::Zero();
    for (int axis = 0; axis < dimension; ++axis) place[axis] = 0.3 * uniform();
    scene.mats.push_back(i == 0 ? fixed(place) : mass(decades(0.003, 0.1), place));
  }
  for (std::uint32_t i = 2; i < count; ++i) {
    const double rest = dimension < 3 ? 2.0 * uniform() - 1.0 : 0.0;
    const double stiffness = decades(0.01, 3.0);
    const double viscosity = uniform() < 0.5 ? 0.0 : decades(1e-5, 1e-2);
    const double first = decades(0.03, 0.3);
    scene.bends.push_back({i - 2, i - 1, i, stiffness, viscosity, rest, first, decades(0.03, 0.3)});
    if (uniform() < 0.5) scene.links.push_back({i - 1, i, decades(1.0, 1000.0), 0.0, 0.05});
  }
  return scene;
}

TEST(BendBound, HoldsFromBothSidesForRandomNetworks) {
  double worst = 1.0;
  for (unsigned seed = 0; seed < 60; seed += kSeedStride) {
    NetworkDescription scene = random_bends(seed, 1 + static_cast<int>(seed % 3));
    const double certified = certified_step(scene);
    const double limit = plan::StartTangent(scene).diverging_step();
    EXPECT_LE(certified, limit * (1.0 + 1e-6)) << seed;
    worst = std::min(worst, certified / limit);

    scene.step = 0.98 * certified;
    EXPECT_LT(largest_excursion(scene, 20'000), 30.0) << seed;
  }
  RecordProperty("worst share", std::to_string(worst));
}

TEST(BendBound, DivergesBeyondItsLimit) {
  for (unsigned seed = 0; seed < 30; ++seed) {
    NetworkDescription scene = random_bends(seed, 1);  // linear: from any start
    scene.step = 1.02 * plan::StartTangent(scene).diverging_step();
    EXPECT_GT(largest_excursion(scene, 20'000), 1e6) << seed;
  }
}

TEST(BendReference, IsWhatTheSchemeConvergesTo) {
  for (int dimension = 1; dimension <= 3; ++dimension) {
    NetworkDescription scene = random_bends(7, dimension);
    for (engine::Bend& bend : scene.bends) bend.viscosity = 1e-4;
    plan::ReferenceIntegrator exact(scene);
    exact.advance_to(0.1);
    double errors[2] = {};
    for (const int part : {1, 2}) {
      scene.step = 1e-5 / part;
      World world = make_world(scene);
      run(world, part * 10'000);
      for (std::uint32_t i = 0; i < scene.mats.size(); ++i) {
        errors[part - 1] += (world.position(i) - exact.position(i)).norm();
      }
    }
    EXPECT_LT(errors[0], 1e-3) << dimension;
    EXPECT_NEAR(errors[0] / errors[1], 2.0, 0.2) << dimension;
  }
}

/// Masses with bends that yield, thrown apart.
NetworkDescription random_bends_with_states(unsigned seed, int dimension) {
  NetworkDescription scene = random_bends(seed, dimension);
  const Term bend = q(Quantity::kBend);
  const Term rest = q(Quantity::kRestAngle);  // no exit holds within a step of the reference alone
  StateMachine yields =
      Behaving().state(0.02, 1e-5).exit(size(bend) > 0.4, 1).state(0.005).state_machine;
  if (dimension < 3) {
    yields = Behaving()
                 .state(0.02, 1e-5)
                 .exit_to_rest(size(bend) > 0.4, 1, rest + Term(0.5) * bend)
                 .state(0.005)
                 .exit(q(Quantity::kAge) > 0.03, 2, RestRule::kHere)
                 .state(0.01)
                 .state_machine;
  }
  scene.state_machines = {yields};
  std::mt19937 random(seed);
  for (engine::Bend& bend_of : scene.bends) {
    bend_of.stiffness = bend_of.viscosity = 0.0;
    bend_of.state_machine = 0;
  }
  for (engine::Mat& mat : scene.mats) {
    if (mat.kind != MatKind::kMass) continue;
    for (int axis = 0; axis < dimension; ++axis)
      mat.velocity[axis] = static_cast<double>(random()) / 4294967296.0 - 0.5;
  }
  return scene;
}

TEST(BendBound, OfStatesIsThatOfTheStiffest) {
  for (int dimension = 1; dimension <= 3; ++dimension) {
    NetworkDescription scene = random_bends_with_states(3, dimension);
    NetworkDescription stiffest = scene;
    for (engine::Bend& bend : stiffest.bends) {
      bend.state_machine = engine::Bend::kNone;
      bend.stiffness = 0.02;
      bend.viscosity = 1e-5;
    }
    EXPECT_EQ(certified_step(scene), certified_step(stiffest));
    EXPECT_NEAR(plan::StartTangent(scene).diverging_step(),
                plan::StartTangent(stiffest).diverging_step(), 1e-12);
    scene.state_machines[0].states[1].stiffness = 0.05;
    EXPECT_LT(certified_step(scene), 0.99 * certified_step(stiffest));
  }
}

TEST(BendReference, WithStatesIsWhatTheSchemeConvergesTo) {
  std::uint64_t changes = 0;
  for (int dimension = 1; dimension <= 3; ++dimension) {
    for (unsigned seed = 1; seed < 7; ++seed) {
      NetworkDescription scene = random_bends_with_states(seed, dimension);
      plan::ReferenceIntegrator exact(scene);
      exact.advance_to(0.2);
      changes += exact.state_changes();
      double errors[2] = {};
      for (const int part : {1, 8}) {
        scene.step = 2e-5 / part;
        World world = make_world(scene);
        run(world, part * 10'000);
        for (std::uint32_t i = 0; i < scene.mats.size(); ++i)
          errors[part > 1] += (world.position(i) - exact.position(i)).norm();
      }
      EXPECT_LT(errors[0], 5e-3) << dimension << " " << seed;
      EXPECT_LT(errors[1], 0.3 * errors[0] + 1e-6) << dimension << " " << seed;
    }
  }
  EXPECT_GT(changes, 6U);
}

TEST(BendPlan, SettlesABeamToItsSag) {
  const CantileverBeam beam(2);
  NetworkDescription scene = beam.network();
  scene.gravity = Vec3(0, -0.05, 0);

  const plan::Settled rest = plan::settle(scene, {1e-9, 2'000'000});

  const double length = beam.length();
  const double x = length - 0.005;  // of the last MAT
  const double load = 0.1 * 0.05;   // [N/m]
  const double exact =
      load * x * x * (x * x - 4.0 * length * x + 6.0 * length * length) / (24.0 * 0.002);
  EXPECT_NEAR(-rest.position.back().y() / exact, 1.0, 0.01);
}

/// A law of a bend that acts alike both ways.
engine::Law random_law(std::mt19937& random) {
  const auto uniform = [&random] { return static_cast<double>(random()) / 4294967296.0; };
  const Term bend = q(Quantity::kElongation);
  const double slope = 0.01 * std::pow(100.0, uniform());
  const double more = slope * 5.0 * uniform();
  const double width = 0.1 + uniform();
  switch (random() % 5) {
    case 0:
      return expression_law(Term(slope) * bend + Term(more) * bend * bend * bend);
    case 1:
      return expression_law(Term(slope) * one(Operation::kSin, bend));
    case 2:
      return expression_law(Term(slope * width) * one(Operation::kTanh, bend / Term(width)));
    case 3:
      return engine::Table({-width, 0.0, width}, {-slope * width, 0.0, slope * width});
    default:
      return engine::Power{slope, 1.0 + 0.5 * static_cast<double>(random() % 5)};
  }
}

/// Gives the bends of a network one law beside what they have; viscosities stay.
NetworkDescription with_a_law(NetworkDescription scene, const engine::Law& law) {
  for (engine::Bend& bend : scene.bends) {
    StateMachine machine = Behaving().state(bend.stiffness, bend.viscosity).state_machine;
    machine.states[0].elasticity = law;
    bend.state_machine = static_cast<std::uint32_t>(scene.state_machines.size());
    bend.stiffness = bend.viscosity = 0.0;
    scene.state_machines.push_back(machine);
  }
  return scene;
}

TEST(BendLawBound, HoldsFromBothSidesForRandomNetworks) {
  int certain = 0;
  for (unsigned seed = 0; seed < 60; seed += kSeedStride) {
    std::mt19937 random(seed + 1000);
    NetworkDescription scene =
        with_a_law(random_bends(seed, 1 + static_cast<int>(seed % 3)), random_law(random));
    const double certified = certified_step(scene);
    const double limit = plan::StartTangent(scene).diverging_step();
    EXPECT_LE(certified, limit * (1.0 + 1e-6)) << seed;
    scene.step = 0.98 * certified;
    const plan::LiaisonGraph graph = liaison_graph(scene);
    scene.step = 0.98 * plan::certain_step_of(scene, graph, plan::stability_of(scene, graph));
    if (!(scene.step > 0.0)) continue;
    ++certain;
    EXPECT_LT(largest_excursion(scene, 20'000), 30.0) << seed;
  }
  EXPECT_GT(certain, kSeedStride > 1 ? 0 : 30);
}

/// Three masses that are nearly straight, and fast: the middle one goes across.
NetworkDescription struck(const engine::Law& law, double speed, int dimension = 2) {
  NetworkDescription scene;
  scene.dimension = dimension;
  scene.step = 1e-5;
  const Vec3 across = dimension == 1 ? Vec3::UnitX() : Vec3(0.0, 0.8, dimension == 3 ? 0.6 : 0.0);
  for (int i = 0; i < 3; ++i) {
    const Vec3 place = dimension == 1 ? Vec3(Vec3::Zero()) : Vec3(0.1 * i, 1e-4 * i * i, 0.0);
    scene.mats.push_back(mass(i == 1 ? 0.02 : 0.01, place, (i == 1 ? speed : -speed) * across));
  }
  if (dimension > 1) scene.links = {{0, 1, 20.0, 0.0, 0.1}, {1, 2, 20.0, 0.0, 0.1}};
  scene.bends = {{0, 1, 2, 0.0, 0.0, 0.0, 0.1, 0.1}};
  return with_a_law(scene, law);
}

TEST(BendLawBound, CountsWhatEnergyReaches) {
  // The slope is 0.01 N m/rad at the start, and beyond 0.5 rad 100 times that.
  const engine::Law stop = engine::Table({-1.5, -0.5, 0.5, 1.5}, {-1.005, -0.005, 0.005, 1.005});
  const engine::Law soft = engine::Table({-1.5, 1.5}, {-0.015, 0.015});
  EXPECT_LT(certified_step(struck(stop, 1.0)), 0.5 * certified_step(struck(soft, 1.0)));
  // A cubic law is followed as far as the energy carries it.
  const Term bend = q(Quantity::kElongation);
  const engine::Law cubic = expression_law(Term(0.01) * bend + Term(3.0) * bend * bend * bend);
  const double slow = certified_step(struck(cubic, 1e-3));
  const double fast = certified_step(struck(cubic, 5.0));
  EXPECT_LT(fast, 0.8 * slow);
  NetworkDescription scene = struck(cubic, 5.0);
  scene.step = 0.98 * fast;
  EXPECT_LT(largest_excursion(scene, 20'000), 1e4);
}

TEST(BendLawBound, IsNotCertainOfWhatHasNoSlope) {
  const Term bend = q(Quantity::kElongation);
  const engine::Law jumps = expression_law(Term(0.1) * one(Operation::kSign, bend));
  EXPECT_TRUE(liaison_graph(struck(jumps, 1.0)).uncertainty);
  const engine::Law drives = expression_law(Term(-0.1) * bend * bend * bend);
  EXPECT_TRUE(liaison_graph(struck(drives, 1.0)).uncertainty);
}

TEST(BendLawReference, IsWhatTheSchemeConvergesTo) {
  const Term bend = q(Quantity::kElongation);
  const Term rate = q(Quantity::kSpeed);
  for (int dimension = 1; dimension <= 3; ++dimension) {
    NetworkDescription scene = struck(
        expression_law(Term(0.05) * bend + Term(0.3) * bend * bend * bend + Term(1e-5) * rate), 0.5,
        dimension);
    plan::ReferenceIntegrator exact(scene);
    exact.advance_to(0.1);
    double errors[2] = {};
    for (const int part : {1, 2}) {
      scene.step = 1e-5 / part;
      World world = make_world(scene);
      run(world, part * 10'000);
      for (std::uint32_t i = 0; i < scene.mats.size(); ++i)
        errors[part - 1] += (world.position(i) - exact.position(i)).norm();
    }
    EXPECT_LT(errors[0], 1e-3) << dimension;
    EXPECT_NEAR(errors[0] / errors[1], 2.0, 0.3) << dimension;
  }
}

}  // namespace
}  // namespace cordis::test
