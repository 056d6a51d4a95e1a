// tests/engine/bend_law_test.cpp -- bends whose moment is an expression, a table or a power.
#include <cmath>
#include <optional>
#include <random>
#include <utility>

#include <gtest/gtest.h>

#include "sim_node/engine/links/bend_moment.h"
#include "tests/engine/programs.h"
#include "tests/engine/scenes.h"
#include "tests/support/allocation_guard.h"

namespace cordis::test {
namespace {

using engine::Bend;
using engine::BendOfLaw;
using engine::IntegratorKind;
using engine::Law;
using engine::Operation;
using engine::Power;
using engine::Table;

constexpr double kSideLength = 0.1;
constexpr double kLinearLaw = 0.03;  // [N m/rad]

Term sine_of(Term of) {
  return one(Operation::kSin, std::move(of));
}

/// What a law of a bend asks for as its bend and its rate.
Term bend_seen() {
  return q(Quantity::kElongation);
}
Term rate_seen() {
  return q(Quantity::kSpeed);
}

StateMachine of_laws(Law elasticity, Law dissipation = {}) {
  StateMachine machine;
  machine.name = "law";
  machine.states.emplace_back();
  machine.states[0].elasticity = std::move(elasticity);
  machine.states[0].dissipation = std::move(dissipation);
  return machine;
}

/// Masses on a bent line with springs, and bends of a state machine; without one of a linear law.
NetworkDescription rod_of_law(int dimension, const std::optional<StateMachine>& machine) {
  NetworkDescription scene;
  scene.dimension = dimension;
  scene.step = 1e-4;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> shift(-0.04, 0.04);
  for (int i = 0; i < 12; ++i) {
    Vec3 place = dimension == 1 ? Vec3(Vec3::Zero()) : Vec3(kSideLength * i, 0.0, 0.0);
    place[dimension == 1 ? 0 : 1] += shift(random);
    if (dimension == 3) place[2] += shift(random);
    scene.mats.push_back(i < 1 ? fixed(place) : mass(0.02, place));
    const auto c = static_cast<std::uint32_t>(i);
    if (i > 0 && dimension > 1) scene.links.push_back({c - 1, c, 800.0, 0.0, kSideLength});
    if (i < 2) continue;
    scene.bends.push_back({c - 2, c - 1, c, kLinearLaw, 0.0, 0.0, kSideLength, kSideLength});
    if (dimension < 3) scene.bends.back().rest_angle = 0.2;
    if (!machine) continue;
    scene.bends.back().stiffness = 0.0;
    scene.bends.back().state_machine = 0;
  }
  if (machine) scene.state_machines = {*machine};
  return scene;
}

double farthest_apart(const World& a, const World& b) {
  double far = 0.0;
  for (std::uint32_t i = 0; i < a.network().mat_count(); ++i)
    far = std::max(far, (a.position(i) - b.position(i)).norm());
  return far;
}

TEST(BendOfLaw, HasTheAngleOfSidesOfTheirRestLengths) {
  for (const double angle : {1e-6, 0.1, 0.7, 1.5, 1.999}) {
    const Vec3 w = Vec3(std::cos(angle) - 1.0, std::sin(angle), 0.0);
    const BendOfLaw seen = engine::bend_of_law(w, 0.5 * w / w.norm(), 2);
    EXPECT_NEAR(seen.angle, angle, 1e-15);
    EXPECT_NEAR(seen.slope, 1.0 / std::cos(0.5 * angle), 1e-13);
    EXPECT_NEAR(seen.speed, 0.5 * seen.slope, 1e-15);
  }
}

TEST(BendOfLaw, GoesOnAlongItsTangent) {
  constexpr double kWay = 1e-6;
  const auto bend_at = [](double length) {
    return engine::bend_of_law(Vec3(0.0, length, 0.0), Vec3::Zero(), 3);
  };
  const double corner = 2.0 * std::sin(0.5 * engine::kLargestExactBend);
  for (const double length :
       {0.3, 1.2, corner - 2.0 * kWay, corner, corner + 2.0 * kWay, 2.0, 5.0}) {
    const double rise =
        (bend_at(length + kWay).angle - bend_at(length - kWay).angle) / (2.0 * kWay);
    EXPECT_NEAR(rise, bend_at(length).slope, 1e-5) << length;
  }
  EXPECT_NEAR(bend_at(corner).angle, engine::kLargestExactBend, 1e-14);
  EXPECT_EQ(engine::bend_of_law(Vec3(-0.3, 0, 0), Vec3(0.1, 0, 0), 1).angle, -0.3);
  EXPECT_EQ(engine::bend_of_law(Vec3::Zero(), Vec3(0.0, -0.2, 0), 2).speed, 0.2);
}

TEST(BendLaw, OfASineIsTheLinearLaw) {
  for (int dimension = 2; dimension <= 3; ++dimension) {
    World linear = make_world(rod_of_law(dimension, {}));
    World sines = make_world(
        rod_of_law(dimension, of_laws(expression_law(Term(kLinearLaw) * sine_of(bend_seen())))));
    for (int n = 0; n < 2000; ++n) {
      linear.step();
      sines.step();
    }
    EXPECT_LT(farthest_apart(linear, sines), 1e-11)
        << dimension;  // the motion is hardly chaotic in 0.2 s
    EXPECT_NEAR(sines.energy().elastic, linear.energy().elastic, 1e-9);
  }
}

TEST(BendLaw, OfALineIsTheLinearLawInOneDimension) {
  World linear = make_world(rod_of_law(1, {}));
  World line = make_world(rod_of_law(1, of_laws(expression_law(Term(kLinearLaw) * bend_seen()))));
  World power = make_world(rod_of_law(1, of_laws(Power{kLinearLaw, 1.0})));
  World table = make_world(rod_of_law(
      1, of_laws(Table({-9.0, 1.0, 9.0}, {-9.0 * kLinearLaw, kLinearLaw, 9.0 * kLinearLaw}))));
  for (int n = 0; n < 2000; ++n) {
    for (World* world : {&linear, &line, &power, &table}) world->step();
  }
  for (const World* world : {&line, &power, &table}) {
    EXPECT_LT(farthest_apart(linear, *world), 1e-11);
    EXPECT_NEAR(world->energy().elastic, linear.energy().elastic, 1e-11);
  }
}

/// Two MATs that stay, and one that turns about the second on a stiff spring.
NetworkDescription hinge_of_law(const StateMachine& machine, double angle) {
  NetworkDescription scene;
  scene.dimension = 2;
  scene.step = 1e-4;
  scene.mats = {fixed(Vec3(-kSideLength, 0, 0)), fixed(Vec3::Zero()),
                mass(0.1, kSideLength * Vec3(std::cos(angle), std::sin(angle), 0.0))};
  scene.state_machines = {machine};
  scene.bends = {{0, 1, 2, 0.0, 0.0, 0.0, kSideLength, kSideLength, 0}};
  return scene;
}

TEST(BendLaw, HasItsMomentAtAKnownBend) {
  const Law cubic =
      expression_law(Term(0.5) * bend_seen() + Term(2.0) * bend_seen() * bend_seen() * bend_seen());
  for (const double angle : {-1.9, -0.4, 1e-5, 0.3, 1.0, 1.99}) {
    World world = make_world(hinge_of_law(of_laws(cubic), angle));
    world.step();
    EXPECT_NEAR(world.moment_of_bend(0), 0.5 * angle + 2.0 * angle * angle * angle, 1e-13) << angle;
  }
}

/// Law B b + C b^3 on a mass that turns about a point at a fixed distance: its period, from the energy.
TEST(BendLaw, SwingsWithThePeriodOfItsEnergy) {
  constexpr double kCubic = 0.08;  // [N m/rad^3]
  constexpr double kSwing = 1.2;   // [rad]
  const Law cubic = expression_law(Term(kLinearLaw) * bend_seen() +
                                   Term(kCubic) * bend_seen() * bend_seen() * bend_seen());
  NetworkDescription scene = hinge_of_law(of_laws(cubic), kSwing);
  scene.step = 2e-5;
  scene.links = {{1, 2, 2.0e6, 0.0, kSideLength}};
  const double inertia = 0.1 * kSideLength * kSideLength;
  // A quarter period is the integral of 1 / speed; with b = swing sin(t) its integrand is smooth.
  double quarter = 0.0;
  constexpr int kParts = 4000;
  for (int i = 0; i < kParts; ++i) {
    const double t = (i + 0.5) / kParts * 0.5 * M_PI;
    const double square = kSwing * kSwing * (1.0 + std::sin(t) * std::sin(t));
    quarter += std::sqrt(inertia / (kLinearLaw + 0.5 * kCubic * square)) * 0.5 * M_PI / kParts;
  }

  World world = make_world(scene);
  double before = world.position(2).y();
  double last = 0.0;
  double first = 0.0;
  for (int crossings = 0; crossings < 21;) {
    world.step();
    const double now = world.position(2).y();
    if (before * now <= 0.0) {
      last = (static_cast<double>(world.step_count()) - now / (now - before)) * scene.step;
      if (crossings++ == 0) first = last;
    }
    before = now;
  }

  EXPECT_NEAR((last - first) / 20.0, 2.0 * quarter,
              3e-5 * quarter);  // the spring gives way by 6e-5
}

TEST(BendLaw, KeepsTheAccount) {
  const Law cubic = expression_law(Term(0.02) * bend_seen() +
                                   Term(0.3) * bend_seen() * bend_seen() * bend_seen());
  const Law drag =
      expression_law(Term(2e-4) * rate_seen() * (Term(1.0) + bend_seen() * bend_seen()));
  for (int dimension = 1; dimension <= 3; ++dimension) {
    double errors[2] = {};
    for (const int part : {1, 2}) {
      NetworkDescription scene = rod_of_law(dimension, of_laws(cubic, drag));
      scene.step = 2e-4 / part;
      World world = make_world(scene);
      const double start = world.energy().elastic;
      double worst = 0.0;
      for (int n = 0; n < part * 2000; ++n) {
        world.step();
        worst = std::max(worst, std::abs(world.energy().elastic_error));
      }
      errors[part - 1] = worst;
      EXPECT_GT(world.energy().dissipated, 0.05 * start) << dimension;
      EXPECT_LT(worst, 1e-2 * start) << dimension;
    }
    EXPECT_NEAR(errors[0] / errors[1], 4.0, 0.5) << dimension;
  }
}

TEST(BendLaw, PushesNoOneAndTurnsNothing) {
  NetworkDescription scene = rod_of_law(
      3, of_laws(expression_law(bend_seen() * bend_seen() * bend_seen()), Power{1e-3, 2.0}));
  scene.mats[0] = mass(0.02, scene.mats[0].position);
  World world = make_world(scene);
  run(world, 500);
  Vec3 momentum = Vec3::Zero();
  for (std::uint32_t i = 0; i < scene.mats.size(); ++i) momentum += 0.02 * world.velocity(i);
  EXPECT_LT(momentum.norm(), 1e-12);
}

TEST(BendLaw, StepsWithoutAllocating) {
  World world = make_world(
      rod_of_law(2, of_laws(expression_law(Term(0.1) * sine_of(bend_seen())), Power{1e-4, 1.5})));
  world.step();
  const AllocationGuard guard;
  run(world, 20);
  EXPECT_EQ(guard.count(), 0u);
}

TEST(BendLaw, ChangesStateWithTheAccount) {
  const Law cubic = expression_law(Term(0.4) * bend_seen() * bend_seen() * bend_seen());
  for (const IntegratorKind integrator : {IntegratorKind::kCordis, IntegratorKind::kLeapfrog}) {
    StateMachine machine = Behaving()
                               .state(0.02)
                               .exit(size(q(Quantity::kBend)) > 0.3, 1)
                               .state(0.0)
                               .exit(size(q(Quantity::kBend)) < 0.15, 0)
                               .state_machine;
    machine.states[1].elasticity = cubic;
    NetworkDescription scene = rod_of_law(2, machine);
    scene.integrator = integrator;
    scene.step = 2e-5;
    World world = make_world(scene);
    std::size_t changes = 0;
    for (int n = 0; n < 20'000; ++n) {
      world.step();
      changes += world.events().size();
    }
    const engine::Energy energy = world.energy();
    EXPECT_GT(changes, 4u);
    EXPECT_GT(std::abs(energy.switching), 1e-5);
    EXPECT_LT(std::abs(energy.elastic_error), 2e-3 * energy.initial);
  }
}

TEST(BendLaw, GoesOnFromASnapshot) {
  StateMachine machine = Behaving()
                             .state(0.02)
                             .exit(size(q(Quantity::kBend)) > 0.3, 1, RestRule::kHere)
                             .state(0.01)
                             .exit(q(Quantity::kAge) > 0.01, 0)
                             .state_machine;
  machine.states[1].elasticity = Table({-1.0, 0.0, 1.0}, {-0.02, 0.0, 0.02});
  machine.states[0].dissipation = Power{1e-4, 1.0};
  World world = make_world(rod_of_law(2, machine));
  run(world, 300);
  const auto snapshot = world.snapshot();
  run(world, 300);
  const auto hash = world.state_hash();
  const double total = world.energy().total();
  world.restore(snapshot);
  run(world, 300);
  EXPECT_EQ(world.state_hash(), hash);
  EXPECT_EQ(world.energy().total(), total);
}

}  // namespace
}  // namespace cordis::test
