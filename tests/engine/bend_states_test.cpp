// tests/engine/bend_states_test.cpp -- bends with states: folds that stay, and branches that snap.
#include <cmath>
#include <optional>
#include <random>

#include <gtest/gtest.h>

#include "sim_node/engine/links/bend_angle.h"
#include "sim_node/engine/variables.h"
#include "tests/engine/programs.h"
#include "tests/engine/scenes.h"
#include "tests/support/allocation_guard.h"

namespace cordis::test {
namespace {

using engine::Bend;
using engine::IntegratorKind;
using engine::LinkEvent;
using engine::LinkKind;
using engine::Variable;
using engine::VariableKind;

constexpr double kLength = 0.1;

double value_in(const World& world, VariableKind quantity, std::uint32_t bend = 0) {
  Variable variable;
  variable.quantity = quantity;
  variable.kind = LinkKind::kBend;
  variable.index = bend;
  return engine::value_of(variable, world, {});
}

Vec3 along(double angle) {
  return kLength * Vec3(std::cos(angle), std::sin(angle), 0.0);
}

/// Two MATs that stay, and a third one beyond them at an angle, joined by a bend with this state machine alone.
NetworkDescription hinge(const StateMachine& states, double angle, bool moves = true) {
  NetworkDescription scene;
  scene.dimension = 2;
  scene.step = 1e-4;
  scene.mats = {fixed(Vec3(-kLength, 0, 0)), fixed(Vec3::Zero()),
                moves ? mass(0.1, along(angle)) : port(along(angle))};
  scene.state_machines = {states};
  scene.bends = {{0, 1, 2, 0.0, 0.0, 0.0, kLength, kLength, 0}};
  return scene;
}

TEST(BendAngle, IsThatOfTheLibrary) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  for (int round = 0; round < 20'000; ++round) {
    const double x = normal(random) * std::pow(10.0, round % 7 - 3);
    const double y = normal(random);
    ASSERT_NEAR(engine::direction_of(x, y), std::atan2(y, x), 1e-15) << x << " " << y;
  }
  for (const double x : {0.0, 1.0, -1.0}) {
    for (const double y : {1.0, -1.0})
      EXPECT_NEAR(engine::direction_of(x, y), std::atan2(y, x), 1e-15);
  }
  EXPECT_EQ(engine::direction_of(0.0, 0.0), 0.0);
}

TEST(BendAngle, HasTheRateOfItsDifferences) {
  std::mt19937 random(6);
  std::normal_distribution<double> normal;
  constexpr double kMoment = 1e-6;
  Bend bend;
  bend.length_ab = 0.2;
  bend.length_bc = 0.3;
  for (int round = 0; round < 300; ++round) {
    for (int dimension = 1; dimension <= 3; ++dimension) {
      engine::BendSides sides;
      for (Vec3* vector : {&sides.u, &sides.v, &sides.rate_u, &sides.rate_v}) {
        for (int axis = 0; axis < dimension; ++axis) (*vector)[axis] = normal(random);
      }
      engine::BendSides later = sides;
      later.u += kMoment * sides.rate_u;
      later.v += kMoment * sides.rate_v;
      const engine::AngleAndRate now = engine::angle_of(bend, dimension, sides);
      const double change = engine::angle_beyond(
          now.angle, engine::angle_of(bend, dimension, later).angle, dimension);
      const double least = std::min(sides.u.norm(), sides.v.norm());
      const double sine = dimension == 3 ? std::abs(std::sin(now.angle)) : 1.0;
      const double tolerance = 1e-4 / std::pow(least, 2) / std::max(sine, 1e-3);
      if (dimension > 1 && tolerance > 0.1) continue;
      EXPECT_NEAR(change / kMoment, now.rate, tolerance) << round << " " << dimension;
    }
  }
}

TEST(BendAngle, BeyondARestIsTheNearestOne) {
  EXPECT_NEAR(engine::angle_beyond(3.0, -3.0, 2), 2.0 * M_PI - 6.0, 1e-15);
  EXPECT_NEAR(engine::angle_beyond(-3.0, 3.0, 2), 6.0 - 2.0 * M_PI, 1e-15);
  EXPECT_NEAR(engine::angle_beyond(100.0, 0.0, 2), 32.0 * M_PI - 100.0, 1e-12);
  EXPECT_EQ(engine::angle_beyond(100.0, 0.0, 1), -100.0);
}

TEST(BendMoment, IsTheExactOneAtAKnownAngle) {
  const StateMachine plain = Behaving().state(0.0).exit(q(Quantity::kAge) > 1e9, 0).state_machine;
  for (const double angle : {-2.5, -0.3, 0.0, 0.4, 1.5, 3.0}) {
    for (const double rest : {0.0, 0.7, -3.0}) {
      NetworkDescription scene = hinge(plain, angle, false);
      scene.state_machines[0].states[0].stiffness = 0.03;
      scene.bends[0].rest_angle = rest;
      World world = make_world(scene);
      world.step();
      const double exact = 0.03 * std::sin(angle - rest);
      EXPECT_NEAR(world.moment_of_bend(0), exact, 1e-16);
      EXPECT_NEAR(value_in(world, VariableKind::kMoment), exact, 1e-16);
      EXPECT_NEAR(-along(angle).cross(world.link_force(2)).z(), exact, 1e-16);
      EXPECT_NEAR(value_in(world, VariableKind::kAngle), angle, 1e-15);
      scene.bends[0].state_machine = Bend::kNone;
      scene.bends[0].stiffness = 0.03;
      EXPECT_NEAR(value_in(make_world(scene), VariableKind::kMoment), exact, 1e-16);
    }
  }
}

/// Complete elliptic integral of the first kind, by the arithmetic-geometric mean.
double elliptic_k(double modulus) {
  double a = 1.0;
  double b = std::sqrt(1.0 - modulus * modulus);
  while (std::abs(a - b) > 1e-15) {
    const double mean = 0.5 * (a + b);
    b = std::sqrt(a * b);
    a = mean;
  }
  return M_PI / (2.0 * a);
}

TEST(BendHinge, SwingsAsAPendulumOfItsStiffness) {
  // m l^2 angle'' = -B sin(angle) while its side keeps its length.
  constexpr double kStart = 2.0;
  const StateMachine plain = Behaving().state(0.0).exit(q(Quantity::kAge) > 1e9, 0).state_machine;
  NetworkDescription scene = hinge(plain, kStart);
  scene.integrator = IntegratorKind::kLeapfrog;
  scene.step = 2e-6;
  scene.state_machines[0].states[0].stiffness = 0.03;
  scene.links = {{1, 2, 1e6, 0.0, kLength}};
  const double w = std::sqrt(0.03 / (0.1 * kLength * kLength));
  const double exact = 4.0 * elliptic_k(std::sin(0.5 * kStart)) / w;
  World world = make_world(scene);
  double before = kStart;
  double quarter = 0.0;
  while (quarter == 0.0) {
    world.step();
    const double angle = value_in(world, VariableKind::kAngle);
    if (angle <= 0.0) {
      quarter = (static_cast<double>(world.step_count()) - angle / (angle - before)) * scene.step;
    }
    before = angle;
  }
  EXPECT_NEAR(4.0 * quarter / exact, 1.0, 1e-5);  // the side gives way by 1e-6 of it
}

/// Yields beyond 0.2 rad: its rest follows, so that 0.2 rad stay elastic.
StateMachine plastic() {
  const Term bend = q(Quantity::kBend);
  const Term sign = one(Operation::kSign, bend);
  return Behaving()
      .state(0.5)
      .exit_to_rest(one(Operation::kAbs, bend) > 0.2, 0,
                    q(Quantity::kRestAngle) + bend - sign * Term(0.2))
      .state_machine;
}

TEST(PlasticBend, KeepsAFold) {
  NetworkDescription scene = hinge(plastic(), 0.0, false);
  World world = make_world(scene);
  for (int n = 0; n <= 800; ++n) {
    world.impose_position(2, along(1e-3 * n));
    world.step();
    const double rest = n <= 200 ? 0.0 : 1e-3 * n - 0.2;
    ASSERT_NEAR(world.rest_angle_of_bend(0), rest, 1e-12) << n;
    ASSERT_NEAR(world.moment_of_bend(0), 0.5 * std::sin(1e-3 * n - rest), 1e-12) << n;
  }
  for (int n = 800; n >= 600; --n) {
    world.impose_position(2, along(1e-3 * n));
    world.step();
  }
  EXPECT_NEAR(world.moment_of_bend(0), 0.0, 1e-12) << "the fold that stays";
  EXPECT_EQ(world.change_count(0, 0, 0), 600U);
}

TEST(PlasticBend, SpendsTheMomentTimesTheFold) {
  World world = make_world(hinge(plastic(), 0.0, false));
  for (int n = 0; n <= 800; ++n) {
    world.impose_position(2, along(1e-3 * n));
    world.step();
  }
  const engine::Energy energy = world.energy();
  EXPECT_LT(std::abs(energy.residual()), 1e-12 * energy.largest);
  // In steps of 1e-3 rad; the account is in the middle of a step, where each goes from 0.2005 to 0.1995 rad.
  EXPECT_NEAR(energy.switching, -600 * 0.5 * (std::cos(0.1995) - std::cos(0.2005)), 1e-7);
}

/// Snaps beyond 0.3 rad, and is nothing from then on.
StateMachine brittle() {
  StateMachine states = Behaving()
                            .state(2.0, 1e-3)
                            .exit(one(Operation::kAbs, q(Quantity::kAngle)) > 0.3, 1)
                            .state(0.0)
                            .state_machine;
  states.states[0].name = "whole";
  states.states[1].name = "broken";
  return states;
}

class Branch : public testing::TestWithParam<IntegratorKind> {
 protected:
  /// A rod of 8 masses whose last one is thrown aside.
  static NetworkDescription rod() {
    NetworkDescription scene;
    scene.dimension = 2;
    scene.step = 1e-4;
    scene.integrator = GetParam();
    for (std::uint32_t i = 0; i < 8; ++i) {
      const Vec3 place(kLength * i, 0, 0);
      scene.mats.push_back(i == 0 ? fixed(place) : mass(0.05, place));
      if (i > 0) scene.links.push_back({i - 1, i, 2000.0, 0.1, kLength});
      if (i > 1) scene.bends.push_back({i - 2, i - 1, i, 0.0, 0.0, 0.0, kLength, kLength, 0});
    }
    scene.mats.back().velocity = Vec3(0, 8.0, 0);
    scene.state_machines = {brittle()};
    return scene;
  }
};

TEST_P(Branch, SnapsAndItsAccountCloses) {
  World world = make_world(rod());
  double brought = 0.0;
  for (int n = 0; n < 20'000; ++n) {
    world.step();
    for (const LinkEvent& event : world.events()) {
      brought += event.energy;
      EXPECT_EQ(event.quantity, Quantity::kAngle);
      EXPECT_GT(std::abs(event.value), 0.3);
      EXPECT_EQ(event.mat_b, event.mat_a + 2);
      EXPECT_EQ(event.link, engine::kNoLink);
      // What it stored is gone, but for what the half of a step shifts.
      EXPECT_NEAR(event.energy, -2.0 * (1.0 - std::cos(event.value)), 0.02);
    }
    const engine::Energy energy = world.energy();
    if (GetParam() == IntegratorKind::kCordis) {
      ASSERT_LT(std::abs(energy.residual()), 1e-11 * energy.largest) << n;
    } else if (GetParam() == IntegratorKind::kLeapfrog) {  // the other one loses energy itself
      ASSERT_LT(std::abs(energy.residual()), 0.02 * energy.largest) << n;
    }
  }
  EXPECT_NEAR(world.energy().switching, brought, 1e-12);
  EXPECT_GE(world.change_count(0, 0, 1), 1U);
  for (std::uint32_t bend = 0; bend < 6; ++bend) {
    if (world.state_of_bend(bend) == 0) continue;
    EXPECT_EQ(world.moment_of_bend(bend), 0.0);
    EXPECT_EQ(value_in(world, VariableKind::kState, bend), 1.0);
    EXPECT_LT(world.age_of_bend(bend), 2.0);
  }
}

TEST_P(Branch, GoesOnFromASnapshotOnEveryWidth) {
  std::optional<std::uint64_t> hash;
  for (const VectorWidth width : engine::supported_vector_widths()) {
    World world = make_world(rod(), width);
    run(world, 300);
    world.force_state_of_bend(0, 1);  // still to come
    const engine::Snapshot snapshot = world.snapshot();
    World restored = make_world(rod(), width);
    run(restored, 50);
    restored.force_state_of_bend(1, 1);  // to be forgotten
    restored.restore(snapshot);
    for (World* each : {&world, &restored}) {
      run(*each, 300);
      if (!hash) hash = each->state_hash();
      EXPECT_EQ(each->state_hash(), *hash);
      EXPECT_EQ(each->energy().switching, world.energy().switching);
    }
    EXPECT_EQ(world.state_of_bend(0), 1U);
  }
}

TEST_P(Branch, GoesOnWithOtherParameters) {
  World first = make_world(rod());
  run(first, 100);
  StateMachine other = brittle();
  other.states[0].stiffness = 3.0;
  other.exits[0].when =
      either(q(Quantity::kBend) > 0.5, one(Operation::kRising, q(Quantity::kMoment), 0)).program;
  first.replace_state_machine(0, other);
  EXPECT_NE(first.energy().switching, 0.0);
  run(first, 30);
  const engine::Snapshot snapshot = first.snapshot();
  World second = make_world(rod());
  second.restore(snapshot);
  run(first, 200);
  run(second, 200);
  EXPECT_EQ(first.state_hash(), second.state_hash());
  other.states[0].elasticity = engine::Power{1.0, 3.0};
  EXPECT_THROW(first.replace_state_machine(0, other), std::invalid_argument);
}

TEST_P(Branch, StepsWithoutAllocatingWithStates) {
  World world = make_world(rod());
  const AllocationGuard guard;
  for (int n = 0; n < 50; ++n) {
    if (n == 10) world.force_state_of_bend(2, 1);
    world.step();
  }
  EXPECT_EQ(guard.count(), 0U);
}

INSTANTIATE_TEST_SUITE_P(Integrators, Branch,
                         testing::Values(IntegratorKind::kCordis, IntegratorKind::kLeapfrog,
                                         IntegratorKind::kImplicit));

TEST(BendStates, SeeTheSpeedOfTheirAngle) {
  for (int dimension = 1; dimension <= 3; ++dimension) {
    const StateMachine always =
        Behaving().state(0.2).exit(q(Quantity::kAngularSpeed) > -1e9, 0).state_machine;
    NetworkDescription scene = hinge(always, 0.3);
    scene.dimension = dimension;
    for (Mat& mat : scene.mats) {
      for (int axis = dimension; axis < 3; ++axis) mat.position[axis] = 0.0;
    }
    scene.mats[2].velocity = dimension == 1 ? Vec3(2.0, 0, 0) : Vec3(0.5, 2.0, 0);
    World world = make_world(scene);
    world.step();
    for (int n = 0; n < 50; ++n) {
      const double speed = value_in(world, VariableKind::kAngularSpeed);
      world.step();
      ASSERT_EQ(world.events().size(), 1U);
      EXPECT_NEAR(world.events()[0].value, speed, 1e-9 * std::abs(speed)) << dimension;
    }
  }
}

TEST(BendStates, TakeTheRestOfAStateThatHasOne) {
  StateMachine states = Behaving()
                            .state(1.0)
                            .exit(q(Quantity::kAge) > 0.00035, 1)
                            .state(1.0)
                            .exit(q(Quantity::kAge) > 0.00035, 0, RestRule::kHere)
                            .state_machine;
  states.states[1].rest_angle = 0.5;
  World world = make_world(hinge(states, 0.2, false));
  run(world, 5);
  EXPECT_EQ(world.state_of_bend(0), 1U);
  EXPECT_EQ(world.rest_angle_of_bend(0), 0.5);
  EXPECT_NEAR(world.moment_of_bend(0), std::sin(0.2 - 0.5), 1e-15);
  run(world, 4);
  EXPECT_EQ(world.state_of_bend(0), 0U);
  EXPECT_NEAR(world.rest_angle_of_bend(0), 0.2, 1e-15);
  world.force_state_of_bend(0, 1);
  world.step();
  EXPECT_EQ(world.rest_angle_of_bend(0), 0.5);
}

TEST(BendStates, AreTheSameWhateverStandsBesideThem) {
  // Hinges in rows of 8 and beyond: each as if it were alone.
  NetworkDescription scene;
  scene.dimension = 2;
  scene.step = 1e-4;
  scene.state_machines = {plastic(), brittle()};
  for (std::uint32_t i = 0; i < 19; ++i) {
    const double angle = 0.05 * i - 0.4;
    scene.mats.push_back(fixed(Vec3(-kLength, 0, 0)));
    scene.mats.push_back(fixed(Vec3::Zero()));
    scene.mats.push_back(mass(0.1, along(angle), Vec3(0, 3.0, 0)));
    scene.bends.push_back({3 * i, 3 * i + 1, 3 * i + 2, 0.0, 0.0, 0.0, kLength, kLength, i % 2});
    if (i % 5 == 0) scene.bends.push_back({3 * i, 3 * i + 1, 3 * i + 2, 0.1, 0.0, 0.0, 0.1, 0.1});
  }
  World all = make_world(scene);
  run(all, 800);
  for (std::uint32_t i = 0; i < 19; ++i) {
    NetworkDescription alone = scene;
    std::erase_if(alone.bends, [i](const Bend& bend) { return bend.mat_a != 3 * i; });
    World one = make_world(alone);
    run(one, 800);
    EXPECT_EQ(one.position(3 * i + 2), all.position(3 * i + 2)) << i;
  }
}

TEST(BendStates, AreRefusedWhereTheyCannotBe) {
  const auto refused = [](auto change) {
    NetworkDescription scene = hinge(brittle(), 0.1);
    make_world(scene);
    change(scene);
    EXPECT_THROW(make_world(scene), std::invalid_argument);
  };
  refused([](NetworkDescription& scene) { scene.bends[0].state_machine = 1; });
  refused([](NetworkDescription& scene) { scene.bends[0].stiffness = 1.0; });
  refused([](NetworkDescription& scene) { scene.state_machines[0].states[0].pushes = false; });
  refused([](NetworkDescription& scene) {
    scene.state_machines[0].exits[0].when = (q(Quantity::kDistance) > 0.1).program;
  });
  refused([](NetworkDescription& scene) { scene.state_machines[0].states[0].rest_angle = 4.0; });
  refused([](NetworkDescription& scene) {
    scene.dimension = 3;
    scene.state_machines[0].exits[0].rest = RestRule::kHere;
  });
  refused([](NetworkDescription& scene) { scene.integrator = IntegratorKind::kSymplectic4; });
  refused([](NetworkDescription& scene) { scene.freeze_tolerance = 1e-6; });
}

}  // namespace
}  // namespace cordis::test
