// tests/plan/slope_test.cpp
#include "sim_node/plan/stability/slope.h"

#include <cmath>

#include <gtest/gtest.h>

#include "sim_node/plan/stability/liaison_graph.h"
#include "tests/engine/programs.h"
#include "tests/plan/networks.h"

namespace cordis::test {
namespace {

using engine::Law;
using plan::largest_slope;
using plan::Reach;
using plan::Slope;

Law lennard_jones(double well_depth, double diameter) {
  return engine::LennardJones{well_depth, diameter};
}

TEST(Slope, OfLennardJonesGrowsWithTheEnergyOfTheApproach) {
  // Curvature at the turning point in units of depth / diameter^2, by hand
  // (docs/stability.md, "Laws without a largest slope").
  const engine::StateMachine ball = state_machine(0.0, lennard_jones(2.0, 0.5));
  for (const auto& [energy, curvature] :
       {std::pair(1.0, 752.0), std::pair(5.0, 1879.0), std::pair(100.0, 32032.0)}) {
    const Slope slope = largest_slope(ball, 0.5, 3, Reach{0.0, 0.0, 2.0 * energy});
    EXPECT_NEAR(slope.stiffness, curvature * 2.0 / 0.25, 0.001 * slope.stiffness);
    EXPECT_FALSE(slope.bounded);
  }
}

TEST(Slope, OfALawOfTheDistanceIsNotCertainWhereTheEndsPassEachOther) {
  engine::StateMachine ball = state_machine(0.0, lennard_jones(2.0, 0.5));
  EXPECT_EQ(largest_slope(ball, 0.5, 1, Reach{0.0, 0.0, 2.0}).uncertainty, nullptr);
  ball.states[0].pushes = false;
  EXPECT_NE(largest_slope(ball, 0.5, 1, Reach{0.0, 0.0, 2.0}).uncertainty, nullptr);
  EXPECT_EQ(largest_slope(ball, 0.5, 3, Reach{0.0, 0.0, 2.0}).uncertainty, nullptr);
  ball.states[0].elasticity = engine::Rings{{{.stiffness = 2.0, .radius = 0.3}}};
  EXPECT_NE(largest_slope(ball, 0.5, 1, Reach{0.0, 0.0, 2.0}).uncertainty, nullptr);
}

/// What pushes at a positive distance pulls at a negative one: `pulls: false` cuts the wall off from behind.
TEST(Slope, OfALinkThatComesFromBehindIsNotCertain) {
  for (const bool pulls : {true, false}) {
    for (const double distance : {-0.6, 0.6}) {
      for (const int dimension : {1, 2}) {
        NetworkDescription scene = oscillator(0.01, 0.0, 0.0, distance, 0.0, 1e-5);
        scene.dimension = dimension;
        scene.links.clear();
        scene.state_machines = {state_machine(3.0, lennard_jones(0.01, 0.5))};
        scene.state_machines[0].states[0].pulls = pulls;
        scene.state_links = {{0, 1, 0, 0.5}};
        const auto uncertainty = plan::liaison_graph(scene).uncertainty;
        const bool from_behind = dimension == 1 && !pulls && distance < 0.0;
        EXPECT_EQ(uncertainty.has_value(), from_behind) << pulls << distance << dimension;
      }
    }
  }
}

TEST(Slope, OfATableIsThatOfItsSteepestPiece) {
  const engine::Table law{{-0.01, 0.0, 0.02, 0.03}, {-8.0, 0.0, 1.0, 1.0}};

  const Slope slope = largest_slope(state_machine(5.0, law), 0.1, 3, {});

  EXPECT_DOUBLE_EQ(slope.stiffness, 805.0);
  EXPECT_TRUE(slope.bounded);
}

TEST(Slope, OfATensionThatLastsIsAlsoAcrossTheLink) {
  // 10 N at 2 cm: across the link that is 500 N/m, while the tension itself does not grow.
  engine::Table law{{-0.08, 0.0, 1.0}, {0.0, 1.0, 1.0}};
  EXPECT_NEAR(largest_slope(state_machine(0.0, law), 0.1, 1, {}).stiffness, 12.5, 1e-12);
  law = {{-0.0801, -0.08, 1.0}, {9.99, 10.0, 10.0}};
  EXPECT_NEAR(largest_slope(state_machine(0.0, law), 0.1, 3, {}).stiffness, 10.0 / 0.02, 5.0);
  EXPECT_LE(largest_slope(state_machine(0.0, law), 0.1, 1, {}).stiffness, 101.0);
}

TEST(Slope, OfAPowerIsThatWhereItHasTakenUpTheEnergyThereIs) {
  // 1e5 e^2.5 / 2.5 = 0.4 J at e = 0.01 m.
  const engine::Power law{1e5, 1.5};
  Reach reach{5.0, 0.0, 0.0};
  reach.brought = 0.4;

  const Slope slope = largest_slope(state_machine(0.0, law), 0.0, 1, reach);

  const double e = std::pow(1e-5, 0.4);
  EXPECT_NEAR(slope.stiffness, 1e5 * 1.5 * std::sqrt(e), 0.03 * slope.stiffness);
  EXPECT_GE(slope.stiffness, 1e5 * 1.5 * std::sqrt(e));
  EXPECT_FALSE(slope.bounded);
  EXPECT_EQ(slope.uncertainty, nullptr);
}

TEST(Slope, IsInUncertaintyOfWhatPullsWhereItsEndsMeetAndTurns) {
  const engine::Rings orbit{{{-50.0, 0.2}}};
  const engine::Table rope{{0.0, 0.1}, {2.0, 3.0}};
  const engine::Power constant{4.0, 0.0};
  for (const Law& law : {Law(orbit), Law(rope), Law(constant)}) {
    EXPECT_NE(largest_slope(state_machine(0.0, law), 0.0, 2, Reach{0.3}).uncertainty, nullptr)
        << law.index();
  }
  EXPECT_NE(largest_slope(state_machine(40.0), -0.02, 3, Reach{0.3}).uncertainty, nullptr);
  // A chord never turns; what pushes at 0, or never pulls, never pulls its ends about each other.
  EXPECT_EQ(largest_slope(state_machine(0.0, rope), 0.0, 1, Reach{0.3}).uncertainty, nullptr);
  EXPECT_EQ(largest_slope(state_machine(40.0), 0.02, 3, Reach{0.3}).uncertainty, nullptr);
  EXPECT_EQ(largest_slope(contact(40.0), -0.02, 3, Reach{0.3}).uncertainty, nullptr);
}

TEST(Slope, IsInUncertaintyOfWhatPullsThereUnlessItsOwnEndsDecideWhenItStops) {
  engine::StateMachine stops = state_machine(40.0);
  stops.states.emplace_back();
  stops.states[0].last_exit = 1;
  stops.exits.emplace_back();
  stops.exits[0].target = 1;
  stops.exits[0].when.code = {
      {engine::Operation::kQuantity, engine::Quantity::kElongation, 0.0, 0}};
  EXPECT_EQ(largest_slope(stops, -0.02, 2, Reach{0.3}).uncertainty, nullptr);

  for (const engine::Quantity blind : {engine::Quantity::kAge, engine::Quantity::kImpulse}) {
    stops.exits[0].when.code = {{engine::Operation::kQuantity, blind, 0.0, 0}};
    EXPECT_NE(largest_slope(stops, -0.02, 2, Reach{0.3}).uncertainty, nullptr);
  }

  stops.exits[0].when.code = {{engine::Operation::kVariable, {}, 0.0, 0}};
  EXPECT_NE(largest_slope(stops, -0.02, 2, Reach{0.3}).uncertainty, nullptr);
}

TEST(Slope, OfAnExpressionCountsItsSpeedAsViscosity) {
  const Term e = q(Quantity::kElongation);
  const Term v = q(Quantity::kSpeed);
  const Slope slope =
      largest_slope(state_machine(0.0, expression_law(80.0 * e + 3.0 * v)), 0.0, 1, Reach{});

  EXPECT_DOUBLE_EQ(slope.stiffness, 80.0) << "at rest, where nothing has any reach";
  EXPECT_DOUBLE_EQ(slope.viscosity, 3.0);
  EXPECT_TRUE(slope.bounded);
}

TEST(Slope, OfAnExpressionKnowsTheMassesOfItsEnds) {
  const Term law = 1e4 * q(Quantity::kMassB) * q(Quantity::kElongation);
  Reach reach;
  reach.mass_b = {0.01, 0.02};
  EXPECT_DOUBLE_EQ(largest_slope(state_machine(0.0, expression_law(law)), 0.0, 1, reach).stiffness,
                   200.0);
}

TEST(Slope, OfAnExpressionThatEnergyConfinesKnowsTheMassesOfItsEnds) {
  const Term e = q(Quantity::kElongation);
  const engine::StateMachine cubic =
      state_machine(0.0, expression_law(1e4 * q(Quantity::kMassB) * e * e * e));
  Reach reach{0.1};
  reach.brought = 0.4;
  reach.mass_b = {0.01, 0.02};

  const Slope slope = largest_slope(cubic, 0.0, 1, reach);

  EXPECT_EQ(slope.uncertainty, nullptr);
  EXPECT_FALSE(slope.bounded);
  // The lightest mass is stretched the most, m K e^4 / 4 being all energy; the heaviest is steepest.
  const double stretched = std::pow(4.0 * 0.4 / (1e4 * 0.01), 0.25);
  EXPECT_NEAR(slope.stiffness, 3.0 * 1e4 * 0.02 * stretched * stretched, 0.06 * slope.stiffness);
}

TEST(Slope, OfAnExpressionThatJumpsOrGrowsBeyondAllEnergyIsInUncertainty) {
  const Term d = q(Quantity::kDistance);
  const Term e = q(Quantity::kElongation);
  for (const Term& law : {one(Operation::kSign, e), 1.0 / d}) {
    EXPECT_NE(
        largest_slope(state_machine(0.0, expression_law(law)), 0.0, 1, Reach{0.1}).uncertainty,
        nullptr);
  }
  EXPECT_EQ(largest_slope(state_machine(0.0, expression_law(one(Operation::kTanh, e))), 0.0, 1,
                          Reach{0.1})
                .uncertainty,
            nullptr);
}

/// A step is not certain where it is in reach, and ends what is bounded where it is not.
TEST(Slope, OfAnExpressionWithAStepHoldsUpToTheStep) {
  const Term e = q(Quantity::kElongation);
  const engine::StateMachine law = state_machine(
      0.0, expression_law(three(Operation::kSelect, e > 0.01, 1e3 * e + 30.0, 1e3 * e)));
  Reach reach{0.001};
  reach.brought = 1e-5;  // stretches it by 0.14 mm
  const Slope near = largest_slope(law, 0.1, 1, reach);
  EXPECT_EQ(near.uncertainty, nullptr);
  EXPECT_FALSE(near.bounded);
  reach.brought = 1.0;  // by 45 mm
  EXPECT_NE(largest_slope(law, 0.1, 1, reach).uncertainty, nullptr);
}

TEST(Slope, VariesByWhatIsBetweenTheSteepestAndTheFlattestPiece) {
  const Term e = q(Quantity::kElongation);
  const Term d = q(Quantity::kDistance);
  Reach reach{0.1};
  reach.brought = 0.4;
  const auto variation = [&](const engine::StateMachine& all) {
    return largest_slope(all, 0.1, 1, reach).variation;
  };
  EXPECT_EQ(variation(state_machine(70.0)), 0.0);
  EXPECT_NEAR(variation(state_machine(0.0, expression_law(80.0 * e + 3.0 * q(Quantity::kSpeed)))),
              0.0, 1e-9);
  EXPECT_EQ(variation(state_machine(7.0, engine::Power{50.0, 1.0})), 0.0);
  // Constant beyond its ends; from 800 down to -20 N/m.
  EXPECT_NEAR(variation(state_machine(5.0, engine::Table{{-0.01, 0.0, 0.01}, {-8.0, 0.0, 1.0}})),
              800.0, 1e-9);
  EXPECT_NEAR(variation(state_machine(5.0, engine::Table{{-0.01, 0.0, 0.01}, {-8.0, 0.0, -0.2}})),
              820.0, 1e-9);
  EXPECT_NEAR(
      variation(state_machine(0.0, expression_law(60.0 * e + one(Operation::kTanh, 90.0 * e)))),
      90.0, 2.0);
  EXPECT_NEAR(variation(state_machine(0.0, expression_law(40.0 * one(Operation::kSin, 3.0 * d)))),
              240.0, 10.0);
  engine::StateMachine limited = state_machine(30.0);
  limited.states[0].force_limit = 1.0;
  EXPECT_EQ(variation(limited), 30.0);
}

TEST(Enclosure, IsNeverBelowTheSlopeAtAnyPlace) {
  const Term d = q(Quantity::kDistance);
  const Term v = q(Quantity::kSpeed);
  const std::vector<Term> laws{d * d * d - 2.0 * d, one(Operation::kSin, 3.0 * d) * v,
                               one(Operation::kTanh, d * v), one(Operation::kAbs, d - 0.3) * 5.0,
                               one(Operation::kExp, d) / (2.0 + d)};
  for (std::size_t l = 0; l < laws.size(); ++l) {
    const engine::Law law = expression_law(laws[l]);
    const auto& program = std::get<engine::Expression>(law).program;
    plan::LinkBox box{{0.1, 1.1}, {-2.0, 1.5}, 0.0, {}, {}};
    const plan::SteepestSlopes most = plan::steepest_slopes(program, box);
    const double least = plan::flattest_slope(program, box, most.over_distance);
    double steepest = 0.0;
    double flattest = most.over_distance;
    double viscous = 0.0;
    constexpr double kNear = 1e-6;
    for (int i = 0; i < 60; ++i) {
      for (int j = 0; j < 60; ++j) {
        const double elongation = 0.1 + i / 60.0;
        const double speed = -2.0 + 3.5 * j / 60.0;
        const auto tension = [&](double x, double y) { return elastic_tension(law, {x, x, y}); };
        const double slope =
            (tension(elongation + kNear, speed) - tension(elongation, speed)) / kNear;
        steepest = std::max(steepest, slope);
        flattest = std::min(flattest, slope);
        viscous = std::max(
            viscous, (tension(elongation, speed + kNear) - tension(elongation, speed)) / kNear);
      }
    }
    EXPECT_GE(most.over_distance, steepest - 1e-4) << l;
    EXPECT_LE(most.over_distance, 1.2 * steepest + 1e-4) << l;
    EXPECT_LE(least, flattest + 1e-4) << l;
    EXPECT_GE(least, flattest - 0.2 * steepest - 1e-4) << l;
    EXPECT_GE(most.over_speed, viscous - 1e-4) << l;
    EXPECT_LE(most.over_speed, 1.2 * viscous + 1e-4) << l;
    for (const int bisections : {1, 16}) {
      box.bisections = bisections;
      const plan::SteepestSlopes bound = plan::steepest_slopes(program, box);
      EXPECT_GE(bound.over_distance, steepest - 1e-4) << l;
      EXPECT_GE(bound.over_speed, viscous - 1e-4) << l;
      EXPECT_LE(plan::flattest_slope(program, box, most.over_distance), flattest + 1e-4) << l;
    }
  }
}

TEST(Slope, OfRingsIsThatOfTheirSteepestSum) {
  // Pushing within 1 cm, pulling between 1 and 2 cm.
  const engine::Rings law{{{300.0, 0.01}, {-100.0, 0.02}}};

  EXPECT_DOUBLE_EQ(largest_slope(state_machine(0.0, law), 0.0, 1, {}).stiffness, 200.0);
  // At 1 cm it pulls with 1 N: 100 N/m across, still less.
  EXPECT_DOUBLE_EQ(largest_slope(state_machine(0.0, law), 0.0, 3, {}).stiffness, 200.0);
}

TEST(Tangent, IsThatOfTheStateOfTheStartWhereItActs) {
  engine::StateMachine touch = contact(100.0);
  touch.states[0].viscosity = 0.5;
  touch.states.push_back(touch.states[0]);
  touch.states[1].stiffness = 1e6;
  const engine::LawPoint pressed{0.09, 0.09 - 0.1};
  const engine::LawPoint stretched{0.11, 0.11 - 0.1};
  const plan::Tangent acts = plan::tangent_at_start(touch, pressed);
  EXPECT_TRUE(acts.acts);
  EXPECT_DOUBLE_EQ(acts.stiffness, 100.0);
  EXPECT_DOUBLE_EQ(acts.viscosity, 0.5);
  EXPECT_NEAR(acts.tension, -1.0, 1e-12);
  for (const engine::LawPoint& let_go : {stretched, engine::LawPoint{0.1, 0.0}}) {
    const plan::Tangent none = plan::tangent_at_start(touch, let_go);
    EXPECT_FALSE(none.acts);
    EXPECT_EQ(none.stiffness, 0.0);
    EXPECT_EQ(none.viscosity, 0.0);
    EXPECT_EQ(none.tension, 0.0);
  }
  touch.states[0].force_limit = 0.3;  // it pushes with that, and has no slope
  EXPECT_FALSE(plan::tangent_at_start(touch, pressed).acts);
  EXPECT_DOUBLE_EQ(plan::tangent_at_start(touch, pressed).tension, -0.3);
  // 57.1 in units of depth / diameter^2 at the distance of rest, 2^(1/6) diameters.
  const engine::StateMachine ball = state_machine(0.0, lennard_jones(1.0, 1.0));
  const double rest = std::pow(2.0, 1.0 / 6.0);
  EXPECT_NEAR(plan::tangent_at_start(ball, {rest, rest - 1.0}).stiffness, 57.146, 0.01);
  EXPECT_NEAR(plan::tangent_at_start(ball, {rest, rest - 1.0}).tension, 0.0, 1e-9);
}

/// A corner of a box flips the normal at 0. Deeper than 20 mm the table pulls.
TEST(Slope, KnowsTheLeastDampingOfWhatLetsGo) {
  const auto damping_of = [](const StateMachine& machine) {
    return plan::largest_slope(machine, 0.1, 2, Reach{}).touch_damping;
  };
  StateMachine touch = contact(100.0);
  EXPECT_EQ(damping_of(touch), 0.0);
  touch.states[0].viscosity = 0.5;
  EXPECT_DOUBLE_EQ(damping_of(touch), 0.5 / 100.0);
  touch.states.push_back(touch.states[0]);
  touch.states[1].viscosity = 0.2;
  EXPECT_DOUBLE_EQ(damping_of(touch), 0.2 / 100.0);
  touch.states[1].pulls = true;  // it holds, and never lets go
  EXPECT_DOUBLE_EQ(damping_of(touch), 0.5 / 100.0);
  EXPECT_TRUE(std::isinf(damping_of(state_machine(100.0))));
  StateMachine hertz = contact(0.0);
  hertz.states[0].elasticity = engine::Power{1e4, 1.5};
  EXPECT_TRUE(std::isinf(damping_of(hertz)));
  hertz.states[0].elasticity = engine::Power{1e4, 1.2};
  EXPECT_EQ(damping_of(hertz), 0.0);
}

TEST(Slope, OfASurfaceIsNotCertainWhereItPullsDeepWithin) {
  const plan::Reach reach{.elongation = 0.1, .speed = 1.0, .mass_a = {0.01, 0.01}};
  const auto is_certain = [&](double from, double tension) {
    const engine::Table table{{from - 0.001, from, 0.0},
                              {tension, -1e4, -1e4}};  // of the elongation
    const plan::Slope slope =
        plan::largest_slope_at_surfaces(state_machine(0.0, table), 0.03, 0.0, reach);
    return slope.uncertainty == nullptr;
  };
  EXPECT_TRUE(is_certain(-0.05, -1.0));
  EXPECT_FALSE(is_certain(-0.05, 1.0)) << "20 mm within";
  EXPECT_FALSE(is_certain(-0.035, 1.0)) << "5 mm within";
}

/// A spring in 1 dimension whose stiffness is 100 times a term of a variable, the time or the place of its end.
plan::LiaisonGraph graph_of_changing(const Term& factor, engine::VariableKind asked) {
  NetworkDescription scene = oscillator(0.1, 0.0, 0.0, 0.1, 0.0, 1e-4);
  scene.links.clear();
  scene.variables.emplace_back();
  scene.variables[0].quantity = asked;
  scene.variables[0].index = 1;
  scene.variables[0].direction = Vec3::UnitX();
  scene.state_machines = {
      state_machine(0.0, expression_law(Term(100.0) * factor * q(Quantity::kElongation)))};
  scene.state_links = {{0, 1, 0, 0.0}};
  return plan::liaison_graph(scene);
}

TEST(Slope, OfAParameterThatChangesIsThatOfItsWorstValue) {
  Term asked(0.0);
  asked.program.code = {{engine::Operation::kVariable, {}, 0.0, 0}};
  const auto of_time = [](const Term& factor) {
    return graph_of_changing(factor, engine::VariableKind::kTime);
  };
  const auto wave = of_time(Term(1.0) + Term(0.5) * one(Operation::kSin, asked));
  EXPECT_FALSE(wave.uncertainty.has_value());
  EXPECT_NEAR(wave.edges[0].stiffness, 150.0, 1e-9);
  const auto fading = of_time(one(Operation::kExp, one(Operation::kNegate, asked)));
  EXPECT_FALSE(fading.uncertainty.has_value());
  EXPECT_NEAR(fading.edges[0].stiffness, 100.0, 1e-9);

  EXPECT_TRUE(of_time(Term(1.0) + asked).uncertainty.has_value()) << "stiffer without an end";
  EXPECT_TRUE(of_time(one(Operation::kSin, asked)).uncertainty.has_value()) << "drives apart";

  const Term clamped = two(Operation::kMax, Term(0.0), two(Operation::kMin, asked, Term(1.0)));
  const auto at_most_1 = graph_of_changing(clamped, engine::VariableKind::kPosition);
  EXPECT_FALSE(at_most_1.uncertainty.has_value());
  EXPECT_NEAR(at_most_1.edges[0].stiffness, 100.0, 1e-9);
  const auto of_place = graph_of_changing(Term(1.0) + asked, engine::VariableKind::kPosition);
  EXPECT_TRUE(of_place.uncertainty.has_value());
}

TEST(Slope, NamesTheVariablesAloneThatNothingBounds) {
  const auto asked = [](std::uint32_t slot) {
    Term term(0.0);
    term.program.code = {{engine::Operation::kVariable, {}, 0.0, slot}};
    return term;
  };
  NetworkDescription scene;
  scene.dimension = 2;
  scene.step = 1e-4;
  scene.mats = {fixed(Vec3::Zero()), mass(0.1, Vec3(0.1, 0.0, 0.0))};
  scene.variables.resize(3);
  scene.variables[0].quantity = engine::VariableKind::kAwake;  // within 0 and 1
  for (const std::size_t place : {1u, 2u}) {
    scene.variables[place].quantity = engine::VariableKind::kPosition;
    scene.variables[place].index = 1;
    scene.variables[place].direction = Vec3::UnitX();
  }
  scene.state_links = {{0, 1, 0, 0.0}};
  const auto named = [&](const Term& factor) {
    scene.state_machines = {state_machine(0.0, expression_law(factor * q(Quantity::kElongation)))};
    const std::optional<plan::Uncertainty> uncertainty = plan::liaison_graph(scene).uncertainty;
    return uncertainty ? uncertainty->variables : std::vector<std::uint32_t>{};
  };
  using Slots = std::vector<std::uint32_t>;
  EXPECT_EQ(named(Term(1.0) + asked(0)), Slots{});
  EXPECT_EQ(named(asked(0) + asked(1)), Slots{1});
  EXPECT_EQ(named(asked(2) + asked(0) * one(Operation::kSin, asked(1))), Slots{2});
  EXPECT_EQ(named(one(Operation::kSin, asked(2)) * asked(0)), (Slots{2, 0}))
      << "each alone is harmless, and it may drive apart";
}

}  // namespace
}  // namespace cordis::test
