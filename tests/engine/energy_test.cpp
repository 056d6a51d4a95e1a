// tests/engine/energy_test.cpp -- the account closes.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "tests/engine/many_states.h"
#include "tests/engine/programs.h"
#include "tests/engine/scenes.h"

namespace cordis::test {
namespace {

using engine::Energy;

// In 1 dimension the account is exact: what is left is rounding.
constexpr double kRounding = 2e-12;

/// A string of 20 masses in 1 dimension between fixed ends, plucked.
NetworkDescription string_1d(double viscosity, double medium_viscosity) {
  NetworkDescription scene = string_in_space(20, viscosity, 2e-4);
  scene.dimension = 1;
  scene.medium_viscosity = medium_viscosity;
  for (Mat& mat : scene.mats) mat.position = Vec3(mat.position.y(), 0, 0);
  for (Link& link : scene.links) link.rest_length = 0.0;
  return scene;
}

double largest_relative_residual(World& world, int step_count) {
  double largest = 0.0;
  for (int n = 0; n < step_count; ++n) {
    world.step();
    if (n % 7 != 0) continue;
    const Energy energy = world.energy();
    largest = std::max(largest, std::abs(energy.residual()) / energy.largest);
  }
  return largest;
}

TEST(Energy, IsKeptByAnUndampedStringForAHundredThousandSteps) {
  World world = make_world(string_1d(0.0, 0.0));

  EXPECT_LT(largest_relative_residual(world, 100'000), kRounding);
  EXPECT_EQ(world.energy().dissipated, 0.0);
  EXPECT_EQ(world.energy().port_work, 0.0);
}

TEST(Energy, IsKeptUpToTheLimitOfStability) {
  NetworkDescription scene = string_1d(0.0, 0.0);
  scene.step = 0.99 * std::sqrt(0.001 / 400.0);  // K' = 0.98, of 1 for a string
  World world = make_world(scene);

  EXPECT_LT(largest_relative_residual(world, 100'000), kRounding);
}

TEST(Energy, OfADampedStringIsAllDissipated) {
  World world = make_world(string_1d(0.05, 0.002));

  EXPECT_LT(largest_relative_residual(world, 60'000), kRounding);
  const Energy energy = world.energy();
  EXPECT_LT(energy.total(), 1e-9 * energy.initial);
  EXPECT_NEAR(energy.dissipated, energy.initial, 1e-8 * energy.initial);
}

TEST(Energy, OfAnOscillatorIsThatOfItsExactMotion) {
  // the account does not only close: each part is right, to first order in dt as the scheme is
  const double mass_kg = 0.25;
  const double stiffness = 4.0;
  const double viscosity = 0.1;
  World world = make_world(oscillator(mass_kg, stiffness, viscosity, 0.01, 0.0, 1e-5));
  const double s = viscosity / (2.0 * mass_kg);
  const double w = std::sqrt(stiffness / mass_kg - s * s);

  run(world, 70'000);

  const double t = 0.7;
  const double x = 0.01 * std::exp(-s * t) * (std::cos(w * t) + s / w * std::sin(w * t));
  const double v = -0.01 * std::exp(-s * t) * stiffness / mass_kg / w * std::sin(w * t);
  const Energy energy = world.energy();
  const double all = 0.5 * stiffness * 0.01 * 0.01;
  EXPECT_NEAR(energy.initial, all, 1e-4 * all);
  EXPECT_NEAR(energy.kinetic, 0.5 * mass_kg * v * v, 1e-4 * all);
  EXPECT_NEAR(energy.elastic, 0.5 * stiffness * x * x, 1e-4 * all);
  EXPECT_NEAR(energy.dissipated, all - 0.5 * mass_kg * v * v - 0.5 * stiffness * x * x, 1e-4 * all);
}

TEST(Energy, OfMotionAloneIsThatOfAllMassesWithEveryIntegrator) {
  for (const auto integrator :
       {engine::IntegratorKind::kCordis, engine::IntegratorKind::kModal,
        engine::IntegratorKind::kLeapfrog, engine::IntegratorKind::kSymplectic4,
        engine::IntegratorKind::kImplicit}) {
    NetworkDescription scene = string_1d(0.0, 0.0);
    scene.integrator = integrator;
    World world = make_world(scene);
    const bool has_modes = integrator == engine::IntegratorKind::kModal;
    for (int n = 0; n < 300; ++n) {
      world.step();
      double sum = 0.0;
      for (std::uint32_t i = 0; i < scene.mats.size(); ++i) {
        if (scene.mats[i].kind == MatKind::kMass)
          sum += 0.5 * scene.mats[i].mass * world.velocity(i).squaredNorm();
      }
      const double expected = has_modes ? world.energy().kinetic : sum;
      ASSERT_NEAR(world.kinetic_energy(), expected, 1e-12 * world.energy().initial)
          << to_string(integrator) << ", step " << n;
      ASSERT_NEAR(world.kinetic_energy(), sum, 0.05 * world.energy().initial);
    }
    EXPECT_GT(world.kinetic_energy(), 0.0);
  }
}

TEST(Energy, CountsTheFallIntoGravity) {
  NetworkDescription scene;
  scene.step = 0.01;
  scene.gravity = Vec3(0, -10.0, 0);
  scene.medium_viscosity = 0.1;
  scene.mats = {mass(0.5, Vec3(0, 2, 0), Vec3(1, 0, 0))};
  World world = make_world(scene);

  EXPECT_NEAR(world.energy().gravity, 0.5 * 10.0 * 2.0, 0.01);
  EXPECT_LT(largest_relative_residual(world, 1000), kRounding);
  EXPECT_GT(world.energy().dissipated, 1.0);
}

TEST(Energy, CountsTheWorkOfAPort) {
  NetworkDescription scene = string_1d(0.01, 0.0);
  scene.mats[9].kind = MatKind::kPort;
  scene.mats[15].kind = MatKind::kPort;
  World world = make_world(scene);

  for (int n = 0; n < 20'000; ++n) {
    world.impose_position(9, Vec3(0.02 * std::sin(0.013 * n), 0, 0));
    if (n % 500 == 0) world.impose_position(15, Vec3(n % 1000 == 0 ? 0.01 : -0.01, 0, 0));  // jumps
    world.step();
    const Energy energy = world.energy();
    ASSERT_LT(std::abs(energy.residual()), kRounding * energy.largest) << "step " << n;
  }
  EXPECT_GT(world.energy().port_work, 10.0 * world.energy().initial);
}

TEST(Energy, CountsTheFirstPushOfAPortAgainstABentSpring) {
  NetworkDescription scene = oscillator(0.1, 50.0, 0.3, 0.2, 0.5, 1e-3);
  scene.mats[0].kind = MatKind::kPort;
  World world = make_world(scene);

  world.impose_position(0, Vec3(0.1, 0, 0));

  EXPECT_LT(largest_relative_residual(world, 100), kRounding);
}

TEST(Energy, CountsTheWorkOfAnExternalForce) {
  World world = make_world(string_1d(0.01, 0.001));

  for (int n = 0; n < 5'000; ++n) {
    if (n % 100 == 0) world.set_external_force(5, Vec3(n % 200 == 0 ? 0.9 : -0.3, 0, 0));
    if (n == 777) world.set_external_force(12, Vec3(0.2, 0, 0));
    world.step();
    const Energy energy = world.energy();
    ASSERT_LT(std::abs(energy.residual()), kRounding * energy.largest) << "step " << n;
  }
  EXPECT_GT(world.energy().port_work, world.energy().initial);
}

struct Largest {
  double residual = 0.0;
  double elastic_error = 0.0;
};

/// Relative to the largest of the energies, over 2 s of a string in space.
Largest largest_in_space(double step, double viscosity, bool pushed) {
  NetworkDescription scene = string_in_space(20, viscosity, step);
  scene.gravity = Vec3(0, 0, -9.81);
  scene.mats[7].kind = pushed ? MatKind::kPort : MatKind::kMass;
  World world = make_world(scene);
  Largest largest;
  const int step_count = static_cast<int>(std::lround(2.0 / step));
  for (int n = 0; n < step_count; ++n) {
    const double t = n * step;
    if (pushed) {
      world.impose_position(7, scene.mats[7].position +
                                   Vec3(0, 0.01 * std::sin(30.0 * t), 0.005 * std::sin(17.0 * t)));
    }
    world.step();
    const Energy energy = world.energy();
    largest.residual = std::max(largest.residual, std::abs(energy.residual()) / energy.largest);
    largest.elastic_error =
        std::max(largest.elastic_error, std::abs(energy.elastic_error) / energy.largest);
  }
  return largest;
}

TEST(Energy, ClosesInSpaceAndOwnsUpToAnErrorOfSecondOrder) {
  for (const double viscosity : {0.0, 0.02}) {
    for (const bool pushed : {false, true}) {
      const Largest coarse = largest_in_space(4e-4, viscosity, pushed);
      const Largest fine = largest_in_space(2e-4, viscosity, pushed);
      SCOPED_TRACE(testing::Message() << "Z = " << viscosity << ", pushed " << pushed);

      EXPECT_LT(coarse.residual, kRounding);
      EXPECT_LT(fine.residual, kRounding);
      EXPECT_LT(coarse.elastic_error, 1e-3);
      EXPECT_NEAR(std::log2(coarse.elastic_error / fine.elastic_error), 2.0, 0.3);
    }
  }
}

/// A mass that swings on a law between two fixed points; 1 dimension.
Energy after_swinging(const LinkState& state, double step) {
  NetworkDescription scene;
  scene.dimension = 1;
  scene.step = step;
  scene.mats = {fixed(Vec3::Zero()), mass(0.1, Vec3(0.61, 0, 0), Vec3(0.2, 0, 0))};
  scene.state_machines = {Behaving().state(state).state_machine};
  scene.state_links = {{0, 1, 0, 0.5}};
  World world = make_world(scene);
  Energy worst;
  for (int n = 0; n < std::lround(1.0 / step); ++n) {
    world.step();
    const Energy energy = world.energy();
    // rounding of x(n) - x(n-1), which is small against x in so short a step
    EXPECT_LT(std::abs(energy.residual()), 1e-10 * energy.largest) << "step " << n;
    if (std::abs(energy.elastic_error) > std::abs(worst.elastic_error)) worst = energy;
  }
  return worst;
}

TEST(Energy, OfEveryLawIsItsClosedFormToSecondOrder) {
  LinkState thread;
  thread.stiffness = 40.0;
  thread.elasticity = power_law(90.0, 1.5);
  thread.pushes = false;
  const auto with = [](const engine::Law& law) {
    LinkState state;
    state.stiffness = 5.0;
    state.elasticity = law;
    return state;
  };
  const std::vector<LinkState> states = {
      with(table_law()),          with(power_law(300.0, 3.0)),
      with(power_law(10.0, 0.5)), with(lennard_jones_law(1e-3, 0.5, 0.0)),
      with(ring_law()),           thread};
  for (std::size_t i = 0; i < states.size(); ++i) {
    const double coarse = after_swinging(states[i], 2e-4).elastic_error;
    const double fine = after_swinging(states[i], 1e-4).elastic_error;
    const double largest = after_swinging(states[i], 1e-4).largest;

    EXPECT_LT(std::abs(fine), 1e-4 * largest) << "law " << i;
    EXPECT_LT(std::abs(fine), 0.6 * std::abs(coarse)) << "law " << i;
  }
}

TEST(Energy, OfALinearStateHasNoErrorInOneDimension) {
  LinkState state;
  state.stiffness = 40.0;
  state.viscosity = 0.02;
  const Energy worst = after_swinging(state, 1e-3);
  EXPECT_LT(std::abs(worst.elastic_error), kRounding * worst.largest);
}

TEST(Energy, TakenByLimitsClampsAndFunctionsCountsAsDissipated) {
  LinkState state;
  state.elasticity = cubic_law();
  state.force_limit = 2.0;
  after_swinging(state, 1e-3);
  LinkState clamped;
  clamped.stiffness = 100.0;
  clamped.viscosity = 3.0;
  clamped.pulls = false;
  after_swinging(clamped, 1e-3);
}

/// Seven stars of the masses 1 to 7 in a plane, which pull each other by an expression.
/// [Hairer, Norsett, Wanner: Solving Ordinary Differential Equations I, II.10]
NetworkDescription pleiades(double step, bool as_set) {
  constexpr int kStars = 7;
  constexpr std::array<double, kStars> kX = {3, 3, -1, -3, 2, -2, 2};
  constexpr std::array<double, kStars> kY = {3, -3, 2, 0, 0, -4, 4};
  constexpr std::array<double, kStars> kVx = {0, 0, 0, 0, 0, 1.75, -1.5};
  constexpr std::array<double, kStars> kVy = {0, 0, 0, -1.25, 1, 0, 0};
  NetworkDescription scene;
  scene.dimension = 2;
  scene.step = step;
  const Term d = q(Quantity::kDistance);
  LinkState gravity;
  gravity.elasticity = expression_law(q(Quantity::kMassA) * q(Quantity::kMassB) / (d * d));
  scene.state_machines = {Behaving().state(gravity).state_machine};
  engine::SetLiaison all;
  all.range = 1e3;
  for (std::uint32_t i = 0; i < kStars; ++i) {
    scene.mats.push_back(mass(i + 1.0, Vec3(kX[i], kY[i], 0), Vec3(kVx[i], kVy[i], 0)));
    all.set_p.push_back(i);
    for (std::uint32_t j = 0; j < i && !as_set; ++j) scene.state_links.push_back({j, i, 0, 0.0});
  }
  if (as_set) scene.sets = {all};
  return scene;
}

TEST(Energy, OfStarsThatPullByAnExpressionIsKept) {
  for (const bool as_set : {false, true}) {
    for (const auto integrator :
         {engine::IntegratorKind::kCordis, engine::IntegratorKind::kLeapfrog}) {
      NetworkDescription scene = pleiades(1e-4, as_set);
      scene.integrator = integrator;
      World world = make_world(scene);
      for (int n = 0; n < 30'000; ++n) {
        world.step();
        if (n % 100 != 0) continue;
        const Energy energy = world.energy();
        ASSERT_EQ(energy.dissipated, 0.0);
        ASSERT_NEAR(energy.total(), energy.initial, 1e-3 * energy.largest) << "step " << n;
        ASSERT_LT(std::abs(energy.integration_error()), 1e-3 * energy.largest) << "step " << n;
      }
      EXPECT_GT(world.energy().kinetic, 60.0) << "they meet";
    }
  }
}

/// A bob of 0.1 kg on a rod of 1e5 N/m that is 0.3 m long, and falls to the side.
NetworkDescription bob_on(const Term& tension) {
  NetworkDescription scene;
  scene.dimension = 2;
  scene.step = 2e-4;
  scene.gravity = Vec3(0, -9.81, 0);
  scene.mats = {fixed(Vec3::Zero()), mass(0.1, Vec3(0.18, -0.24, 0))};
  LinkState rod;
  rod.elasticity = expression_law(tension);
  scene.state_machines = {Behaving().state(rod).state_machine};
  scene.state_links = {{0, 1, 0, 0.3}};
  return scene;
}

TEST(Energy, OfAnExpressionOfTheDistanceIsZeroWhereItPullsNothing) {
  const Term d = q(Quantity::kDistance);
  World of_elongation = make_world(bob_on(1e5 * q(Quantity::kElongation)));
  World of_distance = make_world(bob_on(1e5 * (d - 0.3)));
  for (int n = 0; n < 5000; ++n) {
    of_elongation.step();
    of_distance.step();
    if (n % 100 != 0) continue;
    const Energy expected = of_elongation.energy();
    const Energy energy = of_distance.energy();
    ASSERT_EQ(of_distance.state_hash(), of_elongation.state_hash());
    ASSERT_NEAR(energy.elastic, expected.elastic, 1e-9);
    ASSERT_NEAR(energy.largest, expected.largest, 1e-9) << "not 4500 J, from the distance 0 on";
  }
}

TEST(Energy, OfAnExpressionIsCountedFromWhereItsTensionVanishes) {
  const Term d = q(Quantity::kDistance);
  const auto zero_of = [](const Term& tension, double rest_length) {
    const engine::Expression law{tension.program};
    std::set<double> zeros;
    for (const double distance : {0.01, 0.1, 0.37, 5.0}) {
      zeros.insert(law.distance_of_no_potential({distance, distance - rest_length, 0.0, 1.0, 1.0}));
    }
    EXPECT_LT(*zeros.rbegin() - *zeros.begin(), 1e-12) << "one zero for all distances";
    return *zeros.begin();
  };
  EXPECT_NEAR(zero_of(1e5 * (d - 0.3), 0.0), 0.3, 1e-12);
  EXPECT_NEAR(zero_of(1e5 * (d - 0.3), 0.3), 0.3, 1e-12);
  EXPECT_NEAR(zero_of(1e5 * (d - 0.3), -0.3), 0.0, 0.0) << "no zero on that side";
  EXPECT_NEAR(zero_of((d - 0.1) * (d - 1.0), 0.15), 0.1, 1e-12);
  EXPECT_NEAR(zero_of((d - 0.1) * (d - 1.0), 0.7), 1.0, 1e-12);
  EXPECT_EQ(zero_of(2.0 + d, 0.3), 0.0) << "it pulls everywhere";
  EXPECT_EQ(zero_of(1.0 / (d * d), 0.3), 1.0) << "nor has it a value at 0";
  EXPECT_EQ(zero_of(1.0 / (d - 0.3), 0.2), 0.0) << "a pole is no zero";
  EXPECT_EQ(zero_of(1.0 / (d - 0.5), 0.5), 0.0) << "a pole is no zero";
  EXPECT_EQ(zero_of(one(Operation::kExp, 5.0 * d), 0.3), 0.0) << "where it overflows is no zero";
  EXPECT_EQ(zero_of(one(Operation::kExp, Term(-5.0) * d), -0.3), 0.0)
      << "where it overflows is no zero";
}

// The spring ends the push a hair beyond where the mass starts, far from where the expression vanishes.
TEST(Energy, OfAnExpressionOfOneSideCountsWhereItBegins) {
  LinkState state;
  state.stiffness = 1.0;
  state.elasticity =
      expression_law(-1.3 * one(Operation::kExp, Term(-31.0) * q(Quantity::kDistance)));
  state.pulls = false;
  NetworkDescription scene;
  scene.dimension = 2;
  scene.step = 1e-4;
  scene.mats = {fixed(Vec3::Zero()), mass(0.005, Vec3(0.21, 0, 0))};
  scene.state_machines = {Behaving().state(state).state_machine};
  scene.state_links = {{0, 1, 0, 0.21}};
  World world = make_world(scene);
  run(world, 2000);
  const Energy energy = world.energy();
  EXPECT_GT(energy.kinetic, 1e-7);
  EXPECT_LT(std::abs(energy.integration_error()), 0.01 * energy.kinetic);
}

TEST(Energy, OfAnExpressionWithAForceLimitIsTheIntegralOfItsTension) {
  const Term e = q(Quantity::kElongation);
  LinkState state;
  state.stiffness = 5.0;
  state.elasticity = expression_law(30.0 * e + 4000.0 * e * e * e);
  state.force_limit = 2.0;
  const double largest = after_swinging(state, 1e-4).largest;
  EXPECT_LT(std::abs(after_swinging(state, 1e-4).elastic_error), 1e-3 * largest);
  state.pushes = false;
  EXPECT_LT(std::abs(after_swinging(state, 1e-4).elastic_error), 1e-3 * largest);
}

/// MATs 0 and 1, which act on each other within 2 m and rest 0.1 m apart.
engine::SetLiaison set_of_two() {
  engine::SetLiaison set;
  set.set_p = {0};
  set.set_q = {1};
  set.range = 2.0;
  set.rest_length = 0.1;
  return set;
}

/// Pairs of sets far beyond their force limit, with and without viscosity.
TEST(Energy, OfAPairWithAForceLimitIsTheIntegralOfItsTension) {
  for (const bool pulls : {true, false}) {
    for (const double viscosity : {0.0, 0.02}) {
      SCOPED_TRACE("viscosity " + std::to_string(viscosity));
      LinkState state;
      state.stiffness = 100.0;
      state.viscosity = viscosity;
      state.pulls = pulls;
      state.force_limit = 0.3;
      NetworkDescription scene;
      scene.dimension = 2;
      scene.step = 2e-5;
      scene.mats = {fixed(Vec3::Zero()), mass(0.01, Vec3(0.02, 0.05, 0), Vec3(0.1, 0, 0))};
      scene.state_machines = {Behaving().state(state).state_machine};
      scene.sets = {set_of_two()};
      World world = make_world(scene);
      for (int n = 0; n < 10'000; ++n) {
        world.step();
        if (n % 50 != 0) continue;
        const Energy energy = world.energy();
        ASSERT_LT(std::abs(energy.integration_error()), 1e-5) << "step " << n;  // of 10 mJ
        ASSERT_GT(energy.dissipated, -1e-5) << "step " << n;
        const double taken = viscosity == 0.0 ? 0.0 : energy.dissipated;
        ASSERT_NEAR(energy.dissipated, taken, 1e-5) << "step " << n;
      }
    }
  }
}

/// What a law of distance and speed pulls at rest is elastic, the rest of it damping.
TEST(Energy, OfALawOfDistanceAndSpeedIsThatOfItAtRest) {
  for (const auto integrator : {engine::IntegratorKind::kCordis, engine::IntegratorKind::kLeapfrog,
                                engine::IntegratorKind::kImplicit}) {
    for (const bool as_set : {false, true}) {
      for (const bool pulls : {true, false}) {
        SCOPED_TRACE(std::string(engine::to_string(integrator)) + (as_set ? " set" : " link") +
                     (pulls ? "" : " that pushes"));
        LinkState law;
        law.elasticity = expression_law(Term(20.0) * q(Quantity::kElongation) +
                                        Term(0.001) * q(Quantity::kSpeed));
        law.pulls = pulls;
        NetworkDescription scene;
        scene.dimension = 1;
        scene.step = 1e-4;
        scene.integrator = integrator;
        scene.mats = {fixed(Vec3::Zero()), mass(0.01, Vec3(0.09, 0, 0), Vec3(-1.0, 0, 0))};
        scene.state_machines = {Behaving().state(law).state_machine};
        engine::SetLiaison set;
        set.set_p = {0};
        set.set_q = {1};
        set.range = 1.0;
        set.rest_length = 0.1;
        if (as_set) {
          scene.sets = {set};
        } else {
          scene.state_links = {{0, 1, 0, 0.1}};
        }
        World world = make_world(scene);
        const double start = world.energy().total();
        EXPECT_NEAR(start, 0.005 + 0.5 * 20.0 * 0.01 * 0.01, 1e-7);
        double before = 0.0;
        for (int n = 0; n < 1500; ++n) {
          world.step();
          const Energy energy = world.energy();
          ASSERT_LT(std::abs(energy.integration_error()), 0.03 * start) << "step " << n;
          ASSERT_GT(energy.dissipated, before - 1e-2 * start) << "step " << n;
          ASSERT_LT(energy.dissipated, start) << "step " << n;
          before = energy.dissipated;
        }
        EXPECT_GT(before, 1e-4 * start);
      }
    }
  }
}

/// What the pairs of the start store is not lost beside what springs store at a far range.
TEST(Energy, OfPairsThatBeginWithinTheirRangeIsThatOfLinks) {
  NetworkDescription scene;
  scene.dimension = 2;
  scene.step = 1e-4;
  scene.mats = {mass(0.01, Vec3(0, 0, 0)), mass(0.01, Vec3(0.002, 0, 0)),
                mass(0.01, Vec3(0, 0.001, 0))};
  LinkState spring;
  spring.stiffness = 100.0;
  scene.state_machines = {Behaving().state(spring).state_machine};
  constexpr double kRest = 0.02;
  NetworkDescription of_links = scene;
  for (const auto& [a, b] : {std::pair{0U, 1U}, std::pair{0U, 2U}, std::pair{1U, 2U}})
    of_links.state_links.push_back({a, b, 0, kRest});
  engine::SetLiaison set;
  set.set_p = {0, 1, 2};
  set.range = 100.0;
  set.rest_length = kRest;
  scene.sets = {set};
  World of_set = make_world(scene);
  World linked = make_world(of_links);
  for (int n = 0; n < 1000; ++n) {
    ASSERT_NEAR(of_set.energy().elastic, linked.energy().elastic, 1e-9) << "step " << n;
    ASSERT_NEAR(of_set.energy().largest, linked.energy().largest, 1e-9) << "step " << n;
    of_set.step();
    linked.step();
  }
}

/// Nothing is in range at the start: what comes into range falls.
TEST(Energy, OfPairsThatComeIntoRangeIsNoneBefore) {
  NetworkDescription scene;
  scene.dimension = 1;
  scene.step = 1e-4;
  scene.mats = {fixed(Vec3::Zero()), mass(0.01, Vec3(0.06, 0, 0), Vec3(-1.0, 0, 0))};
  LinkState spring;
  spring.stiffness = 1.0;
  scene.state_machines = {Behaving().state(spring).state_machine};
  engine::SetLiaison set;
  set.set_p = {0};
  set.set_q = {1};
  set.range = 0.05;
  set.rest_length = 0.02;
  scene.sets = {set};
  World world = make_world(scene);
  EXPECT_NEAR(world.energy().elastic, 0.0, 1e-15);
  for (int n = 0; n < 400; ++n) world.step();
  EXPECT_NEAR(world.energy().elastic, -0.5 * 0.03 * 0.03, 2e-5) << "near its rest";
}

/// Springs and laws far beyond their force limit: what they store is what their limited tension gives
/// back, and viscosity only takes.
TEST(Energy, OfALawWithAForceLimitIsTheIntegralOfItsTension) {
  constexpr double kLimit = 0.3;
  const auto limited = [](double stiffness, const engine::Law& law, bool pulls) {
    LinkState state;
    state.stiffness = stiffness;
    state.elasticity = law;
    state.pulls = pulls;
    state.force_limit = kLimit;
    return state;
  };
  std::vector<LinkState> states;
  for (const bool pulls : {true, false}) {
    states.push_back(limited(100.0, {}, pulls));
    states.push_back(limited(0.0, power_law(300.0, 1.5), pulls));
    states.push_back(limited(20.0, power_law(3000.0, 3.0), pulls));
    states.push_back(limited(20.0, table_law(), pulls));
  }
  states.push_back(limited(0.0, lennard_jones_law(1e-2, 0.1, 0.0), true));
  states.push_back(limited(0.0, lennard_jones_law(1e-2, 0.1, 0.3), true));
  states.push_back(limited(5.0, ring_law(), true));
  for (std::size_t i = 0; i < states.size(); ++i) {
    for (const double viscosity : {0.0, 0.02}) {
      for (const auto integrator :
           {engine::IntegratorKind::kCordis, engine::IntegratorKind::kLeapfrog}) {
        SCOPED_TRACE("law " + std::to_string(i) + ", viscosity " + std::to_string(viscosity));
        LinkState state = states[i];
        state.viscosity = viscosity;
        NetworkDescription scene;
        scene.dimension = 2;
        scene.step = 2e-5;
        scene.gravity = Vec3(0, -9.81, 0);
        scene.integrator = integrator;
        scene.mats = {fixed(Vec3::Zero()), mass(0.01, Vec3(0.2, 0.05, 0))};
        scene.state_machines = {Behaving().state(state).state_machine};
        scene.state_links = {{0, 1, 0, 0.1}};
        World world = make_world(scene);
        double min_taken = 0.0;
        for (int n = 0; n < 20'000; ++n) {
          world.step();
          if (n % 50 != 0) continue;
          const Energy energy = world.energy();
          const double far = world.position(1).norm() + 1.0;
          ASSERT_LT(std::abs(energy.elastic), kLimit * far + 0.02) << "step " << n;
          ASSERT_LT(std::abs(energy.integration_error()), 2e-3 * energy.largest) << "step " << n;
          ASSERT_GT(energy.dissipated, min_taken - 1e-4 * energy.largest) << "step " << n;
          min_taken = std::max(min_taken, energy.dissipated);
          const double taken = viscosity == 0.0 ? 0.0 : energy.dissipated;
          ASSERT_NEAR(energy.dissipated, taken, 1e-4 * energy.largest) << "step " << n;
        }
      }
    }
  }
}

/// Two MATs that swing through a law that only pulls, or only pushes.
NetworkDescription one_sided_scene(const LinkState& state, bool as_set) {
  NetworkDescription scene;
  scene.dimension = 2;
  scene.step = 2e-5;
  scene.gravity = Vec3(0, -9.81, 0);
  // A ball on a spring beside the law, so that it comes to either side of it again and again.
  scene.mats = {fixed(Vec3::Zero()), mass(0.01, Vec3(0.02, 0.13, 0)), fixed(Vec3(0, 0.12, 0))};
  scene.links = {{1, 2, 20.0, 0.0, 0.0}};
  scene.state_machines = {Behaving().state(state).state_machine};
  if (as_set) {
    scene.sets = {set_of_two()};
  } else {
    scene.state_links = {{0, 1, 0, 0.1}};
  }
  return scene;
}

/// What such a law stores is what its one side gives back; nothing of it counts as dissipated.
TEST(Energy, OfALawThatOnlyPullsOrOnlyPushesIsTheIntegralOfThatSide) {
  const std::vector<engine::Law> laws = {
      lennard_jones_law(1e-2, 0.1, 0.0),        lennard_jones_law(1e-2, 0.1, 0.3),
      lennard_jones_law(1e-2, 0.1, 0.105),      ring_law(),
      engine::Table({-0.1, 0.05}, {0.2, -0.3}), power_law(-20.0, 3.0)};
  for (std::size_t i = 0; i < laws.size(); ++i) {
    for (const bool pulls : {true, false}) {
      for (const bool as_set : {true, false}) {
        SCOPED_TRACE("law " + std::to_string(i) + (pulls ? ", pulls" : ", pushes") +
                     (as_set ? ", set" : ", link"));
        LinkState state;
        state.elasticity = laws[i];
        state.pulls = pulls;
        state.pushes = !pulls;
        World world = make_world(one_sided_scene(state, as_set));
        for (int n = 0; n < 20'000; ++n) {
          world.step();
          if (n % 50 != 0) continue;
          const Energy energy = world.energy();
          ASSERT_LT(std::abs(energy.integration_error()), 2e-3 * energy.largest) << "step " << n;
          ASSERT_NEAR(energy.dissipated, 0.0, 1e-4 * energy.largest) << "step " << n;
        }
      }
    }
  }
}

TEST(Energy, OfASpringBesideOneSidedRingsIsThatOfTheSpringBeyondThem) {
  for (const double distance : {0.5, 0.4002, 0.3998, 0.3, 0.25}) {
    for (const bool pulls : {true, false}) {
      LinkState state;
      state.stiffness = 100.0;
      state.elasticity = engine::Rings{{{40.0, 0.2}}};
      state.pulls = pulls;
      state.pushes = !pulls;
      NetworkDescription scene = one_sided_scene(state, false);
      scene.gravity = Vec3::Zero();
      scene.links.clear();
      scene.mats[1].position = Vec3(distance, 0.0, 0.0);
      scene.state_links[0].rest_length = 0.4;
      const double pressed = distance - 0.4;
      const double stored = (pressed > 0.0) == pulls ? 50.0 * pressed * pressed : 0.0;
      EXPECT_NEAR(make_world(scene).energy().elastic, stored, 1e-9 + 1e-5 * stored)
          << distance << " m";
    }
  }
}

/// Two MATs that pass each other again and again, each time through the rings about the other.
TEST(Energy, OfRingsWithALimitGoesOnWhereTheEndsPassEachOther) {
  struct Limits {
    bool pulls, pushes;
    double force;
  };
  constexpr double kNone = std::numeric_limits<double>::infinity();
  for (const int dimension : {1, 3}) {
    for (const auto& [pulls, pushes, force] :
         {Limits{true, false, kNone}, Limits{false, true, kNone}, Limits{true, true, 0.3},
          Limits{false, true, 0.3}, Limits{true, true, 50.0}}) {
      SCOPED_TRACE(std::to_string(dimension) + "-D, force " + std::to_string(force));
      LinkState state;
      state.elasticity = ring_law();
      state.pulls = pulls;
      state.pushes = pushes;
      state.force_limit = force;
      NetworkDescription scene;
      scene.dimension = dimension;
      scene.step = 2e-5;
      scene.mats = {fixed(Vec3::Zero()), mass(0.01, Vec3(0.5, 0, 0)), fixed(Vec3::Zero())};
      scene.links = {{1, 2, 20.0, 0.0, 0.0}};
      scene.state_machines = {Behaving().state(state).state_machine};
      scene.state_links = {{0, 1, 0, 0.1}};
      World world = make_world(scene);
      int passed = 0;
      double before = 1.0;
      for (int n = 0; n < 20'000; ++n) {
        world.step();
        passed += before * world.position(1).x() < 0.0 ? 1 : 0;
        before = world.position(1).x();
        const Energy energy = world.energy();
        ASSERT_LT(std::abs(energy.integration_error()), 2e-3 * energy.largest) << "step " << n;
        ASSERT_NEAR(energy.dissipated, 0.0, 1e-9 * energy.largest) << "step " << n;
      }
      EXPECT_GT(passed, 2);
    }
  }
}

/// A ball on a floor that can only push, at K' = K dt^2 / m.
Energy after_bouncing(double number, int step_count) {
  NetworkDescription scene;
  scene.dimension = 1;
  scene.step = 1e-3;
  scene.gravity = Vec3(-9.81, 0, 0);
  scene.mats = {fixed(Vec3::Zero()), mass(1.0, Vec3(0.1, 0, 0))};
  LinkState floor;
  floor.stiffness = number / (scene.step * scene.step);
  floor.pulls = false;
  scene.state_machines = {Behaving().state(floor).state_machine};
  scene.state_links = {{0, 1, 0, 0.01}};
  World world = make_world(scene);
  Energy worst;
  for (int n = 0; n < step_count; ++n) {
    world.step();
    const Energy energy = world.energy();
    EXPECT_LT(std::abs(energy.residual()), 1e-9 * energy.largest) << "the account closes";
    if (std::abs(energy.integration_error()) > std::abs(worst.integration_error())) worst = energy;
  }
  return worst;
}

TEST(Energy, OwnsUpToWhatAContactMakesWhoseStepIsTooLong) {
  const Energy wrong = after_bouncing(3.0, 5'000);
  EXPECT_GT(std::abs(wrong.integration_error()), 0.1 * wrong.largest);
  const Energy right = after_bouncing(0.001, 5'000);
  EXPECT_LT(std::abs(right.integration_error()), 0.01 * right.largest);
}

/// A mass that a dissipation slows down: its largest energy, and what no account explains.
Energy after_slowing(const engine::Law& dissipation, double speed) {
  NetworkDescription scene;
  scene.dimension = 1;
  scene.step = 1e-3;
  scene.mats = {fixed(Vec3::Zero()), mass(1e-3, Vec3(0.1, 0, 0), Vec3(speed, 0, 0))};
  LinkState state;
  state.dissipation = dissipation;
  scene.state_machines = {Behaving().state(state).state_machine};
  scene.state_links = {{0, 1, 0, 0.0}};
  World world = make_world(scene);
  for (int n = 0; n < 3; ++n) world.step();
  return world.energy();
}

TEST(Energy, ThatALawBringsInWhichOnlyTakesIsAnIntegrationError) {
  const Energy slow = after_slowing(power_law(0.2, 3.0), 0.1);
  EXPECT_EQ(slow.brought_by_takers, 0.0);
  EXPECT_LT(std::abs(slow.integration_error()), 1e-3 * slow.largest);

  const Energy fast = after_slowing(power_law(0.2, 3.0), 10.0);
  ASSERT_LT(fast.dissipated, -fast.initial) << "the step is too long";
  EXPECT_EQ(fast.brought_by_takers, -fast.dissipated);
  EXPECT_GT(fast.integration_error(), 0.5 * fast.largest);

  const Energy driven = after_slowing(power_law(-0.2, 1.0), 0.1);
  EXPECT_LT(driven.dissipated, 0.0);
  EXPECT_EQ(driven.brought_by_takers, 0.0) << "such a law may drive";
}

/// The largest integration error over the largest energy of a mass on a linear spring at K' = K dt^2 / m.
double error_of_swing(int dimension, double number, int step_count) {
  NetworkDescription scene = oscillator(0.1, 0.0, 0.0, 0.1, 0.0, 1e-3);
  scene.dimension = dimension;
  scene.links[0].stiffness = 0.1 * number / (scene.step * scene.step);
  scene.links[0].rest_length = 0.05;
  World world = make_world(scene);
  double worst = 0.0;
  for (int n = 0; n < step_count; ++n) {
    const Energy energy = world.energy();
    worst = std::max(worst, std::abs(energy.integration_error()) / energy.largest);
    world.step();
  }
  return worst;
}

TEST(Energy, ErrorOfALinearSpringTellsStableFromDiverging) {
  for (const int dimension : {1, 2}) {
    EXPECT_LT(error_of_swing(dimension, 0.01, 2000), 0.005) << dimension;
    EXPECT_GT(error_of_swing(dimension, 4.02, 60), 0.5) << dimension;
  }
}

}  // namespace
}  // namespace cordis::test
