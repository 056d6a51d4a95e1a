// tests/scene/formula_of_liaison_test.cpp -- formulas in Maxwell elements, bends and sets.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "sim_node/engine/world.h"
#include "sim_node/plan/plan.h"
#include "sim_node/plan/stability/port_limit.h"
#include "sim_node/scene/parameters.h"
#include "tests/scene/bad_scene.h"
#include "tests/support/filled.h"

namespace cordis::scene {
namespace {

using engine::Vec3;

engine::World started(const Scene& scene) {
  return engine::World(std::make_shared<const engine::Network>(scene.network));
}

void step_to(engine::World& world, double time) {
  const double dt = world.network().step();
  while (static_cast<double>(world.step_count()) * dt < time - 0.5 * dt) world.step();
}

/// A scene at another rate.
Scene at_rate(Scene scene, double rate_hz) {
  scene.network.step = 1.0 / rate_hz;
  return scene;
}

/// Values of an ordinary differential equation after a time, by the classical method of Runge and Kutta.
template <std::size_t kCount, class Rate>
std::array<double, kCount> integrated(std::array<double, kCount> y, double time, Rate rate) {
  constexpr int kSteps = 20000;
  const double h = time / kSteps;
  const auto moved = [](std::array<double, kCount> from, const std::array<double, kCount>& by,
                        double share) {
    for (std::size_t i = 0; i < kCount; ++i) from[i] += share * by[i];
    return from;
  };
  for (int n = 0; n < kSteps; ++n) {
    const double t = n * h;
    const auto k1 = rate(t, y);
    const auto k2 = rate(t + 0.5 * h, moved(y, k1, 0.5 * h));
    const auto k3 = rate(t + 0.5 * h, moved(y, k2, 0.5 * h));
    const auto k4 = rate(t + h, moved(y, k3, h));
    for (std::size_t i = 0; i < kCount; ++i)
      y[i] += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
  }
  return y;
}

/// Nothing is missing from the account, and the steps have brought in no more than a share of its energy.
void expect_closed(const engine::World& world, double share) {
  const engine::Energy energy = world.energy();
  EXPECT_LT(std::abs(energy.residual()), 1e-10 * energy.largest);
  EXPECT_LT(std::abs(energy.integration_error()), share * energy.largest);
}

/// Errors at a rate and at twice it are those of a method of second order.
void expect_second_order(double error, double error_of_half) {
  EXPECT_GT(std::abs(error), 3.3 * std::abs(error_of_half));
  EXPECT_LT(std::abs(error), 4.7 * std::abs(error_of_half));
}

std::string on_maxwell(const std::string& parameters) {
  return test::filled(R"(liaisons:
  t: {kind: maxwell, <parameters>}
  s: {kind: spring, stiffness_n_per_m: 20, rest_m: 0.5}
matter:
  a: {kind: fixed, at_m: 0}
  b: {kind: mass, mass_kg: 1, at_m: 0.5, velocity_m_per_s: 0.8}
links:
  - {liaison: t, between: [a, b], name: l}
  - {liaison: s, between: [a, b]}
signals:
  x: {of: b, quantity: position}
)",
                      {{"parameters", parameters}});
}

TEST(FormulaOfLiaison, ChangesAMaxwellElementAsItsEquationSays) {
  // e' = v - (K / Z) e and v' = -K e - 20 (x - 0.5), with e the elongation of its spring
  constexpr double kTime = 1.5;
  const auto truth = integrated<3>({0.5, 0.8, 0.0}, kTime, [](double t, const auto& y) {
    const double k = 100.0 + 60.0 * std::sin(9.0 * t);
    const double z = 5.0 + 2.0 * std::cos(4.0 * t);
    return std::array<double, 3>{y[1], -k * y[2] - 20.0 * (y[0] - 0.5), y[1] - k / z * y[2]};
  });
  const Scene scene = sound_scene(1, on_maxwell("stiffness_n_per_m: 100 + 60 * sin(9 * time_s), "
                                                "viscosity_n_s_per_m: 5 + 2 * cos(4 * time_s)"));
  ASSERT_TRUE(scene.network.maxwell_links[0].follows_variables());
  std::array<double, 2> error{};
  for (std::size_t i = 0; i < 2; ++i) {
    engine::World world = started(at_rate(scene, i == 0 ? 500.0 : 1000.0));
    step_to(world, kTime);
    error[i] = world.position(1).x() - truth[0];
    expect_closed(world, 1e-3);
    EXPECT_GT(std::abs(world.energy().switching), 0.01 * world.energy().largest);
  }
  EXPECT_LT(std::abs(error[1]), 1e-5);
  expect_second_order(error[0], error[1]);
}

TEST(FormulaOfLiaison, OfAMaxwellElementKeepsItsSpringWhileItHasNoForce) {
  // Without a damper in sight it is a spring K(t) (x - 0.5), that is let go of and comes back.
  const char* k = "\"80 * max(sin(6 * time_s), 0)\"";
  const Scene maxwell = sound_scene(
      1, on_maxwell(std::string("stiffness_n_per_m: ") + k + ", viscosity_n_s_per_m: 1.0e+12"));
  std::string text = on_maxwell("viscosity_n_s_per_m: 1, stiffness_n_per_m: 1");
  text.replace(text.find("{kind: maxwell"), text.find('}') - text.find("{kind: maxwell"),
               std::string("{kind: spring, rest_m: 0.5, stiffness_n_per_m: ") + k);
  const Scene spring = sound_scene(1, text);
  engine::World one = started(maxwell);
  engine::World other = started(spring);
  for (int n = 0; n < 3000; ++n) {
    one.step();
    other.step();
    ASSERT_NEAR(one.position(1).x(), other.position(1).x(), 2e-5) << n;
  }
  expect_closed(one, 1e-3);
}

TEST(FormulaOfLiaison, OfOneValueIsThatValue) {
  const auto path = [](const std::string& parameters) {
    engine::World world = started(sound_scene(1, on_maxwell(parameters)));
    for (int n = 0; n < 500; ++n) world.step();
    return world.position(1).x();
  };
  EXPECT_NEAR(path("stiffness_n_per_m: 60, viscosity_n_s_per_m: 3, start_force_n: 2"),
              path("stiffness_n_per_m: 60 + 0 * x, viscosity_n_s_per_m: 3 + 0 * time_s, "
                   "start_force_n: 2"),
              1e-13);
}

TEST(FormulaOfLiaison, KnowsPi) {
  const Scene scene = sound_scene(1, R"YAML(liaisons:
  a: {kind: spring, parameters: {turn: 2 * pi}, stiffness_n_per_m: turn * pi}
  own: {kind: spring, parameters: {pi: 3}, stiffness_n_per_m: 2 * pi}
  late: {states: {x: {stiffness_n_per_m: 1, viscosity_n_s_per_m: "2 + sin(2 * pi * time_s)",
                      exits: [{to: y, when: elongation_m > pi / 100}]}, y: {final: true}}}
matter:
  m: {kind: mass, mass_kg: 1, at_m: [0, 1]}
links:
  - {liaison: a, between: ["m[0]", "m[1]"]}
  - {liaison: own, between: ["m[0]", "m[1]"]}
  - {liaison: late, between: ["m[0]", "m[1]"]}
)YAML");
  const double pi = std::acos(-1.0);
  EXPECT_DOUBLE_EQ(scene.network.links[0].stiffness, 2.0 * pi * pi);
  EXPECT_DOUBLE_EQ(scene.network.links[1].stiffness, 6.0);
  const auto& machine = scene.network.state_machines[scene.network.state_links[0].state_machine];
  const auto& condition = machine.exits[0].when.code;
  EXPECT_TRUE(std::ranges::any_of(
      condition, [pi](const engine::Instruction& each) { return each.constant == pi / 100.0; }));
}

/// Two fixed points and a mass of 0.1 kg at a height, on a bend, in 1 dimension.
std::string on_bend(const std::string& parameters) {
  return test::filled(R"(liaisons:
  t: {kind: bending, length_m: 0.1, <parameters>}
matter:
  a: {kind: fixed, at_m: 0}
  b: {kind: fixed, at_m: 0}
  c: {kind: mass, mass_kg: 0.1, at_m: 0.01}
links:
  - {liaison: t, between: [a, b, c], name: l}
signals:
  height: {of: c, quantity: position}
)",
                      {{"parameters", parameters}});
}

TEST(FormulaOfLiaison, PumpsABendAtTwiceItsFrequency) {
  // m x'' = -(B(t) x + Z x') / l^2: the equation of Mathieu, which grows
  constexpr double kTime = 2.0;
  constexpr double kPerLength = 1.0 / (0.1 * 0.1 * 0.1);  // of 1 / (l^2 m)
  const auto truth = integrated<2>({0.01, 0.0}, kTime, [](double t, const auto& y) {
    const double b = 0.1 * (1.0 + 0.4 * std::sin(20.0 * t));
    const double z = 2e-5 * (1.0 + t);
    return std::array<double, 2>{y[1], -kPerLength * (b * y[0] + z * y[1])};
  });
  EXPECT_GT(std::hypot(truth[0], truth[1] / 10.0), 0.03);
  const Scene scene =
      sound_scene(1, on_bend("stiffness_n_m_per_rad: 0.1 * (1 + 0.4 * sin(20 * time_s)), "
                             "viscosity_n_m_s_per_rad: 2.0e-5 * (1 + time_s)"));
  std::array<double, 2> error{};
  for (std::size_t i = 0; i < 2; ++i) {
    engine::World world = started(at_rate(scene, i == 0 ? 2000.0 : 4000.0));
    step_to(world, kTime);
    error[i] = world.position(2).x() - truth[0];
    expect_closed(world, 1e-3);
    EXPECT_GT(world.energy().switching, 0.5 * world.energy().largest);
  }
  EXPECT_LT(std::abs(error[1]), 1e-4);
}

TEST(FormulaOfLiaison, TurnsABendByItsRestAngle) {
  // w = v / l - R(t) u / l is linear in the place of the mass.
  // m x'' = -(B / l^2) (v - R(t) u)
  constexpr double kTime = 1.2;
  const auto truth = integrated<4>({0.1, 0.0, 0.0, 0.0}, kTime, [](double t, const auto& y) {
    const double angle = 0.4 * std::sin(5.0 * t);
    const double per_mass = 0.02 / (0.1 * 0.1) / 0.1;
    return std::array<double, 4>{y[2], y[3], -per_mass * (y[0] - 0.1 * std::cos(angle)),
                                 -per_mass * (y[1] - 0.1 * std::sin(angle))};
  });
  const Scene scene = sound_scene(2, R"(liaisons:
  t: {kind: bending, stiffness_n_m_per_rad: 0.02, rest_rad: 0.4 * sin(5 * time_s)}
matter:
  a: {kind: fixed, at_m: [-0.1, 0]}
  b: {kind: fixed, at_m: [0, 0]}
  c: {kind: mass, mass_kg: 0.1, at_m: [0.1, 0]}
links:
  - {liaison: t, between: [a, b, c], name: l}
)");
  std::array<double, 2> error{};
  for (std::size_t i = 0; i < 2; ++i) {
    engine::World world = started(at_rate(scene, i == 0 ? 500.0 : 1000.0));
    step_to(world, kTime);
    error[i] = world.position(2).y() - truth[1];
    expect_closed(world, 1e-3);
  }
  EXPECT_LT(std::abs(error[1]), 1e-5);
  expect_second_order(error[0], error[1]);
}

TEST(FormulaOfLiaison, ChangesTheStatesOfABend) {
  const Scene scene = sound_scene(2, R"(liaisons:
  t:
    kind: bending
    states:
      stiff: {stiffness_n_m_per_rad: 0.05 + 0.02 * sin(30 * time_s), viscosity_n_m_s_per_rad: 1.0e-5 * (1 + time_s),
              exits: [{to: bent, when: abs(bend_rad) > 0.3, rest: here}]}
      bent: {stiffness_n_m_per_rad: 0.02, rest_rad: 0.1 * time_s, exits: [{to: stiff, when: age_s > 0.05}]}
  s: {kind: spring, stiffness_n_per_m: 400}
matter:
  a: {kind: fixed, at_m: [-0.1, 0]}
  b: {kind: mass, mass_kg: 0.05, at_m: [0, 0]}
  c: {kind: mass, mass_kg: 0.05, at_m: [0.1, 0.01], velocity_m_per_s: [0, 1]}
links:
  - {liaison: t, between: [a, b, c], name: l}
  - {liaison: s, between: [a, b]}
  - {liaison: s, between: [b, c]}
)");
  engine::World world = started(at_rate(scene, 8000.0));
  for (int n = 0; n < 8000; ++n) ASSERT_TRUE(world.step().has_energy);
  EXPECT_GT(world.total_change_count(), 5u);
  expect_closed(world, 2e-2);
  // In its second state the bend has the rest angle of the formula.
  while (world.state_of_bend(0) != 1) world.step();
  const double now = static_cast<double>(world.step_count() - 1) * world.network().step();
  EXPECT_NEAR(world.rest_angle_of_bend(0), 0.1 * now, 1e-12);
}

/// Two balls and a third, joined by a liaison as pairs of sets or one by one.
Scene two_balls(const std::string& liaison, bool as_set) {
  constexpr const char* kSets = R"(
  - {liaison: t, within: p, rest_m: 0.12, range_m: 3, name: l}
  - {liaison: t, between_sets: ["p[1]", q], rest_m: 0.12, range_m: 3})";
  constexpr const char* kLinks = R"(
  - {liaison: t, between: ["p[0]", "p[1]"], rest_m: 0.12, name: l}
  - {liaison: t, between: ["p[1]", q], rest_m: 0.12})";
  return sound_scene(2, test::filled(R"(liaisons:
  t: <liaison>
matter:
  p: {kind: mass, mass_kg: 0.3, at_m: [[0, 0], [0.1, 0.02]], velocity_m_per_s: [0.4, 0.1]}
  q: {kind: mass, mass_kg: 0.2, at_m: [0.5, 0.03], velocity_m_per_s: [-0.9, 0]}
links: <links>
signals:
  x: {of: q, quantity: position, axis: x}
)",
                                     {{"liaison", liaison}, {"links", as_set ? kSets : kLinks}}));
}

class FormulaOfSet : public testing::TestWithParam<const char*> {};

TEST_P(FormulaOfSet, DoesWhatItDoesBetweenTwoMats) {
  const Scene set = two_balls(GetParam(), true);
  const Scene links = two_balls(GetParam(), false);
  ASSERT_EQ(set.network.sets.size(), 2u);
  engine::World one = started(set);
  engine::World other = started(links);
  for (int n = 0; n < 1500; ++n) {
    one.step();
    other.step();
    for (std::uint32_t i = 0; i < 3; ++i)
      ASSERT_LT((one.position(i) - other.position(i)).norm(), 1e-12) << n;
  }
  EXPECT_GT((one.position(2) - set.network.mats[2].position).norm(), 0.04);
  const engine::Energy of_set = one.energy();
  const engine::Energy of_links = other.energy();
  const double scale = of_links.largest;
  EXPECT_GT(std::abs(of_links.switching), 1e-5 * scale);
  EXPECT_NEAR(of_set.switching, of_links.switching, 1e-9 * scale);
  EXPECT_NEAR(of_set.dissipated, of_links.dissipated, 1e-9 * scale);
  EXPECT_LT(std::abs(of_set.residual()), 1e-10 * scale);
  EXPECT_NEAR(of_set.integration_error(), of_links.integration_error(), 1e-9 * scale);
}

INSTANTIATE_TEST_SUITE_P(
    Laws, FormulaOfSet,
    testing::Values(
        "{kind: spring, stiffness_n_per_m: 60 + 50 * sin(20 * time_s)}",
        "{kind: spring_damper, stiffness_n_per_m: 60 + 50 * tanh(3 * x), viscosity_n_s_per_m: 0.1 "
        "* (1 + time_s)}",
        "{stiffness_n_per_m: 200 + 150 * sin(20 * time_s), pulls: false}",
        "{stiffness_n_per_m: 200 + 150 * x, pulls: false, viscosity_n_s_per_m: 0.5}",
        "{stiffness_n_per_m: 200 + 150 * sin(20 * time_s), force_limit_n: 3}",
        "{elasticity: (30 + 20 * sin(9 * time_s)) * elongation_m + 900 * elongation_m ^ 3}",
        "{stiffness_n_per_m: 50, elasticity: x * elongation_m, dissipation: 0.2 * (1 + x) * "
        "speed_m_per_s}",
        "{start: near, states: {near: {stiffness_n_per_m: 80 + 30 * sin(11 * time_s), exits: [{to: "
        "far, when: elongation_m > 0.1}]}, far: {stiffness_n_per_m: 20 * (1 + time_s), exits: "
        "[{to: "
        "near, when: elongation_m < 0.05, rest: here}]}}}",
        "{elasticity: {kind: lennard_jones, depth_j: 0.02 * (1 + 0.5 * sin(15 * time_s)), "
        "diameter_m: 0.1}, stiffness_n_per_m: 5}",
        "{elasticity: {kind: lennard_jones, depth_j: 0.02 * (1 + 0.5 * sin(15 * time_s)), "
        "diameter_m: 0.1}}"));

TEST(FormulaOfLiaison, OfADepthIsThatDepth) {
  // The tension is the slope of 4 E ((s/d)^12 - (s/d)^6).
  const char* depth = "0.02 * (1 + 0.5 * sin(15 * time_s))";
  const std::string law =
      std::string("{elasticity: {kind: lennard_jones, depth_j: ") + depth + ", diameter_m: 0.1}}";
  const std::string written =
      std::string("{elasticity: ") + depth +
      " * (24 * 0.1 ^ 6 / distance_m ^ 7 - 48 * 0.1 ^ 12 / distance_m ^ 13)}";
  engine::World one = started(two_balls(law, true));
  engine::World other = started(two_balls(written, false));
  for (int n = 0; n < 1000; ++n) {
    one.step();
    other.step();
    for (std::uint32_t i = 0; i < 3; ++i)
      ASSERT_LT((one.position(i) - other.position(i)).norm(), 1e-9) << n;
  }
  expect_closed(one, 1e-3);
  expect_closed(other, 1e-3);
}

TEST(FormulaOfLiaison, MovesTheRestLengthOfPairs) {
  const char* law = "{kind: spring, stiffness_n_per_m: 90, rest_m: 0.1 + 0.05 * sin(4 * time_s)}";
  const auto links = [&](const std::string& list) {
    return sound_scene(2, std::string("liaisons:\n  t: ") + law + R"(
matter:
  p: {kind: mass, mass_kg: 0.3, at_m: [[0, 0], [0.1, 0.02]]}
links:
)" + list);
  };
  engine::World one = started(links("  - {liaison: t, within: p, range_m: 2}\n"));
  engine::World other = started(links("  - {liaison: t, between: [\"p[0]\", \"p[1]\"]}\n"));
  for (int n = 0; n < 1500; ++n) {
    one.step();
    other.step();
    ASSERT_LT((one.position(0) - other.position(0)).norm(), 1e-12) << n;
  }
  EXPECT_NEAR(one.energy().switching, other.energy().switching, 1e-9 * one.energy().largest);
}

/// Balls that fall on a plane and on each other, on a contact that hardens.
TEST(FormulaOfLiaison, KeepsTheAccountOfContactsThatComeAndGo) {
  const Scene scene = sound_scene(2, R"(world: {gravity_m_per_s2: [0, -9.81]}
liaisons:
  t: {stiffness_n_per_m: 20000 * (1 + 0.5 * sin(8 * time_s)), viscosity_n_s_per_m: 1 + time_s, pulls: false, range: rest}
matter:
  p: {kind: mass, ball: {radius_m: 0.02, mass_kg: 0.05}, at_m: [[0, 0.03], [0.01, 0.08], [-0.01, 0.13], [0.03, 0.1]]}
  floor: {kind: plane, at_m: [0, 0], normal: y}
links:
  - {liaison: t, within: p}
  - {liaison: t, between_sets: [p, floor]}
)");
  engine::World world = started(at_rate(scene, 20000.0));
  for (int n = 0; n < 20000; ++n) ASSERT_TRUE(world.step().has_energy);
  const engine::Energy energy = world.energy();
  EXPECT_GT(std::abs(energy.switching), 1e-6 * energy.largest);
  expect_closed(world, 1e-3);
}

/// A block on an incline of tan 0.4, held by friction that wears off, in metres along the incline.
double slid_after(double time, const std::string& friction) {
  const Scene scene = sound_scene(2, test::filled(R"(world: {gravity_m_per_s2: [3.643, -9.108]}
liaisons:
  t: {stiffness_n_per_m: 50000, viscosity_n_s_per_m: 20, pulls: false, range: rest,
      friction: {<friction>, stiffness_n_per_m: 20000, viscosity_n_s_per_m: 20}}
matter:
  block: {kind: mass, ball: {radius_m: 0.02, mass_kg: 0.2}, at_m: [0, 0.01997]}
  floor: {kind: plane, at_m: [0, 0], normal: y}
links:
  - {liaison: t, between_sets: [block, floor]}
signals:
  x: {of: block, quantity: position, axis: x}
)",
                                                  {{"friction", friction}}));
  engine::World world = started(at_rate(scene, 10000.0));
  step_to(world, time);
  expect_closed(world, 1e-2);
  return world.position(0).x();
}

TEST(FormulaOfLiaison, LetsABlockSlideOnceItsFrictionIsBelowTheIncline) {
  const std::string friction = "static: 0.6 - 0.1 * time_s";
  EXPECT_LT(std::abs(slid_after(1.9, friction)), 2e-4);
  // from 2 s on, x'' = g_x - mu(t) g_y, and x = g_y 0.1 (t - 2)^3 / 6
  EXPECT_NEAR(slid_after(3.2, friction), 9.108 * 0.1 * std::pow(1.2, 3) / 6.0, 5e-3);
  EXPECT_EQ(slid_after(0.5, "static: 0.3, kinetic: 0.2"),
            slid_after(0.5, "static: 0.3 + 0 * x, kinetic: 0.2 + 0 * x"));
  // The kinetic coefficient is at most the static one.
  EXPECT_EQ(slid_after(0.5, "static: 0.1, kinetic: 0.1"),
            slid_after(0.5, "static: 0.1, kinetic: 0.2 + 0 * x"));
}

TEST(FormulaOfLiaison, GoesOnFromASnapshotAsIfNothingHadHappened) {
  const Scene scene = sound_scene(2, R"(liaisons:
  m: {kind: maxwell, stiffness_n_per_m: 100 + 60 * sin(9 * time_s), viscosity_n_s_per_m: 5 + x}
  b: {kind: bending, stiffness_n_m_per_rad: 0.1 * (1 + 0.5 * sin(7 * time_s)), rest_rad: 0.2 * x}
  s: {stiffness_n_per_m: 300 + 100 * sin(13 * time_s), pulls: false, friction: {static: 0.4 + 0.2 * sin(5 * time_s), stiffness_n_per_m: 100}}
matter:
  a: {kind: fixed, at_m: [0, 0]}
  p: {kind: mass, mass_kg: 0.2, at_m: [[0.1, 0], [0.2, 0.02], [0.29, 0]], velocity_m_per_s: [0, 0.1]}
links:
  - {liaison: m, between: [a, "p[0]"]}
  - {liaison: b, between: [a, "p[0]", "p[1]"]}
  - {liaison: s, within: p, rest_m: 0.12, range_m: 0.12}
signals:
  x: {of: "p[0]", quantity: position, axis: x}
)");
  engine::World world = started(scene);
  for (int n = 0; n < 300; ++n) world.step();
  const engine::Snapshot snapshot = world.snapshot();
  for (int n = 0; n < 300; ++n) world.step();
  engine::World again = started(scene);
  for (int n = 0; n < 17; ++n) again.step();
  again.restore(snapshot);
  for (int n = 0; n < 300; ++n) again.step();
  EXPECT_EQ(again.state_hash(), world.state_hash());
  EXPECT_EQ(again.energy().switching, world.energy().switching);
  EXPECT_EQ(again.energy().total(), world.energy().total());
  expect_closed(world, 5e-2);
}

TEST(FormulaOfLiaison, LeavesARestAngleThatIsRestoredWhileItIsNotFinite) {
  const Scene scene =
      sound_scene(1, on_bend("stiffness_n_m_per_rad: 0.1, rest_rad: 0.3 * sqrt(1 - 10 * time_s)"));
  engine::World world = started(scene);
  step_to(world, 0.15);
  const double rest = world.rest_angle_of_bend(0);
  EXPECT_LT(rest, 0.03);  // as it was just before 0.1 s
  const engine::Snapshot snapshot = world.snapshot();
  engine::World again = started(scene);
  step_to(again, 0.05);
  ASSERT_GT(again.rest_angle_of_bend(0), 0.2);
  again.restore(snapshot);
  EXPECT_EQ(again.rest_angle_of_bend(0), rest);
  for (int n = 0; n < 200; ++n) {
    world.step();
    again.step();
  }
  EXPECT_EQ(again.rest_angle_of_bend(0), rest);
  EXPECT_EQ(again.state_hash(), world.state_hash());
}

TEST(FormulaOfLiaison, OfFrictionIsThatOfItsStateAlone) {
  // The first state has the formula, and the second slides freely whatever that is.
  const auto path = [](const std::string& coefficient, const std::string& start) {
    const std::string text = test::filled(R"(liaisons:
  t:
    friction: {static: 0.1, stiffness_n_per_m: 100}
    start: <start>
    states:
      rough: {stiffness_n_per_m: 300, pulls: false, friction: {static: <coefficient>, stiffness_n_per_m: 100}, exits: [{to: smooth, when: age_s > 0.03}]}
      smooth: {stiffness_n_per_m: 300, pulls: false, friction: {static: 0, stiffness_n_per_m: 100}, exits: [{to: rough, when: age_s > 0.05}]}
matter:
  a: {kind: fixed, at_m: [0, 0]}
  p: {kind: mass, mass_kg: 0.2, at_m: [[0.01, 0.1], [0.02, 0.2]], velocity_m_per_s: [0.1, -0.5]}
links:
  - {liaison: t, between_sets: [p, a], rest_m: 0.12, range_m: 0.12, name: l}
  - {liaison: t, within: p, rest_m: 0.12, range_m: 0.12}
)",
                                          {{"coefficient", coefficient}, {"start", start}});
    engine::World world = started(sound_scene(2, text));
    std::vector<Vec3> places;
    for (int n = 0; n < 120; ++n) {
      world.step();
      places.push_back(world.position(1));
    }
    return places;
  };
  for (const char* start : {"rough", "smooth"}) {
    EXPECT_EQ(path("0.4", start), path("0.4 + 0 * time_s", start)) << start;
    EXPECT_NE(path("0.1", start), path("0.4 + 0 * time_s", start)) << start;
  }
}

TEST(FormulaOfLiaison, OfAStartForceWithoutAStiffnessIsNoForce) {
  const Scene scene = sound_scene(
      1, on_maxwell("stiffness_n_per_m: 100 * sin(3 * time_s) ^ 2, viscosity_n_s_per_m: 5, "
                    "start_force_n: 5"));
  engine::World world = started(scene);
  EXPECT_LT(world.energy().total(), 1.0);
  for (int n = 0; n < 500; ++n) world.step();
  EXPECT_LT(std::abs(world.position(1).x()), 2.0);
  expect_closed(world, 1e-2);
}

TEST(FormulaOfLiaison, OfARestAngleThatIsNeverFiniteChangesNothing) {
  const Scene scene =
      sound_scene(1, on_bend("stiffness_n_m_per_rad: 0.1, rest_rad: 0.3 * sqrt(-1 - height ^ 2)"));
  engine::World world = started(scene);
  EXPECT_EQ(world.rest_angle_of_bend(0), 0.0);
  for (int n = 0; n < 50; ++n) world.step();
  EXPECT_EQ(world.rest_angle_of_bend(0), 0.0);
}

TEST(FormulaOfLiaison, OfARestLengthKeepsTheAccountWhileTheEndsMeet) {
  // There it has no direction and does not pull, though what it stores changes with its rest length.
  const Scene scene = sound_scene(2, R"(liaisons:
  rod: {kind: spring, stiffness_n_per_m: 100, rest_m: 0.1 + 0.01 * sin(20 * time_s)}
matter:
  m: {kind: points, mass_kg: 1, at_m: [[0, 0], [0, 0]]}
links:
  - {liaison: rod, between: ["m[0]", "m[1]"]}
)");
  engine::World world = started(scene);
  for (int i = 0; i < 500; ++i) world.step();
  EXPECT_EQ(world.position(1), Vec3(0.0, 0.0, 0.0));
  const double stored = 50.0 * std::pow(0.1 + 0.01 * std::sin(20.0 * 0.499), 2);
  EXPECT_NEAR(world.energy().switching, stored - 0.5, 1e-12);
  expect_closed(world, 1e-12);
}

TEST(FormulaOfLiaison, OfAContactBelowZeroKeepsTheAccount) {
  const auto run = [](double rate) {
    engine::World world = started(at_rate(
        two_balls("{stiffness_n_per_m: 200 + 900 * cos(25 * time_s), pulls: false}", true), rate));
    step_to(world, 1.0);
    const engine::Energy energy = world.energy();
    EXPECT_LT(std::abs(energy.residual()), 1e-10 * energy.largest);
    return energy.integration_error() / energy.largest;
  };
  const double error = run(2000.0);
  EXPECT_LT(std::abs(error), 3e-2);
  EXPECT_LT(std::abs(run(8000.0)), 0.2 * std::abs(error));
}

TEST(FormulaOfLiaison, IsSetToANumberWhileARunGoesOn) {
  const std::string maxwell = on_maxwell(
      "parameters: {swing: 60}, stiffness_n_per_m: 100 + swing * sin(9 * time_s), "
      "viscosity_n_s_per_m: 5");
  const std::string bend =
      on_bend("stiffness_n_m_per_rad: 0.1 * (1 + time_s), viscosity_n_m_s_per_rad: 1.0e-6");
  const auto set = [](const std::string& text, const char* parameter, double value) {
    const Scene scene = sound_scene(1, text);
    Parameters parameters(std::make_shared<const Scene>(scene));
    const Parameters::Outcome outcome = parameters.set("l", parameter, value);
    EXPECT_EQ(outcome.problem, "");
    engine::World world = started(scene);
    for (int n = 0; n < 100; ++n) world.step();
    engine::NetworkDescription changed = scene.network;
    for (const Change& change : outcome.changes) apply(change, changed);
    engine::World next(std::make_shared<const engine::Network>(changed));
    std::vector<double> room;
    room.reserve(next.max_values_of_state());
    EXPECT_TRUE(next.take_over(world, room));
    for (int n = 0; n < 100; ++n) next.step();
    EXPECT_LT(std::abs(next.energy().residual()), 1e-10 * next.energy().largest);
    return outcome.changes.at(0).state_machine.states.at(0);
  };
  EXPECT_EQ(set(maxwell, "stiffness_n_per_m", 300.0).stiffness, 300.0);
  EXPECT_FALSE(is_none(set(maxwell, "swing", 10.0).elasticity));
  EXPECT_EQ(set(bend, "stiffness_n_m_per_rad", 0.3).stiffness, 0.3);
  EXPECT_EQ(set(bend, "viscosity_n_m_s_per_rad", 1e-5).viscosity, 1e-5);
}

plan::Stability stability_of(const Scene& scene) {
  return plan::stability_of(scene.network, plan::liaison_graph(scene.network));
}

/// Certified as long as with the largest numbers.
void expect_as_with(const Scene& scene, const Scene& with_largest) {
  const plan::Stability stability = stability_of(scene);
  const plan::Stability largest = stability_of(with_largest);
  EXPECT_FALSE(stability.uncertainty) << stability.uncertainty->why;
  EXPECT_FALSE(largest.uncertainty);
  EXPECT_NEAR(stability.certified.step, largest.certified.step, 0.03 * largest.certified.step);
  EXPECT_LE(stability.certified.step, largest.certified.step * (1.0 + 1e-9));
  EXPECT_FALSE(stability.diverges());
}

TEST(CertificateOfFormulas, IsThatOfTheLargestValue) {
  // The rate of a step is the mean of two, and may be that of the mean of 40 and 160 N/m.
  expect_as_with(sound_scene(1, on_maxwell("stiffness_n_per_m: 100 + 60 * sin(9 * time_s), "
                                           "viscosity_n_s_per_m: 5 + 2 * cos(4 * x)")),
                 sound_scene(1, on_maxwell("stiffness_n_per_m: 160, viscosity_n_s_per_m: 11.2")));
  // Where it jumps from 0 to 16000 N/m, a step has half the rate.
  expect_as_with(sound_scene(1, on_maxwell("stiffness_n_per_m: 8000 * (1 + sin(900 * time_s)), "
                                           "viscosity_n_s_per_m: 20")),
                 sound_scene(1, on_maxwell("stiffness_n_per_m: 16000, viscosity_n_s_per_m: 40")));
  expect_as_with(sound_scene(1, on_bend("stiffness_n_m_per_rad: 0.1 * (1 + 0.4 * tanh(height)), "
                                        "viscosity_n_m_s_per_rad: 1.0e-5 * (1 + sin(time_s))")),
                 sound_scene(1, on_bend("stiffness_n_m_per_rad: 0.14, "
                                        "viscosity_n_m_s_per_rad: 2.0e-5")));
  const auto set = [](const char* contact) { return two_balls(contact, true); };
  expect_as_with(set("{stiffness_n_per_m: 200 + 150 * sin(20 * time_s), pulls: false}"),
                 set("{stiffness_n_per_m: 350, pulls: false}"));
  expect_as_with(set("{stiffness_n_per_m: 200, pulls: false, friction: {static: 0.5 + 0.3 * "
                     "sin(x), stiffness_n_per_m: 100}}"),
                 set("{stiffness_n_per_m: 200, pulls: false, friction: {static: 0.8, "
                     "stiffness_n_per_m: 100}}"));
}

TEST(CertificateOfFormulas, CountsNothingAsSureThatMayBeLess) {
  // A device is refused for what surely acts on it.
  const auto least = [](const char* law) {
    const Scene scene = sound_scene(1, test::filled(R"(liaisons:
  t: <law>
matter:
  a: {kind: fixed, at_m: 0}
  b: {kind: mass, mass_kg: 1, at_m: 0.1}
links:
  - {liaison: t, between: [a, b]}
)",
                                                    {{"law", law}}));
    return plan::port_loads(plan::liaison_graph(scene.network), plan::LoadBound::kMin)[1].stiffness;
  };
  EXPECT_EQ(least("{kind: spring, stiffness_n_per_m: 5010}"), 5010.0);
  EXPECT_EQ(least("{kind: spring, stiffness_n_per_m: \"10 + 5000 * max(sin(time_s), 0)\"}"), 0.0);
  EXPECT_EQ(least("{kind: maxwell, stiffness_n_per_m: 5010, viscosity_n_s_per_m: 2 + sin(time_s)}"),
            0.0);
}

/// Not certain, for it asks for a position, and that is named.
void expect_uncertain(const Scene& scene, plan::LiaisonKind kind) {
  const plan::Stability stability = stability_of(scene);
  ASSERT_TRUE(stability.uncertainty);
  EXPECT_EQ(stability.uncertainty->liaison.kind, kind);
  ASSERT_EQ(stability.uncertainty->variables.size(), 1u) << stability.uncertainty->why;
  EXPECT_EQ(scene.network.variables[stability.uncertainty->variables[0]].quantity,
            engine::VariableKind::kPosition);
}

TEST(CertificateOfFormulas, NamesWhatNothingBounds) {
  using plan::LiaisonKind;
  expect_uncertain(sound_scene(1, on_maxwell("stiffness_n_per_m: 100 + 9 * x, "
                                             "viscosity_n_s_per_m: 5 + sin(time_s)")),
                   LiaisonKind::kMaxwellLink);
  expect_uncertain(sound_scene(1, on_bend("stiffness_n_m_per_rad: 1 + height ^ 2")),
                   LiaisonKind::kBend);
  expect_uncertain(sound_scene(1, on_bend("stiffness_n_m_per_rad: 1 + 2 * tanh(height)")),
                   LiaisonKind::kBend);
  expect_uncertain(sound_scene(1, on_bend("stiffness_n_m_per_rad: 1, viscosity_n_m_s_per_rad: "
                                          "0.001 * tanh(height)")),
                   LiaisonKind::kBend);
  const auto set = [](const char* contact) { return two_balls(contact, true); };
  expect_uncertain(set("{stiffness_n_per_m: 200 + 150 * x, pulls: false}"), LiaisonKind::kSet);
  expect_uncertain(set("{stiffness_n_per_m: 200, pulls: false, friction: {static: 0.5 + x ^ 2, "
                       "stiffness_n_per_m: 100}}"),
                   LiaisonKind::kSet);
  expect_uncertain(set("{elasticity: {kind: lennard_jones, depth_j: 0.02 * (1 + 0.5 * sin(x)), "
                       "diameter_m: 0.1}}"),
                   LiaisonKind::kSet);
  // A viscosity that nothing bounds leaves an element at most as stiff as its spring.
  EXPECT_FALSE(stability_of(sound_scene(1, on_maxwell("stiffness_n_per_m: 100, "
                                                      "viscosity_n_s_per_m: 5 + x ^ 2")))
                   .uncertainty);
}

class BadFormulas : public BadScenes {};

TEST_P(BadFormulas, HaveOneProblemAtItsPlace) {
  expect_only_problem(GetParam());
}

INSTANTIATE_TEST_SUITE_P(
    OfLiaisons, BadFormulas,
    testing::Values(
        BadScene{kHead2,
                 R"(liaisons:
  l: {kind: maxwell, stiffness_n_per_m: "2 + ^tim_s", viscosity_n_s_per_m: 3}
matter:
  m: {kind: mass, mass_kg: 1, at_m: [0, 0]}
)",
                 "'stiffness_n_per_m' in liaison 'l' names 'tim_s', which is no quantity and no "
                 "parameter",
                 "did you mean 'time_s'?"},
        BadScene{kHead2,
                 R"(liaisons:
  l: {kind: maxwell, stiffness_n_per_m: 2 * time_s, viscosity_n_s_per_m: ^-3}
matter:
  m: {kind: mass, mass_kg: 1, at_m: [0, 0]}
)",
                 "'viscosity_n_s_per_m' in liaison 'l' must be > 0, got -3", ""},
        BadScene{kHead2,
                 R"(liaisons:
  l: {kind: bending, stiffness_n_m_per_rad: "2 * ^bend_rad"}
matter:
  m: {kind: mass, mass_kg: 1, at_m: [0, 0]}
)",
                 "'stiffness_n_m_per_rad' in liaison 'l' is fixed before the run and cannot ask "
                 "for 'bend_rad'",
                 ""},
        BadScene{kHead3,
                 R"(liaisons:
  l: {kind: bending, stiffness_n_m_per_rad: 2, rest_rad: ^0.1 * time_s}
matter:
  m: {kind: mass, mass_kg: 1, at_m: [0, 0, 0]}
)",
                 "in 3 dimensions a bend has no sign, so the rest of liaison 'l' is straight",
                 "a spring between the two ends holds an angle"},
        BadScene{kHead2,
                 R"(liaisons:
  l: {stiffness_n_per_m: 9, friction: {static: 1, stiffness_n_per_m: "2 + ^time_s"}}
matter:
  m: {kind: mass, mass_kg: 1, at_m: [0, 0]}
)",
                 "'stiffness_n_per_m' in friction of liaison 'l' names 'time_s', which is no "
                 "quantity and no parameter",
                 ""}));

}  // namespace
}  // namespace cordis::scene
