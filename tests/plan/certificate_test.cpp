// tests/plan/certificate_test.cpp -- what is not certified, and what is not surely unstable.
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "sim_node/plan/plan.h"
#include "sim_node/plan/stability/liaison_graph.h"
#include "tests/engine/programs.h"
#include "tests/plan/networks.h"

namespace cordis::test {
namespace {

constexpr double kMass = 0.001;  // [kg]

/// A mass away from a fixed point.
NetworkDescription mass_at(const Vec3& place, int dimension, double rate_hz) {
  NetworkDescription scene;
  scene.dimension = dimension;
  scene.step = 1.0 / rate_hz;
  scene.mats = {fixed(Vec3::Zero()), mass(kMass, place)};
  return scene;
}

void join(NetworkDescription& scene, engine::StateMachine law, double rest_length) {
  scene.state_links.push_back(
      {0, 1, static_cast<std::uint32_t>(scene.state_machines.size()), rest_length});
  scene.state_machines.push_back(std::move(law));
}

engine::StateMachine viscous(engine::Law law) {
  engine::StateMachine machine = state_machine(0.0);
  machine.states[0].dissipation = std::move(law);
  return machine;
}

engine::StateMachine with_exit(engine::StateMachine machine, const Term& when) {
  machine.states.emplace_back();
  machine.states[0].last_exit = 1;
  machine.exits.emplace_back();
  machine.exits[0].target = 1;
  machine.exits[0].when = when.program;
  return machine;
}

plan::Stability stability_at_start(const NetworkDescription& scene) {
  return plan::plan_of(scene, 10.0).stability;
}

const Term kE = q(Quantity::kElongation);  // NOLINT(cert-err58-cpp): the test would not start
const Term kV = q(Quantity::kSpeed);       // NOLINT(cert-err58-cpp)

/// A spring stretched by 0.2 m: 200 m/s for 1 g.
NetworkDescription stretched(int dimension) {
  NetworkDescription scene = mass_at(Vec3(0.3, 0, 0), dimension, 44100.0);
  scene.links = {{0, 1, 2000.0, 0.0, 0.1}};
  return scene;
}

TEST(Certificate, JudgesAViscosityAtTheSpeedThatStoredEnergyGives) {
  for (const auto& [coefficient, exponent] : {std::pair(12.0, 3.0), std::pair(20.0, 2.0)}) {
    for (const int dimension : {1, 2}) {
      NetworkDescription scene = stretched(dimension);
      join(scene, viscous(engine::Power{coefficient, exponent}), 0.0);
      EXPECT_FALSE(stability_at_start(scene).holds()) << exponent;
      EXPECT_FALSE(stability_at_start(scene).diverges()) << exponent;
    }
  }
}

TEST(Certificate, JudgesAPowerOfTheSpeedAsTheSameExpression) {
  NetworkDescription power = stretched(1);
  NetworkDescription expression = power;
  join(power, viscous(engine::Power{0.5, 3.0}), 0.1);
  join(expression, viscous(expression_law(0.5 * kV * kV * kV)), 0.1);

  const double of_power = stability_at_start(power).certified.step;
  EXPECT_NEAR(stability_at_start(expression).certified.step, of_power, 0.02 * of_power);
  power.step = expression.step = 0.9 * of_power;
  EXPECT_TRUE(stability_at_start(power).holds());
  EXPECT_TRUE(stability_at_start(expression).holds());
}

TEST(Certificate, HoldsAtItsStepWithAViscosityThatGrowsWithTheSpeed) {
  for (const auto integrator : {engine::IntegratorKind::kCordis, engine::IntegratorKind::kLeapfrog,
                                engine::IntegratorKind::kImplicit}) {
    NetworkDescription scene = mass_at(Vec3(0.1, 0, 0), 1, 1000.0);
    scene.integrator = integrator;
    scene.links = {{0, 1, 1000.0, 0.0, 0.0}};
    join(scene, viscous(engine::Power{0.5, 3.0}), 0.0);
    scene.step = 0.98 * stability_at_start(scene).certified.step;
    EXPECT_LE(largest_excursion(scene, 20000), 0.11);
  }
}

TEST(Certificate, LetsARootOfTheSpeedChatterAtNoMoreThanTwoHundredthsOfTheSpeedOfAHand) {
  for (const double exponent : {0.0, 0.5}) {
    NetworkDescription scene = mass_at(Vec3(0.1, 0, 0), 1, 1000.0);
    scene.mats[1].velocity = Vec3(0.002, 0, 0);
    join(scene, viscous(engine::Power{0.3, exponent}), 0.1);
    scene.step = 0.98 * stability_at_start(scene).certified.step;
    engine::World world(std::make_shared<const engine::Network>(scene));
    double fastest = 0.0;
    for (int n = 0; n < 2000; ++n) {
      world.step();
      fastest = std::max(fastest, world.velocity(1).norm());
    }
    EXPECT_LT(fastest, 0.02) << exponent;
  }
}

TEST(Certificate, JudgesAViscosityAtTheSpeedThatADriveOrAWeightHoldsAgainstIt) {
  NetworkDescription pushed = mass_at(Vec3::Zero(), 1, 15.3);
  join(pushed, viscous(engine::Power{0.01, 3.0}), 0.0);
  NetworkDescription heavy = pushed;
  heavy.gravity = Vec3(-1e5, 0, 0);  // 100 N, as the drive
  engine::TimeFunction function;
  function.formula[0] = Term(100.0).program;
  pushed.time_functions.push_back(function);
  engine::Drive drive;
  drive.mat = 1;
  drive.is_force = true;
  pushed.drives = {drive};
  // 0.01 v^3 = 100 N at 21.5 m/s, where the slope is 13.9 N s/m: 2 Z' = 4 at 144 us.
  for (const NetworkDescription& scene : {pushed, heavy}) {
    EXPECT_FALSE(stability_at_start(scene).holds());
    EXPECT_LT(stability_at_start(scene).certified.step, 1.44e-4);
    EXPECT_GT(stability_at_start(scene).certified.step, 1e-5);
  }
}

TEST(Certificate, JudgesTheViscosityOfAContactAtTheSpeedOfAFall) {
  NetworkDescription scene;
  scene.dimension = 2;
  scene.step = 1.0 / 375.0;
  scene.gravity = Vec3(0, -9.81, 0);
  scene.mats = {fixed(Vec3::Zero()), mass(kMass, Vec3(0, 10, 0))};
  engine::StateMachine law = contact(100.0);
  law.states[0].dissipation = engine::Power{0.2, 3.0};
  scene.state_machines.push_back(law);
  engine::SetLiaison set;
  set.set_p = {0};
  set.set_q = {1};
  set.range = set.rest_length = 0.01;
  scene.sets.push_back(set);
  const plan::Stability stability = stability_at_start(scene);
  EXPECT_FALSE(stability.holds());
  // 14 m/s: 3 * 0.2 * 196 = 118 N s/m, 2 Z' = 4 at 17 us.
  EXPECT_LT(stability.certified.step, 1.7e-5);
}

/// Lennard-Jones has no force at distance 0, and a force without a limit beside it.
TEST(Certificate, IsNotGivenToBallsThatStartAtOnePoint) {
  for (const int dimension : {1, 2, 3}) {
    for (const bool of_sets : {false, true}) {
      for (const double apart : {0.0, 0.0146}) {
        NetworkDescription scene = mass_at(Vec3(apart, 0, 0), dimension, 4000.0);
        scene.mats[1].mass = 0.0124;
        scene.mats[1].velocity = Vec3(0.01, 0, 0);
        scene.state_machines = {state_machine(0.0, engine::LennardJones{0.0082, 0.0146, 0.0437})};
        if (of_sets) {
          engine::SetLiaison set;
          set.set_p = {0};
          set.set_q = {1};
          set.range = 0.0437;
          set.rest_length = 0.0146;
          scene.sets = {set};
        } else {
          scene.state_links = {{0, 1, 0, 0.0146}};
        }
        EXPECT_EQ(stability_at_start(scene).uncertainty.has_value(), apart == 0.0)
            << dimension << "-D, sets: " << of_sets << ", " << apart << " m";
      }
    }
  }
}

TEST(Certificate, TakesNoNoticeOfFixedPointsAtOnePoint) {
  NetworkDescription scene = mass_at(Vec3(0.0146, 0, 0), 2, 4000.0);
  scene.mats[1].mass = 0.0124;
  scene.mats.push_back(scene.mats[0]);
  scene.state_machines = {state_machine(0.0, engine::LennardJones{0.0082, 0.0146, 0.0437})};
  engine::SetLiaison set;
  set.set_p = {0, 1, 2};
  set.range = 0.0437;
  set.rest_length = 0.0146;
  scene.sets = {set};
  EXPECT_FALSE(stability_at_start(scene).uncertainty.has_value());
}

TEST(Certificate, IsNotSureThatModesDivergeBySpeedsOfALaterTime) {
  NetworkDescription scene = mass_at(Vec3(0.1, 0, 0), 1, 2700.0);
  scene.integrator = engine::IntegratorKind::kModal;
  scene.links = {{0, 1, 1000.0, 0.0, 0.0}};
  join(scene, viscous(engine::Power{0.5, 3.0}), 0.0);
  EXPECT_FALSE(stability_at_start(scene).holds());
  EXPECT_FALSE(stability_at_start(scene).diverges());
}

TEST(Certificate, IsNotGivenToLawsThatDrive) {
  engine::StateMachine with_spring = viscous(expression_law(-0.03 * kV));
  with_spring.states[0].stiffness = 100.0;
  engine::StateMachine of_table = with_spring;
  of_table.states[0].dissipation = engine::Table({-100.0, 0.0, 100.0}, {3.0, 0.0, -3.0});
  const engine::StateMachine constant = viscous(engine::Table({-1.0, 0.0}, {60.0, 60.0}));
  const engine::StateMachine power = viscous(engine::Power{-0.5, 3.0});
  const engine::StateMachine elastic = state_machine(0.0, expression_law(100.0 * kE - 0.5 * kV));
  const engine::StateMachine apart = state_machine(0.0, expression_law(-20.0 * kE));
  for (const auto& law : {with_spring, of_table, constant, power, elastic, apart}) {
    NetworkDescription scene = mass_at(Vec3(0.1, 0, 0), 1, 1000.0);
    scene.links = {{0, 1, 10.0, 0.0, 0.0}};
    join(scene, law, 0.0);
    EXPECT_TRUE(stability_at_start(scene).uncertainty.has_value());
    EXPECT_FALSE(stability_at_start(scene).diverges());
  }
}

TEST(Certificate, IsGivenToLawsThatItsOwnSpringOrViscosityHolds) {
  engine::StateMachine held = state_machine(100.0, expression_law(-20.0 * kE));
  engine::StateMachine damped = viscous(expression_law(-0.03 * kV));
  damped.states[0].viscosity = 0.05;
  engine::StateMachine falls_while_it_slides =
      viscous(engine::Table({-1.0, -0.01, 0.01, 1.0}, {-0.1, -0.3, 0.3, 0.1}));
  for (const auto& law : {held, damped, falls_while_it_slides}) {
    NetworkDescription scene = mass_at(Vec3(0.1, 0, 0), 1, 44100.0);
    join(scene, law, 0.0);
    EXPECT_TRUE(stability_at_start(scene).holds());
  }
}

/// Why nothing is certain; empty where it is.
std::string why_uncertain(const NetworkDescription& scene) {
  const plan::Stability stability = stability_at_start(scene);
  return stability.uncertainty ? stability.uncertainty->why : "";
}

/// 1 at a place, and 0 from so far of it on.
Term window(const Term& where, double place, double width) {
  return two(Operation::kMax, 1.0 - size(where - place) / width, 0.0);
}

TEST(Certificate, IsNotGivenToALawThatDrivesOnlyAtAFewSpeeds) {
  const Term law = 0.05 * kV - 0.1 * kV * window(size(kV), 0.3701, 2e-3);
  for (const bool is_elastic : {false, true}) {
    NetworkDescription scene = mass_at(Vec3(0.1, 0, 0), 1, 44100.0);
    scene.links = {{0, 1, 10.0, 0.0, 0.0}};
    join(scene, is_elastic ? state_machine(0.0, expression_law(law)) : viscous(expression_law(law)),
         0.0);
    EXPECT_NE(why_uncertain(scene).find("drives the motion"), std::string::npos)
        << why_uncertain(scene);
    EXPECT_FALSE(stability_at_start(scene).diverges());
  }
}

TEST(Certificate, IsNotGivenWhereEnergyMayCrushALinkOfALawWithoutALargestSlope) {
  const engine::StateMachine machine = state_machine(0.0, engine::Power{1e4, 2.0});
  NetworkDescription scene = mass_at(Vec3(0.1, 0, 0), 2, 44100.0);
  join(scene, machine, 0.1);
  scene.mats[1].velocity = Vec3(20.0, 0, 0);
  EXPECT_EQ(why_uncertain(scene), "") << "0.2 J, and 0.8 J when two of them meet";
  scene.mats[1].velocity = Vec3(100.0, 0, 0);  // 5 J; 3.3 J crush the link
  EXPECT_NE(why_uncertain(scene).find("crush it to length 0"), std::string::npos)
      << why_uncertain(scene);
}

TEST(Certificate, IsGivenToAPowerOfTheFirstDegreeAndNotToOneBelow) {
  for (const auto& [exponent, is_jump] : {std::pair{0.5, true}, {1.0, false}, {1.5, false}}) {
    NetworkDescription scene = mass_at(Vec3(0.1, 0, 0), 1, 44100.0);
    join(scene, state_machine(0.0, engine::Power{10.0, exponent}), 0.1);
    EXPECT_EQ(!why_uncertain(scene).empty(), is_jump) << exponent << why_uncertain(scene);
  }
}

TEST(Certificate, IsGivenToExpressionsThatOpposeEverySpeed) {
  const Term smooth = one(Operation::kTanh, kV / 0.01);
  const std::vector<Term> laws = {0.01 * kV * kV * kV, 0.02 * kV * size(kV), 0.05 * smooth,
                                  0.05 * smooth / (1.0 + kV * kV)};
  for (std::size_t i = 0; i < laws.size(); ++i) {
    NetworkDescription scene = mass_at(Vec3(0.1, 0, 0), 1, 44100.0);
    scene.links = {{0, 1, 10.0, 0.0, 0.0}};
    NetworkDescription elastic = scene;
    join(scene, viscous(expression_law(laws[i])), 0.0);
    join(elastic, state_machine(0.0, expression_law(20.0 * kE + laws[i])), 0.0);
    EXPECT_EQ(why_uncertain(scene), "") << i;
    EXPECT_EQ(why_uncertain(elastic), "") << i;
  }
}

TEST(Certificate, IsNotGivenWhereAPotentialFallsWithoutAnEndBesideALawThatOnlyEnergyConfines) {
  const engine::StateMachine cubic = state_machine(0.0, engine::Power{3e4, 3.0});
  for (const engine::Law& law : {engine::Law(engine::Table({-10.0, 10.0}, {100.0, 100.0})),
                                 expression_law(50.0 - 0.0 * kE)}) {
    NetworkDescription scene = mass_at(Vec3(0.5, 0, 0), 1, 1000.0);
    join(scene, state_machine(0.0, law), 0.0);
    EXPECT_TRUE(stability_at_start(scene).holds()) << "a constant force by itself";
    join(scene, cubic, 0.5);
    EXPECT_TRUE(stability_at_start(scene).uncertainty.has_value());
  }
}

TEST(Certificate, CountsByHowMuchAPotentialFalls) {
  // From its start at 0.5 m the table drives the mass out with 100 N up to 1 m: 50 J, and 25 J on to 2 m.
  const engine::Table well({0.0, 1.0, 1.5, 2.0}, {-100.0, -100.0, 0.0, 0.0});
  NetworkDescription scene = mass_at(Vec3(0.5, 0, 0), 1, 1000.0);
  join(scene, state_machine(0.0, well), 0.0);
  EXPECT_TRUE(stability_at_start(scene).uncertainty.has_value()) << "its K' falls by 0.2";
  scene.step = 5e-4;
  EXPECT_FALSE(stability_at_start(scene).uncertainty.has_value());
  join(scene, state_machine(0.0, engine::Power{3e4, 3.0}), 0.5);
  const double limit = stability_at_start(scene).certified.step;
  // 7500 e^4 = 75 J: 9e4 e^2 = 9000 N/m, and 200 N/m of the well.
  EXPECT_LT(limit, 2.0 * std::sqrt(kMass / 9000.0));
}

/// Three masses on a line of heavy dampers, thrown so that it turns.
NetworkDescription chain_that_turns(double stiffness, double viscosity) {
  NetworkDescription scene;
  scene.dimension = 2;
  scene.integrator = engine::IntegratorKind::kLeapfrog;
  scene.step = 1e-3;
  scene.gravity = Vec3(0, -9.81, 0);
  scene.mats = {fixed(Vec3::Zero())};
  for (std::uint32_t i = 1; i <= 3; ++i) {
    scene.mats.push_back(mass(1e-3, Vec3(0.1 * i, 0, 0)));
    scene.mats.back().velocity = Vec3(0, 2, 0);
    scene.links.push_back({i - 1, i, stiffness, viscosity, 0.1});
  }
  return scene;
}

TEST(Certificate, HoldsForStiffHeavyDampersThatTurn) {
  for (const double stiffness : {50.0, 300.0, 900.0}) {  // K' = 0.1, 0.6, 1.8
    for (const double viscosity : {2.0, 20.0, 500.0}) {  // Z' = 4, 40, 1000
      const NetworkDescription scene = chain_that_turns(stiffness, viscosity);
      EXPECT_FALSE(stability_at_start(scene).uncertainty.has_value());

      World world = make_world(scene);
      const double begin = world.energy().total();
      double largest = begin;
      for (int n = 0; n < 2000; ++n) {
        world.step();
        largest = std::max(largest, world.energy().total());
      }
      EXPECT_LT(largest, 1.001 * begin) << stiffness << " N/m, " << viscosity << " N s/m";
    }
  }
}

/// Two masses on a heavy damper that turns by this angle in a step, one of them on a stiff spring.
NetworkDescription pair_that_turns(double angle, double viscosity) {
  NetworkDescription scene;
  scene.dimension = 2;
  scene.integrator = engine::IntegratorKind::kLeapfrog;
  scene.step = 1e-3;
  const double speed = 0.5 * angle / scene.step;
  scene.mats = {mass(0.1, Vec3::Zero()), mass(0.1, Vec3(1, 0, 0)), fixed(Vec3(1, 0, 0))};
  scene.mats[0].velocity = Vec3(0, -speed, 0);
  scene.mats[1].velocity = Vec3(0, speed, 0);
  scene.links = {{0, 1, 0.0, viscosity, 0.0}, {1, 2, 1e5, 0.0, 0.0}};  // K' = 1
  return scene;
}

TEST(Certificate, IsNotGivenToHeavyDampersThatTurnFarInAStep) {
  for (const double viscosity : {1e3, 1e6}) {  // Z' = 20, 20000
    const NetworkDescription slow = pair_that_turns(0.1, viscosity);
    EXPECT_FALSE(stability_at_start(slow).uncertainty.has_value());
    World world = make_world(slow);
    const double begin = world.energy().total();
    double largest = begin;
    for (int n = 0; n < 8000; ++n) {
      world.step();
      largest = std::max(largest, world.energy().kinetic + world.energy().elastic);
    }
    EXPECT_LT(largest, 1.4 * begin)
        << viscosity;  // the energy of one swing varies by 1 / (1 - K' / 4)
  }
  EXPECT_NE(why_uncertain(pair_that_turns(0.8, 1e6)).find("0.2 rad"), std::string::npos);
  EXPECT_FALSE(stability_at_start(pair_that_turns(0.8, 10.0)).uncertainty.has_value());  // Z' = 0.2
}

/// What is certain at a step is found for many steps, and the reach for one graph.
TEST(Certificate, OfDampersThatTurnTakesTheReachOfItsGraph) {
  const NetworkDescription slow = pair_that_turns(0.1, 1e3);
  EXPECT_FALSE(plan::uncertainty_of(slow, plan::liaison_graph(slow)));
  const auto wider = plan::uncertainty_of(slow, plan::liaison_graph(slow, 100.0));
  ASSERT_TRUE(wider) << "10 times as fast";
  EXPECT_NE(wider->why.find("0.2 rad"), std::string::npos) << wider->why;
}

TEST(Certificate, IsNotGivenToASetThatPushesAtItsRange) {
  NetworkDescription scene;
  scene.dimension = 2;
  scene.step = 1e-3;
  scene.mats = {mass(0.01, Vec3::Zero()), mass(0.01, Vec3(0.2, 0, 0))};
  scene.state_machines = {state_machine(1000.0)};
  scene.state_machines[0].states[0].pulls = false;
  scene.state_machines[0].states[0].viscosity = 0.1;
  engine::SetLiaison set;
  set.set_p = {0, 1};
  set.rest_length = 0.1;
  set.range = 0.1;
  scene.sets = {set};
  EXPECT_FALSE(stability_at_start(scene).uncertainty.has_value());
  scene.sets[0].range = 0.095;  // 5 N, a slow ball is thrown off with them
  EXPECT_EQ(why_uncertain(scene), "its force jumps at its range");
}

TEST(Certificate, IsNotGivenToASetOfOneDimensionThatPullsWhereItsEndsPass) {
  NetworkDescription scene;
  scene.dimension = 1;
  scene.step = 1e-3;
  scene.mats = {mass(0.01, Vec3::Zero()), mass(0.01, Vec3(0.2, 0, 0))};
  scene.state_machines = {state_machine(100.0)};
  engine::SetLiaison set;
  set.set_p = {0, 1};
  set.range = 0.5;
  scene.sets = {set};
  const char* const pulls = "it pulls where its ends pass each other, and jumps there";
  const auto is_told = [&] { return why_uncertain(scene) == pulls; };
  EXPECT_FALSE(is_told());  // from the rest length 0 on the tension is that of a spring
  scene.sets[0].rest_length = 0.1;
  EXPECT_FALSE(is_told());  // it pushes there
  scene.state_machines[0].states[0].elasticity = engine::Table({-0.1, 0.0}, {20.0, 0.0});
  EXPECT_TRUE(is_told());  // 10 N more than the spring pushes with
  scene.state_machines[0].states[0].pulls = false;
  EXPECT_FALSE(is_told());
  scene.state_machines[0].states[0].pulls = true;
  scene.dimension = 2;
  EXPECT_NE(why_uncertain(scene).find("turns there without a limit"), std::string::npos);
}

TEST(Certificate, OfAChoiceOfTheRateIsNotGivenEither) {
  NetworkDescription scene = mass_at(Vec3(1, 0, 0), 1, 200.0);
  join(scene, state_machine(0.0, engine::Table({-10.0, 10.0}, {100.0, 100.0})), 0.0);
  join(scene, state_machine(0.0, engine::Power{3e3, 3.0}), 0.0);
  EXPECT_TRUE(plan::uncertainty_of(scene, plan::liaison_graph(scene)).has_value());
}

TEST(Certificate, IsSurelyUnstableOfNothingThatAStepOfALawHolds) {
  const Term dry = Term(0.05) * one(Operation::kSign, kV);
  NetworkDescription scene = mass_at(Vec3(0.3, 0, 0), 1, 1000.0);
  join(scene, viscous(engine::Expression{dry.program}), 0.3);
  EXPECT_FALSE(stability_at_start(scene).diverges()) << "dry friction has no slope at rest";
  EXPECT_TRUE(stability_at_start(scene).uncertainty.has_value());
  // Another mass, on a spring too stiff for the step, is not held.
  scene.mats.push_back(mass(kMass, Vec3(0.6, 0, 0)));
  scene.links = {{0, 2, 1.1 * 4.0 * kMass * 1e6, 0.0, 0.6}};
  EXPECT_TRUE(stability_at_start(scene).diverges());
}

TEST(Certificate, CountsWhatPullsAcrossInASet) {
  NetworkDescription scene;
  scene.dimension = 2;
  scene.step = 5e-4;
  scene.mats = {mass(kMass, Vec3::Zero()), mass(kMass, Vec3(0.03, 0.001, 0))};
  // It ends where the ends are near, so that it may pull up to there.
  scene.state_machines.push_back(
      with_exit(state_machine(0.0, engine::Table({-1.0, 1.0}, {5.0, 5.0})), kE < 0.01));
  engine::SetLiaison set;
  set.set_p = {0, 1};
  set.range = 0.1;
  scene.sets.push_back(set);
  const plan::Stability stability = stability_at_start(scene);
  EXPECT_LE(stability.certified.step, stability.diverging_step * (1.0 + 1e-9));
  const bool crosses = stability.uncertainty && stability.uncertainty->why == plan::kLimitsCross;
  EXPECT_FALSE(crosses);
}

TEST(Certificate, TakesAnExitForTheEndOfAPullOnlyWhereItsEndsMeet) {
  const auto is_uncertain = [](const Term& when, double tension) {
    NetworkDescription scene = mass_at(Vec3(0.05, 0.0003, 0), 2, 1000.0);
    join(scene,
         with_exit(state_machine(0.0, engine::Table({-10.0, 10.0}, {tension, tension})), when),
         0.0);
    return stability_at_start(scene).uncertainty.has_value();
  };
  const Term age = q(Quantity::kAge);
  const Term force = q(Quantity::kForce);
  const Term d = q(Quantity::kDistance);
  EXPECT_TRUE(is_uncertain(kE > 100.0, 0.01));
  EXPECT_TRUE(is_uncertain(two(Operation::kAnd, age > 5.0, d < 0.02), 0.01));
  EXPECT_TRUE(is_uncertain(two(Operation::kAnd, age < 5.0, d < 0.02), 0.01));
  EXPECT_TRUE(is_uncertain(force > 0.02, 0.01)) << "it never pulls that much";
  EXPECT_FALSE(is_uncertain(d < 0.02, 0.01));
  EXPECT_FALSE(is_uncertain(two(Operation::kOr, age > 5.0, d < 0.02), 0.01));
  EXPECT_FALSE(is_uncertain(force > 0.005, 0.01));
  EXPECT_FALSE(is_uncertain(kV < -0.1, 0.01));
}

TEST(Certificate, CallsNothingSurelyUnstableThatDoesNotActAtTheStart) {
  NetworkDescription apart = mass_at(Vec3(0.1, 0, 0), 1, 1000.0);
  join(apart, contact(1e6), -5.0);
  NetworkDescription not_entered = mass_at(Vec3(0.1, 0, 0), 1, 1000.0);
  engine::StateMachine soft = with_exit(state_machine(100.0), kE > 10.0);
  soft.states[1].stiffness = 1e6;
  join(not_entered, soft, 0.0);
  NetworkDescription balls;
  balls.dimension = 2;
  balls.step = 1e-3;
  balls.mats = {mass(kMass, Vec3::Zero()), mass(kMass, Vec3(1000, 0, 0))};
  balls.state_machines.push_back(contact(1e6));
  engine::SetLiaison set;
  set.set_p = {0, 1};
  set.rest_length = set.range = 0.02;
  balls.sets.push_back(set);
  for (const NetworkDescription& scene : {apart, not_entered, balls}) {
    EXPECT_FALSE(stability_at_start(scene).diverges());
    EXPECT_FALSE(stability_at_start(scene).holds());
  }
  apart.state_links[0].rest_length = 0.2;  // pressed
  EXPECT_TRUE(stability_at_start(apart).diverges());
}

}  // namespace
}  // namespace cordis::test
