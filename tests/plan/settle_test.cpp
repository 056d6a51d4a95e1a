// tests/plan/settle_test.cpp -- where a network comes to rest.
#include "sim_node/plan/settle.h"

#include <cmath>
#include <memory>
#include <random>

#include <gtest/gtest.h>

#include "sim_node/engine/world.h"
#include "sim_node/plan/plan.h"
#include "sim_node/plan/stability/liaison_graph.h"
#include "tests/engine/rubbing.h"
#include "tests/support/rounds.h"

namespace cordis::plan {
namespace {

using engine::MatKind;
using engine::NetworkDescription;
using engine::Vec3;

constexpr double kMass = 0.01;      // [kg]
constexpr double kStiffness = 500;  // [N/m]
constexpr double kRest = 0.1;       // [m]
constexpr double kG = 9.81;         // [m/s^2]

NetworkDescription chain(std::size_t count, bool both_ends) {
  NetworkDescription network;
  network.dimension = 2;
  network.step = 1e-3;
  network.gravity = Vec3(0, -kG, 0);
  for (std::size_t i = 0; i < count; ++i) {
    const bool is_fixed = i == 0 || (both_ends && i + 1 == count);
    const Vec3 place(kRest * static_cast<double>(i), 0, 0);
    network.mats.push_back(
        {is_fixed ? MatKind::kFixed : MatKind::kMass, is_fixed ? 0.0 : kMass, place, Vec3::Zero()});
    if (i == 0) continue;
    const auto b = static_cast<std::uint32_t>(i);
    network.links.push_back({b - 1, b, kStiffness, 0.02, kRest});
  }
  return network;
}

TEST(Settle, HangsAChainBelowItsNail) {
  NetworkDescription network = chain(11, false);
  for (engine::Mat& mat : network.mats) mat.position = Vec3(0, -mat.position.x(), 0);

  const Settled rest = settle(network, {1e-9, 200'000});

  ASSERT_LT(rest.force, 1e-9);
  double y = 0.0;
  for (std::size_t i = 1; i < 11; ++i) {
    const double carried = static_cast<double>(11 - i) * kMass * kG;
    y -= kRest + carried / kStiffness;
    // each link is out by what is left over K, 1e-9 / 500 m for each mass below it
    EXPECT_NEAR(rest.position[i].y(), y, 11 * 11 * 1e-9 / kStiffness);
    EXPECT_NEAR(rest.position[i].x(), 0.0, 1e-9);
  }
}

/// The hanging string of the language: 81 masses of 10 g below a nail.
TEST(Settle, HangsALongChainAtAnyRateThatHoldsIt) {
  for (const double number : {0.05, 0.2, 0.4, 0.8}) {  // K' of a link
    NetworkDescription network = chain(82, false);
    for (engine::Mat& mat : network.mats) mat.position = Vec3(0, -mat.position.x(), 0);
    network.step = std::sqrt(number * kMass / kStiffness);

    const Settled rest = settle(network, {1e-6, 20'000});

    EXPECT_LT(rest.force, 1e-6) << number << " in " << rest.steps << " steps";
    EXPECT_NEAR(rest.position[81].y(), -81 * kRest - 81 * 41 * kMass * kG / kStiffness, 1e-5);
  }
}

struct Uniform {
  std::mt19937 random;

  double operator()(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  }
};

/// A chain, or a net that is fastened at its upper edge and hangs askew, of masses and springs of all sizes.
NetworkDescription hanging(Uniform& draw) {
  NetworkDescription network;
  const bool is_net = draw(0, 1) < 0.5;
  network.dimension = is_net || draw(0, 1) < 0.5 ? 3 : 2;
  network.gravity = Vec3(0, -kG, 0);
  const auto columns = static_cast<std::uint32_t>(is_net ? draw(2, 9) : 1.0);
  const auto rows = static_cast<std::uint32_t>(is_net ? draw(3, 14) : draw(5, 120));
  const double slant = draw(-1.0, 1.0);
  const double usual_mass = std::exp(draw(std::log(1e-3), std::log(1.0)));
  const double usual_stiffness = draw(200.0, 5000.0) * usual_mass / kMass;
  for (std::uint32_t row = 0; row < rows; ++row) {
    for (std::uint32_t column = 0; column < columns; ++column) {
      const std::uint32_t here = row * columns + column;
      const Vec3 place(kRest * (column + slant * row), -kRest * row, 0);
      const MatKind kind = row == 0 ? MatKind::kFixed : MatKind::kMass;
      network.mats.push_back(
          {kind, row == 0 ? 0.0 : usual_mass * draw(0.5, 2.0), place, Vec3::Zero()});
      const auto join = [&](std::uint32_t other) {
        network.links.push_back({other, here, usual_stiffness * draw(0.5, 2.0), 0.0,
                                 draw(0.7, 1.0) * (place - network.mats[other].position).norm()});
      };
      if (row > 0) join(here - columns);
      if (column > 0) join(here - 1);
    }
  }
  return network;
}

TEST(Settle, BringsRandomChainsAndNetsToRestAtAllRatesThatHoldThem) {
  Uniform draw{std::mt19937(81)};
  for (int n = 0; n < test::rounds(60); ++n) {
    NetworkDescription network = hanging(draw);
    const double part = draw(0.05, 0.95);  // of the K' up to which it is certified
    network.step = 1e-9;
    const LiaisonGraph graph = liaison_graph(network);
    network.step = std::sqrt(part) * stability_of(network, graph).certified.step;
    double weight = 0.0;
    for (const engine::Mat& mat : network.mats) weight += mat.mass * kG;

    const Settled rest = settle(network, {1e-8 * weight, 200'000});

    EXPECT_LT(rest.force, 1e-8 * weight)
        << "round " << n << ": " << network.mats.size() << " MATs at " << part << " of the limit, "
        << rest.steps << " steps" << (rest.is_rounding ? ", rounding" : "");
  }
}

TEST(Settle, CountsTheStepsOfAllLengths) {
  NetworkDescription network = chain(11, false);
  network.step = 0.1;  // K dt^2 / m is 500: it takes six halvings to below 4

  const Settled whole = settle(network, {1e-9, 200'000});
  ASSERT_LT(whole.force, 1e-9);
  for (const std::uint64_t most : {1U, 2U, 50U, 700U, 900U}) {
    EXPECT_LE(settle(network, {0.0, most}).steps, most + 1) << most;
  }
  const Settled enough = settle(network, {1e-9, whole.steps});
  EXPECT_EQ(enough.steps, whole.steps);
  EXPECT_EQ(enough.position, whole.position);
}

TEST(Settle, LeavesOutWhatConditionsAskFor) {
  NetworkDescription network = chain(2, false);
  network.mats[1].position = Vec3(0, -kRest, 0);
  network.maxwell_links.push_back({0, 1, 100.0, 1.0, 0.0});
  network.variables.push_back({engine::VariableKind::kDistance, 0, engine::LinkKind::kMaxwell});
  engine::StateMachine machine;
  machine.states.resize(2);
  machine.states[0].last_exit = 1;
  machine.exits.emplace_back();
  machine.exits[0].target = 1;
  machine.exits[0].when.code = {{engine::Operation::kVariable, {}, 0.0, 0}};
  network.state_machines.push_back(machine);
  network.state_links.push_back({0, 1, 0, kRest});

  const Settled rest = settle(network, {1e-9, 200'000});

  EXPECT_NEAR(rest.position[1].y(), -kRest - kMass * kG / kStiffness, 1e-10);
}

TEST(Settle, TakesLawsOfTheTimeAsTheyAreAtTheStart) {
  NetworkDescription network = chain(2, false);
  network.mats[1].position = Vec3(0, -kRest, 0);
  network.variables.emplace_back();
  network.variables[0].quantity = engine::VariableKind::kTime;
  engine::Expression pull;  // (0.5 + time) N upwards
  pull.program.code = {{engine::Operation::kConstant, {}, 0.5, 0},
                       {engine::Operation::kVariable, {}, 0.0, 0},
                       {engine::Operation::kAdd, {}, 0.0, 0}};
  engine::StateMachine machine;
  machine.states.resize(1);
  machine.states[0].elasticity = pull;
  network.state_machines.push_back(machine);
  network.state_links.push_back({0, 1, 0, kRest});
  EXPECT_FALSE(plan::rest_is_open(network));

  const Settled rest = settle(network, {1e-9, 200'000});

  EXPECT_NEAR(rest.position[1].y(), -kRest - (kMass * kG - 0.5) / kStiffness, 1e-9);
  network.variables[0].quantity = engine::VariableKind::kPosition;
  EXPECT_TRUE(plan::rest_is_open(network));
}

TEST(Settle, LeavesOutWhatSignalsAskFor) {
  NetworkDescription network = chain(2, false);
  network.mats[1].position = Vec3(0, -kRest, 0);
  network.maxwell_links.push_back({0, 1, 100.0, 1.0, 0.0});
  network.groups.push_back({true, engine::LinkKind::kMaxwell, {0}});
  network.groups.push_back({false, engine::LinkKind::kLinear, {0}});
  network.groups.push_back({false, engine::LinkKind::kLinear, {1}});
  network.contacts.push_back({1, 2});

  const Settled rest = settle(network, {1e-9, 200'000});

  EXPECT_NEAR(rest.position[1].y(), -kRest - kMass * kG / kStiffness, 1e-10);
}

TEST(Settle, HangsAChainBetweenTwoNailsAsAnElasticCatenary) {
  const NetworkDescription network = chain(21, true);

  const Settled rest = settle(network, {1e-9, 200'000});

  ASSERT_LT(rest.force, 1e-9);
  // From the first link alone: the horizontal tension is the same in all, the vertical one less by m g
  // at each mass; the links that this gives must end at the other nail.
  const Vec3 first = rest.position[1] - rest.position[0];
  const Vec3 tension = kStiffness * (first.norm() - kRest) * first.normalized();
  Vec3 place = Vec3::Zero();
  for (std::size_t i = 1; i < 21; ++i) {
    const Vec3 pull = tension + Vec3(0, kMass * kG * static_cast<double>(i - 1), 0);
    place += (kRest + pull.norm() / kStiffness) * pull.normalized();
    EXPECT_LT((rest.position[i] - place).norm(), 1e-7) << i;
  }
  EXPECT_LT((place - Vec3(2, 0, 0)).norm(), 1e-7);
  EXPECT_NEAR(rest.position[10].x(), 1.0, 1e-8);  // the middle hangs in the middle
}

TEST(Settle, HangsAChainByADrivenForceAsByGravity) {
  const NetworkDescription heavy = chain(21, true);
  NetworkDescription pushed = heavy;
  pushed.gravity = Vec3::Zero();
  engine::TimeFunction weight;  // of all masses at the start, and another one later
  weight.time = {0.0, 1.0};
  weight.value = {Vec3(0, -kMass * kG, 0), Vec3(5, 5, 0)};
  pushed.time_functions = {weight};
  for (std::uint32_t i = 1; i < 20; ++i) pushed.drives.push_back({i, 0, true});

  const Settled expected = settle(heavy, {1e-9, 200'000});
  const Settled rest = settle(pushed, {1e-9, 200'000});

  ASSERT_LT(rest.force, 1e-9);
  for (std::size_t i = 0; i < 21; ++i) {
    EXPECT_LT((rest.position[i] - expected.position[i]).norm(), 1e-7);
  }
}

TEST(Settle, LaysABallOnADrivenSurface) {
  NetworkDescription network = chain(1, false);
  network.mats = {{MatKind::kMass, kMass, engine::Vec3(0.0, 0.05, 0.0), engine::Vec3::Zero()},
                  {MatKind::kPort, 0.0, engine::Vec3::Zero(), engine::Vec3::Zero()}};
  network.links.clear();
  network.surfaces = {{engine::SurfaceKind::kPlane, 1, engine::Vec3::UnitY()}};
  network.time_functions.resize(1);
  network.drives = {{1, 0, false, engine::Vec3::Zero()}};
  engine::StateMachine contact;
  contact.states.resize(1);
  contact.states[0].stiffness = kStiffness;
  network.state_machines = {contact};
  engine::SetLiaison set;
  set.range = set.rest_length = 0.05;
  set.set_p = {1};
  set.set_q = {0};
  network.sets = {set};

  const Settled rest = settle(network, {1e-9, 200'000});

  EXPECT_LT(rest.force, 1e-9);
  EXPECT_NEAR(rest.position[0].y(), 0.05 - kMass * kG / kStiffness, 1e-10);
  EXPECT_EQ(rest.position[1], Vec3(Vec3::Zero()));
}

TEST(Settle, LeavesWhatIsAtRestWhereItIs) {
  NetworkDescription network = chain(5, false);
  network.gravity = Vec3::Zero();

  const Settled rest = settle(network, {1e-9, 10});

  EXPECT_EQ(rest.steps, 1u);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(rest.position[i], network.mats[i].position);
}

TEST(Settle, IsTheStartOfAWorldThatStaysThere) {
  std::mt19937 random(7);
  const auto between = [&random](double low, double high) {
    return low + (high - low) * static_cast<double>(random()) / 4294967296.0;
  };
  for (int trial = 0; trial < 30; ++trial) {
    SCOPED_TRACE(trial);
    NetworkDescription network;
    network.dimension = 2 + trial % 2;
    network.step = 1e-3;
    network.gravity[network.dimension - 1] = -kG;
    const auto place = [&] {
      Vec3 point(between(-0.2, 0.2), between(-0.2, 0.2), 0);
      if (network.dimension == 3) point.z() = between(-0.2, 0.2);
      return point;
    };
    for (int i = 0; i < 4; ++i) network.mats.push_back({MatKind::kFixed, 0.0, place()});
    for (std::uint32_t i = 4; i < 12; ++i) {
      network.mats.push_back({MatKind::kMass, between(0.01, 0.05), place(), place()});
      for (int l = 0; l < 4; ++l) {
        const auto other = static_cast<std::uint32_t>(random() % i);
        network.links.push_back({other, i, between(20, 300), between(0, 0.05), between(0.0, 0.2)});
      }
    }
    network.maxwell_links.push_back({0, 5, 10, 3, 0.4});

    const Settled rest = settle(network, {1e-7, 400'000});

    ASSERT_LT(rest.force, 1e-7);
    for (std::uint32_t i = 0; i < 12; ++i) {
      network.mats[i].position = rest.position[i];
      network.mats[i].velocity = Vec3::Zero();
    }
    engine::World world(std::make_shared<const engine::Network>(network));
    world.step();
    for (std::uint32_t i = 4; i < 12; ++i) {
      const Vec3 force = world.link_force(i) + network.mats[i].mass * network.gravity;
      EXPECT_LT(force.norm(), 1.1e-7);  // of dampers in the first step, and of rounding
    }
  }
}

TEST(Settle, KeepsTheStatesOfTheStart) {
  NetworkDescription network = chain(2, false);
  network.links.clear();
  engine::StateMachine thread;
  thread.states.resize(2);
  thread.states[0].stiffness = kStiffness;
  thread.states[0].last_exit = 1;
  engine::Instruction elongation;
  elongation.operation = engine::Operation::kQuantity;
  elongation.quantity = engine::Quantity::kElongation;
  engine::Transition tears;
  tears.when.code = {elongation};  // torn at once
  tears.target = 1;
  thread.exits = {tears};
  network.state_machines = {thread};
  network.state_links = {{0, 1, 0, kRest}};

  const Settled rest = settle(network, {1e-9, 100'000});

  EXPECT_LT(rest.force, 1e-9);
  EXPECT_NEAR(rest.position[1].norm(), kRest + kMass * kG / kStiffness, 1e-11);
}

TEST(Settle, TakesAShorterStepWhereThatOfImplicitIsTooLong) {
  NetworkDescription network = chain(21, true);
  const Settled expected = settle(network, {1e-9, 200'000});
  network.integrator = engine::IntegratorKind::kImplicit;
  network.step *= 20.0;

  const Settled rest = settle(network, {1e-9, 200'000});

  ASSERT_TRUE(rest.is_finite);
  ASSERT_LT(rest.force, 1e-9);
  for (std::size_t i = 0; i < 21; ++i) {
    EXPECT_LT((rest.position[i] - expected.position[i]).norm(), 1e-7) << i;
  }
}

TEST(Settle, EndsWhereRoundingIsAllThatPulls) {
  const Settled rest = settle(chain(200, true), {1e-13, 2'000'000});

  EXPECT_TRUE(rest.is_rounding);
  EXPECT_GT(rest.force, 1e-13);
  EXPECT_LT(rest.force, 1e-10);
  EXPECT_LT(rest.steps, 400'000u);
  EXPECT_FALSE(settle(chain(200, true), {1e-10, 2'000'000}).is_rounding);
}

/// The network from where it has come to rest.
NetworkDescription started_from(NetworkDescription network, const Settled& rest) {
  for (std::size_t i = 0; i < network.mats.size(); ++i) network.mats[i].position = rest.position[i];
  for (std::size_t s = 0; s < network.sets.size(); ++s)
    network.sets[s].stretches = rest.stretches[s];
  return network;
}

TEST(Settle, SetsABlockOnAnInclineThatStaysInItsPlace) {
  for (const double mu : {0.2, 0.5, 1.0}) {
    SCOPED_TRACE(mu);
    const double angle = std::atan(0.98 * mu);
    const NetworkDescription network =
        test::block_on_incline(angle, {mu, 0.8 * mu, 1e5, 200.0}, 5e-5);

    const Settled rest = settle(network, {1e-9, 200'000});

    ASSERT_LT(rest.force, 1e-9);
    ASSERT_EQ(rest.stretches[0].size(), 1u);
    // K s = m g sin a; what is left is below until / K
    EXPECT_NEAR(rest.stretches[0][0].stretch.x(), test::kGravity * std::sin(angle) / 1e5, 1e-13);
    const NetworkDescription start = started_from(network, rest);
    engine::World world(std::make_shared<const engine::Network>(start));
    for (int n = 0; n < test::rounds(1'000'000); ++n) world.step();
    EXPECT_LT((world.position(0) - rest.position[0]).norm(), 1e-9);
    EXPECT_FALSE(world.contact_stretches(0)[0].slides);
  }
}

TEST(Settle, SaysOnWhatSlidesWhatFrictionCannotHold) {
  for (const double mu : {0.2, 0.5, 1.0}) {
    const double angle = std::atan(1.02 * mu);
    const NetworkDescription network = test::block_on_incline(angle, {mu, mu, 1e5, 200.0});

    const Settled rest = settle(network, {1e-9, 20'000});

    const double left = test::kGravity * (std::sin(angle) - mu * std::cos(angle));
    // the first half step slackens the spring of friction by K dt^2 / 2 m of that
    EXPECT_NEAR(rest.force, left, 6e-4 * left) << mu;
    EXPECT_EQ(rest.pulled, 0u);
    EXPECT_EQ(rest.slides_on, 1u);
  }
}

TEST(Settle, LeavesFrictionOutWhereItIsAsked) {
  const NetworkDescription network = test::block_on_incline(0.1, {0.5, 0.4, 1e5, 200.0});

  const Settled rest = settle(network, {1e-9, 5'000, false});

  EXPECT_NEAR(rest.force, test::kGravity * std::sin(0.1), 1e-6);
  EXPECT_TRUE(rest.stretches[0].empty());
  EXPECT_FALSE(rest.slides_on);
  EXPECT_LT(settle(network, {1e-9, 5'000}).force, 1e-9);
}

/// Balls with friction that fall onto a floor and each other, into a heap of any shape.
NetworkDescription falling_balls(int dimension, unsigned seed) {
  NetworkDescription network = test::rubbing_cloud(dimension, seed);
  network.step = 1e-4;
  network.gravity[1] = -kG;
  for (engine::StateMachine& machine : network.state_machines) {
    machine.states[0].stiffness *= 50.0;
    machine.friction.stiffness *= 50.0;
  }
  for (engine::Mat& mat : network.mats) mat.velocity = Vec3::Zero();
  return network;
}

TEST(Settle, LaysBallsWithFrictionIntoAHeapThatStands) {
  std::size_t leaning = 0;  // contacts that carry something across
  for (unsigned seed = 1; seed <= 12; seed += test::kSeedStride) {
    SCOPED_TRACE(seed);
    const NetworkDescription network = falling_balls(2 + static_cast<int>(seed % 2), seed);

    const Settled rest = settle(network, {1e-8, 400'000});

    ASSERT_LT(rest.force, 1e-8);
    const NetworkDescription start = started_from(network, rest);
    engine::World world(std::make_shared<const engine::Network>(start));
    for (int n = 0; n < 5'000; ++n) world.step();
    for (std::uint32_t i = 0; i < network.mats.size(); ++i)
      ASSERT_LT((world.position(i) - rest.position[i]).norm(), 1e-9) << i;
    for (const auto& set : rest.stretches) {
      for (const engine::StartStretch& contact : set) {
        const double force = 1e4 * contact.stretch.norm();  // K is 50 * 200 N/m
        leaning += force > 0.01 ? 1 : 0;
      }
    }
  }
  EXPECT_GT(leaning, 10u);
}

TEST(Settle, EndsWithWhatFallsForever) {
  NetworkDescription network = chain(3, false);
  network.links.pop_back();

  const Settled rest = settle(network, {1e-9, 500});

  EXPECT_TRUE(rest.is_finite);
  EXPECT_GE(rest.steps, 500u);
  EXPECT_GE(rest.force, kMass * kG * (1.0 - 1e-12));
}

}  // namespace
}  // namespace cordis::plan
