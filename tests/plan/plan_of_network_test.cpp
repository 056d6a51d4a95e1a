// tests/plan/plan_of_network_test.cpp
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <random>
#include <utility>

#include <gtest/gtest.h>

#include "sim_node/engine/world.h"
#include "sim_node/plan/plan.h"
#include "tests/engine/programs.h"
#include "tests/plan/networks.h"
#include "tests/support/rounds.h"
#include "tests/support/test_seed.h"

namespace cordis::test {
namespace {

using engine::Operation;
using engine::Quantity;
using plan::Plan;
using plan::plan_of;

TEST(Plan, DistinguishesStableFromUnstable) {
  // K' = 4 at 0.02 s
  const Plan stable = plan_of(oscillator(0.1, 1000.0, 0.0, 1.0, 0.0, 0.01), 1.0);
  EXPECT_TRUE(stable.stability.holds());
  EXPECT_FALSE(stable.stability.diverges());
  EXPECT_NEAR(stable.margin(), 0.75, 1e-9);

  const Plan unstable = plan_of(oscillator(0.1, 1000.0, 0.0, 1.0, 0.0, 0.021), 1.0);
  EXPECT_FALSE(unstable.stability.holds());
  EXPECT_TRUE(unstable.stability.diverges());
}

TEST(Plan, OnlyWhatActsAtSomeTimesIsAContact) {
  // a spring of K' = 0.1, and a link with states of K' = 0.01
  NetworkDescription scene = oscillator(0.1, 1000.0, 0.0, 1.0, 0.0, std::sqrt(1e-5));
  EXPECT_FALSE(plan_of(scene, 1.0).worst_contact.has_value());

  const auto with_states = [&](const StateMachine& machine) {
    scene.state_machines = {machine};
    scene.state_links = {{0, 1, 0, 1.0}};
    return plan_of(scene, 1.0).worst_contact;
  };
  Behaving held;
  held.state(100.0);
  EXPECT_FALSE(with_states(held.state_machine).has_value());
  Behaving changing = held;
  changing.exit(q(Quantity::kElongation) > 0.5, 1).state(50.0);
  for (const StateMachine& machine : {contact(100.0), changing.state_machine}) {
    const std::optional<plan::ContactGain> gain = with_states(machine);
    ASSERT_TRUE(gain.has_value());
    EXPECT_EQ(gain->liaison.kind, engine::LiaisonKind::kStateLink);
    EXPECT_NEAR(gain->stiffness, 0.01, 1e-9);
  }
}

TEST(Plan, BoundsTheViscosityOfTheBandByThatOfItsLinks) {
  // Z / K = 1e-4 s in every link: a vibration of 10 Hz has Z / m = w^2 1e-4, and 0.3 of the medium.
  NetworkDescription scene = string_in_space(20, 0.04, 1e-4);
  scene.medium_viscosity = 3e-4;
  const double w = 20.0 * M_PI;

  EXPECT_NEAR(plan_of(scene, 10.0).band_edge.viscosity, w * w * 1e-4 + 0.3, 1e-9);
}

TEST(Plan, BoundsTheViscosityOfTheBandByThatOfItsSets) {
  NetworkDescription scene;
  scene.dimension = 3;
  scene.step = 1e-4;
  engine::StateMachine machine = contact(200.0);
  machine.states[0].viscosity = 0.05;
  scene.state_machines.push_back(machine);
  engine::SetLiaison set;
  for (std::uint32_t i = 0; i < 4; ++i) {
    set.set_p.push_back(i);
    scene.mats.push_back(mass(0.1, Vec3(0.02 * i, 0, 0)));
    scene.radius.push_back(0.01);
  }
  set.rest_length = -1.0;
  set.range = 0.02;
  scene.sets.push_back(set);
  const double w = 20.0 * M_PI;

  EXPECT_NEAR(plan_of(scene, 10.0).band_edge.viscosity, w * w * 0.05 / 200.0, 1e-9);
}

TEST(Plan, SaysWhatASwitchingMayGain) {
  NetworkDescription scene = oscillator(0.1, 0.0, 0.0, 1.0, 0.0, 1e-3);
  EXPECT_FALSE(plan_of(scene, 10.0).worst_contact.has_value());
  scene.links.clear();
  scene.state_machines.push_back(contact(4000.0));
  scene.state_links = {{0, 1, 0, 0.0}};

  const Plan plan = plan_of(scene, 10.0);

  ASSERT_TRUE(plan.worst_contact.has_value());
  EXPECT_NEAR(plan.worst_contact->stiffness, 0.04, 1e-12);
  EXPECT_NEAR(plan.worst_contact->worst, 1.0 / 0.99 - 1.0, 1e-12);  // 1 / (1 - K'/4) - 1
}

/// A mass this far from a fixed point, with a law between them.
NetworkDescription mass_on_law(int dimension, double weight, const Vec3& place,
                               const Vec3& velocity, engine::StateMachine law, double rest) {
  NetworkDescription scene;
  scene.dimension = dimension;
  scene.step = 1e-3;
  scene.mats = {fixed(Vec3::Zero()), mass(weight, place)};
  scene.mats[1].velocity = velocity;
  scene.state_machines.push_back(std::move(law));
  scene.state_links = {{0, 1, 0, rest}};
  return scene;
}

TEST(Plan, DoesNotCallAHammerUnstableThatIsStillAwayFromItsString) {
  engine::StateMachine hammer = state_machine(0.0, engine::Power{3e8, 2.5});
  hammer.states[0].pulls = false;
  NetworkDescription scene = mass_on_law(1, 0.009, Vec3(0.04, 0, 0), Vec3(-1.5, 0, 0), hammer, 0.0);
  scene.step = 1.0 / 44100.0;

  const plan::Stability stability = plan_of(scene, 10.0).stability;

  EXPECT_FALSE(stability.diverges());
  EXPECT_TRUE(stability.holds());
}

TEST(Plan, AFeltHammerAtItsRateBringsInNoEnergy) {
  // a string of 4 g, 220 Hz, and a hammer of 8 g that comes from 5 mm away
  engine::StateMachine felt = state_machine(0.0, engine::Power{4e8, 2.5});
  felt.states[0].pulls = false;
  NetworkDescription scene =
      mass_on_law(1, 0.008, Vec3(-0.005, 0, 0), Vec3(2, 0, 0), std::move(felt), 0.0);
  scene.step = 1.0 / 48000.0;
  constexpr std::uint32_t kCount = 102;
  for (std::uint32_t i = 1; i < kCount; ++i) {
    const auto now = static_cast<std::uint32_t>(scene.mats.size());
    const bool is_end = i + 1 == kCount;
    scene.mats.push_back(is_end ? fixed(Vec3::Zero()) : mass(4e-5, Vec3::Zero()));
    scene.links.push_back({i == 1 ? 0U : now - 1, now, 80000.0, 0.002, 0.0});
  }
  scene.state_links = {{1, 13, 0, 0.0}};  // the hammer, string[12]
  EXPECT_FALSE(plan_of(scene, 10.0).stability.diverges());

  World world = make_world(scene);
  const double start = 0.5 * 0.008 * 2.0 * 2.0;
  double stored = 0.0;
  for (int n = 0; n < 24'000; ++n) {
    world.step();
    const engine::Energy energy = world.energy();
    ASSERT_LT(energy.kinetic + energy.elastic, 1.01 * start) << "step " << n;
    stored = std::max(stored, energy.elastic);
  }
  EXPECT_GT(stored, 0.1 * start) << "it has struck";
  EXPECT_LT(std::abs(world.energy().integration_error()), 0.01 * start);
}

TEST(Plan, IsNotCertainOfAContactThatGainsEnergyAtEachTouch) {
  engine::StateMachine thread = state_machine(2500.0);
  thread.states[0].pushes = false;
  const auto stability_at = [&](double stiffness, double viscosity = 0.0) {
    thread.states[0].stiffness = stiffness;
    thread.states[0].viscosity = viscosity;
    return plan_of(mass_on_law(2, 0.001, Vec3(0.2, 0, 0), Vec3::Zero(), thread, 0.2), 10.0)
        .stability;
  };
  const plan::Stability stiff = stability_at(2500.0, 1.0);  // K' = 2.5
  EXPECT_FALSE(stiff.holds());
  EXPECT_FALSE(stiff.diverges());
  ASSERT_TRUE(stiff.uncertainty.has_value());
  EXPECT_EQ(stiff.uncertainty->liaison.index, 0u);
  // What a touch of K' = 0.5 may gain at most, its viscosity takes where 2 pi zeta is more than -ln(1 - K'/4).
  const double enough = -std::log1p(-0.125) * 500.0 * 1e-3 / (std::numbers::pi * std::sqrt(0.5));
  EXPECT_FALSE(stability_at(500.0).holds());
  EXPECT_FALSE(stability_at(500.0, 0.99 * enough).holds());
  EXPECT_TRUE(stability_at(500.0, 1.01 * enough).holds());
  EXPECT_FALSE(stability_at(500.0, 1.01 * enough).touching.has_value());
  EXPECT_TRUE(stability_at(99.0).holds());
  EXPECT_TRUE(stability_at(99.0).touching.has_value()) << "it is watched";
  EXPECT_FALSE(stability_at(9.0).touching.has_value());
}

/// The most that a mass rises to that falls again and again on a contact, over where it began.
/// @param damping  Z' / K'
double rise_after_falls(double number, double damping, double height, double weight) {
  StateMachine law = contact(number);
  law.states[0].viscosity = damping * number;
  NetworkDescription scene = mass_on_law(1, 1.0, Vec3(height, 0, 0), Vec3::Zero(), law, 0.0);
  scene.step = 1.0;
  scene.gravity = Vec3(-weight, 0, 0);
  World world = make_world(scene);
  double highest = height;
  for (int step = 0; step < 20'000; ++step) {
    world.step();
    highest = std::max(highest, world.position(1).x());
  }
  return highest / height;
}

TEST(Plan, IsCertainOfContactsWhoseViscosityTakesWhatTouchesGain) {
  std::mt19937 random(test_seed());
  std::uniform_real_distribution<double> share;
  for (int n = 0; n < rounds(60); ++n) {
    const double height = std::pow(10.0, 2.0 * share(random) - 2.0);
    const double weight = std::pow(10.0, 2.0 * share(random) - 5.0);
    const double number = 0.1 + 0.9 * share(random);
    const double enough = -std::log1p(-0.25 * number) / (std::numbers::pi * std::sqrt(number));
    EXPECT_LT(rise_after_falls(number, enough, height, weight), 1.2) << number;
    EXPECT_LT(rise_after_falls(0.1 * share(random), 0.0, height, weight), 4.0);
  }
  EXPECT_GT(rise_after_falls(0.8, 0.0, 0.02, 3e-4), 10.0) << "without viscosity";
}

TEST(Plan, AddsUpContactsThatTouchOneMassTogether) {
  // Each has K' = 0.499.
  const auto plan_with = [](std::size_t count, int dimension) {
    StateMachine law = contact(499e3);
    law.states[0].viscosity = 50.0;
    NetworkDescription scene =
        mass_on_law(dimension, 1.0, Vec3(1e-5, 0, 0), Vec3::Zero(), law, 0.0);
    scene.state_links.resize(count, scene.state_links[0]);
    return plan_of(scene, 10.0);
  };
  const plan::Plan two = plan_with(2, 1);
  EXPECT_TRUE(two.stability.holds());
  EXPECT_NEAR(two.worst_contact->stiffness, 0.998, 1e-9);
  for (const int dimension : {1, 2, 3}) {
    const plan::Plan four = plan_with(4, dimension);
    EXPECT_FALSE(four.stability.holds());
    EXPECT_NEAR(four.worst_contact->stiffness, 1.996, 1e-9);
    ASSERT_TRUE(four.stability.uncertainty.has_value());
    EXPECT_NE(four.stability.uncertainty->why.find("together"), std::string::npos);
  }
}

TEST(Plan, AddsUpNoContactsOfTwoSidesOfALine) {
  NetworkDescription scene =
      mass_on_law(1, 1.0, Vec3(1e-5, 0, 0), Vec3::Zero(), contact(800e3), 0.0);
  scene.mats.push_back(fixed(Vec3(0.1, 0, 0)));
  scene.state_links.push_back({1, 2, 0, 0.0});
  EXPECT_NEAR(plan_of(scene, 10.0).worst_contact->stiffness, 0.8, 1e-9);
  scene.state_links[1] = {2, 1, 0, 0.0};  // pushes it the same way
  EXPECT_NEAR(plan_of(scene, 10.0).worst_contact->stiffness, 1.6, 1e-9);
}

/// A ball of 1 kg that touches fixed points with K' = 0.499 each.
NetworkDescription ball_on_points(const std::vector<Vec3>& points, double range) {
  NetworkDescription scene;
  scene.dimension = 2;
  scene.step = 1e-3;
  scene.state_machines.push_back(contact(499e3));
  engine::SetLiaison set;
  for (const Vec3& place : points) {
    set.set_p.push_back(static_cast<std::uint32_t>(scene.mats.size()));
    scene.mats.push_back(fixed(place));
  }
  set.set_q = {static_cast<std::uint32_t>(scene.mats.size())};
  scene.mats.push_back(mass(1.0, Vec3(0, 1.003, 0)));
  set.rest_length = set.range = range;
  scene.sets.push_back(set);
  return scene;
}

TEST(Plan, AddsUpThePairsOfASetOnOneSideOfAMass) {
  const plan::Plan near = plan_of(
      ball_on_points({{-0.003, 0, 0}, {-0.001, 0, 0}, {0.001, 0, 0}, {0.003, 0, 0}}, 1.0), 10.0);
  EXPECT_FALSE(near.stability.holds());
  EXPECT_NEAR(near.worst_contact->stiffness, 1.996, 1e-6);
  // One that lies between four that are far from each other has one or two on a side.
  const plan::Plan far =
      plan_of(ball_on_points({{-1, 1, 0}, {1, 1, 0}, {0, 0, 0}, {0, 2, 0}}, 1.0), 10.0);
  EXPECT_LE(far.worst_contact->stiffness, 2.0 * 0.998);
  EXPECT_GE(far.worst_contact->stiffness, 0.499);
}

TEST(Plan, NamesTheStepUpToWhichItIsCertain) {
  engine::StateMachine thread = state_machine(2500.0);
  thread.states[0].pushes = false;
  NetworkDescription scene = mass_on_law(2, 0.001, Vec3(0.2, 0, 0), Vec3::Zero(), thread, 0.2);
  const double at_one = std::sqrt(0.001 / 2500.0);  // K' = 1; certified up to K' + 2 Z' = 4
  scene.state_machines[0].states[0].viscosity = 0.1 * 2500.0 * at_one;
  for (const double part : {0.1, 0.99, 1.01, 1.5, 3.0}) {
    scene.step = part * at_one;
    const plan::Plan plan = plan_of(scene, 10.0);
    EXPECT_NEAR(plan.certain_step, at_one, 1e-6 * at_one) << part;
    EXPECT_EQ(plan.stability.holds(), part < 1.0) << part;
  }
  scene.state_machines[0].states[0].pushes = true;  // a spring: nothing comes and goes
  const plan::Plan plan = plan_of(scene, 10.0);
  EXPECT_EQ(plan.certain_step, plan.stability.certified.step);
  scene.dimension = 1;
  scene.state_machines[0].states[0].elasticity = engine::Power{-1e3, 3.0};  // drives the ends apart
  EXPECT_EQ(plan_of(scene, 10.0).certain_step, 0.0);
}

TEST(Plan, IsNotCertainOfALawThatBendsTooSharplyForItsStep) {
  // A mass on a spring that is flat from 10 mm on, let go of at 0.3 m and more: no tangent is above K.
  const auto scene_at = [](double stiffness, double start) {
    const engine::Table law{{-0.01, 0.0, 0.01}, {-0.01 * stiffness, 0.0, 0.01 * stiffness}};
    NetworkDescription scene =
        mass_on_law(1, 0.001, Vec3(start, 0, 0), Vec3::Zero(), state_machine(0.0, law), 0.0);
    scene.step = 1e-3;
    return scene;
  };
  const auto growth = [&](double stiffness) {
    double most = 0.0;
    for (int place = 0; place < 8; ++place) {
      const NetworkDescription scene = scene_at(stiffness, 0.3 + 0.0137 * place);
      engine::World world(std::make_shared<const engine::Network>(scene));
      const double start = world.energy().elastic;
      for (int n = 0; n < 20000; ++n) {
        world.step();
        if (n % 10 == 0) most = std::max(most, world.energy().integration_error() / start);
      }
    }
    return most;
  };
  const plan::Stability sharp = plan_of(scene_at(2000.0, 0.3), 10.0).stability;  // K' = 2
  EXPECT_FALSE(sharp.holds());
  EXPECT_FALSE(sharp.diverges());
  ASSERT_TRUE(sharp.uncertainty.has_value());
  EXPECT_EQ(sharp.uncertainty->liaison.index, 0u);
  EXPECT_GT(growth(2000.0), 3.0);
  EXPECT_FALSE(plan_of(scene_at(790.0, 0.3), 10.0).stability.holds());
  EXPECT_GT(growth(790.0), 1.0);
  EXPECT_TRUE(plan_of(scene_at(99.0, 0.3), 10.0).stability.holds());
  EXPECT_LT(growth(99.0), 0.6);
  EXPECT_TRUE(plan_of(scene_at(20.0, 0.3), 10.0).stability.holds());
  EXPECT_LT(growth(20.0), 0.2);
}

TEST(Plan, IsCertainOfABendThatTheEnergyOfTheStartDoesNotReach) {
  // K' = 0.5 with a force limit, of 1 kg: what a hand may bring in stores up to 1 N m, at 2 mm.
  const auto stability_with = [](double limit) {
    StateMachine law = state_machine(5e5);
    law.states[0].force_limit = limit;
    return plan_of(mass_on_law(1, 1.0, Vec3(1e-3, 0, 0), Vec3::Zero(), law, 0.0), 10.0).stability;
  };
  const plan::Stability far = stability_with(1e4);
  EXPECT_TRUE(far.holds());
  EXPECT_TRUE(far.bending.has_value()) << "it is watched";
  EXPECT_FALSE(stability_with(500.0).holds());
}

TEST(Plan, IsCertainOfALawThatOnlyBecomesStiffer) {
  const auto holds = [](const engine::Law& law) {
    const NetworkDescription scene =
        mass_on_law(1, 1.0, Vec3(1e-3, 0, 0), Vec3::Zero(), state_machine(0.0, law), 0.0);
    return plan_of(scene, 10.0).stability.holds();
  };
  const engine::Table stiffer{{-0.1, -1e-3, 1e-3, 0.1}, {-5e4, -300.0, 300.0, 5e4}};
  const engine::Table softer{{-0.1, -1e-3, 1e-3, 0.1}, {-3e4, -500.0, 500.0, 3e4}};
  EXPECT_TRUE(holds(stiffer)) << "K' = 0.3 to 0.5";
  EXPECT_FALSE(holds(softer)) << "K' = 0.5 to 0.3";
}

TEST(Plan, LooksForBendsAtDistancesThatThereAre) {
  // exp(-20 distance) is steep at distances below 0, which a line alone has.
  const Term push = one(Operation::kExp, -20.0 * q(Quantity::kDistance));
  StateMachine law = state_machine(10.0, expression_law(-1.0 * push));
  const auto scene_of = [&](int dimension) {
    return mass_on_law(dimension, 0.01, Vec3(0.1, 0, 0), Vec3::Zero(), law, 0.1);
  };
  EXPECT_FALSE(plan_of(scene_of(2), 10.0).stability.bending.has_value());
}

TEST(Plan, IsNotCertainOfABendBesideAStiffVibration) {
  // A mass on a spring, with a stop that it just touches, K' of both: a third of a turn in a step
  // passes the bend in step with itself.
  const auto scene_at = [](double spring, double stop) {
    NetworkDescription scene =
        mass_on_law(1, 1.0, Vec3(0.11, 0, 0), Vec3::Zero(), contact(stop), 0.1);
    scene.step = 1.0;
    scene.links = {{0, 1, spring, 0.0, 0.1}};
    return scene;
  };
  const auto holds = [&](double spring, double stop) {
    NetworkDescription scene = scene_at(spring, stop);
    scene.state_machines[0].states[0].viscosity = 0.1 * stop;  // it takes what touches alone gain
    return plan_of(scene, 1e-3).stability.holds();
  };
  EXPECT_FALSE(holds(2.6, 0.8));
  EXPECT_GT(largest_excursion(scene_at(2.6, 0.8), 2000), 1e3);
  EXPECT_TRUE(holds(0.3, 0.8));
  EXPECT_LT(largest_excursion(scene_at(0.3, 0.8), 20000), 0.2);
  EXPECT_FALSE(holds(2.9, 0.25));
  EXPECT_TRUE(holds(2.6, 0.2));
  EXPECT_LT(largest_excursion(scene_at(2.6, 0.2), 20000), 0.2);
}

TEST(Plan, IsNotCertainOfAMaxwellElementThatStartsTooStrong) {
  NetworkDescription scene;
  scene.dimension = 2;
  scene.step = 1e-3;
  scene.mats = {fixed(Vec3::Zero()), mass(0.1, Vec3(0.5, 0, 0))};
  scene.maxwell_links = {{0, 1, 100.0, 5.0, 49.0}};
  EXPECT_FALSE(plan_of(scene, 10.0).stability.uncertainty.has_value());

  scene.maxwell_links[0].start_force = 51.0;
  EXPECT_TRUE(plan_of(scene, 10.0).stability.uncertainty.has_value());
}

TEST(Plan, IsNotCertainOfAnOrbitAboutARingThatPulls) {
  const engine::StateMachine law = state_machine(0.0, engine::Rings{{{-800.0, 0.12}}});
  EXPECT_FALSE(plan_of(mass_on_law(2, 0.002, Vec3(0.06, 0.002, 0), Vec3(0, 0.1, 0), law, 0.0), 10.0)
                   .stability.holds());
  // On a line it pulls ever harder through the centre and beyond.
  EXPECT_FALSE(plan_of(mass_on_law(1, 0.002, Vec3(0.06, 0, 0), Vec3::Zero(), law, 0.0), 10.0)
                   .stability.holds());
}

TEST(Plan, SeesTheViscosityThatAnExpressionHasInItsElasticity) {
  const Term tension = 90.0 * q(Quantity::kElongation) + 4.0 * q(Quantity::kSpeed);
  const plan::Stability stability =
      plan_of(mass_on_law(2, 0.001, Vec3(0.1, 0, 0), Vec3(0.2, 0, 0),
                          state_machine(0.0, expression_law(tension)), 0.1),
              10.0)
          .stability;
  EXPECT_TRUE(stability.diverges());  // Z' = 4
}

/// A random law of any kind, gentle to wild.
engine::StateMachine random_state_machine(std::mt19937& random) {
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution(low, high)(random);
  };
  const Term d = q(Quantity::kDistance);
  const Term e = q(Quantity::kElongation);
  const Term v = q(Quantity::kSpeed);
  engine::Law law;
  switch (random() % 6) {
    case 0:
      law = engine::Table({-0.2, between(-0.1, 0.0), 0.1},
                          {between(-9.0, 3.0), 0.0, between(0.0, 9.0)});
      break;
    case 1:
      law = engine::Power{between(-5.0, 300.0), 0.5 * static_cast<double>(random() % 9)};
      break;
    case 2:
      law = engine::LennardJones{between(0.0, 0.1), between(0.05, 0.3)};
      break;
    case 3:
      law = engine::Rings{{{between(-50.0, 200.0), 0.1}, {between(-50.0, 90.0), 0.4}}};
      break;
    case 4:
      law = expression_law(between(-20.0, 90.0) * e + between(-500.0, 500.0) * e * e * e +
                           between(-0.1, 0.3) * v + one(Operation::kTanh, between(-9.0, 9.0) * e) +
                           between(0.0, 5.0) * q(Quantity::kMassB) * d);
      break;
    default:
      break;
  }
  engine::StateMachine machine = state_machine(random() % 2 == 0 ? between(0.0, 200.0) : 0.0, law);
  machine.states[0].viscosity = random() % 3 == 0 ? between(0.0, 0.5) : 0.0;
  machine.states[0].pulls = random() % 3 != 0;
  machine.states[0].pushes = !machine.states[0].pulls || random() % 4 != 0;
  return machine;
}

NetworkDescription random_scene(unsigned seed) {
  std::mt19937 random(seed);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution(low, high)(random);
  };
  NetworkDescription scene;
  scene.dimension = 1 + static_cast<int>(random() % 3);
  scene.step = 1e-3;
  const auto place = [&] {
    return Vec3(between(-0.3, 0.3), scene.dimension > 1 ? between(-0.3, 0.3) : 0.0,
                scene.dimension > 2 ? between(-0.3, 0.3) : 0.0);
  };
  scene.mats.push_back(fixed(place()));
  for (int i = 0; i < 5; ++i) {
    scene.mats.push_back(mass(between(0.001, 0.1), place()));
    scene.mats.back().velocity = 3.0 * place();
  }
  for (std::uint32_t l = 0; l < 6; ++l) {
    scene.state_machines.push_back(random_state_machine(random));
    const auto a = static_cast<std::uint32_t>(random() % 6);
    const auto b = static_cast<std::uint32_t>((a + 1 + random() % 5) % 6);
    scene.state_links.push_back(
        {a, b, l, scene.dimension == 1 ? between(-0.1, 0.4) : between(0.0, 0.4)});
  }
  if (random() % 2 == 0) {
    engine::SetLiaison set;
    set.state_machine = static_cast<std::uint32_t>(random() % 6);
    set.set_p = {1, 2, 3, 4, 5};
    set.rest_length = set.range = 0.2;
    scene.sets.push_back(set);
  }
  return scene;
}

TEST(Plan, NeverCertifiesWhatSurelyDiverges) {
  const std::uint32_t first = test_seed();
  int certain = 0;
  for (unsigned seed = first; seed < first + 300; seed += kSeedStride) {
    const NetworkDescription scene = random_scene(seed);
    const plan::Stability stability = plan_of(scene, 10.0).stability;
    EXPECT_FALSE(stability.holds() && stability.diverges()) << "seed " << seed;
    const bool crosses = stability.uncertainty && stability.uncertainty->why == plan::kLimitsCross;
    EXPECT_FALSE(crosses) << "seed " << seed << ", " << scene.dimension << "-D, at link "
                          << stability.certified.liaison->index << " of kind "
                          << static_cast<int>(stability.certified.liaison->kind);
    certain += stability.uncertainty ? 0 : 1;
  }
  EXPECT_GT(certain, rounds(10));
}

}  // namespace
}  // namespace cordis::test
