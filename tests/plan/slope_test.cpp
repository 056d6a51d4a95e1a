// tests/plan/slope_test.cpp
#include "sim_node/plan/stability/slope.h"

#include <cmath>

#include <gtest/gtest.h>

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

TEST(Slope, OfATableIsThatOfItsSteepestPiece) {
  const engine::Table law{{-0.01, 0.0, 0.02, 0.03}, {-8.0, 0.0, 1.0, 1.0}};

  const Slope slope = largest_slope(state_machine(5.0, law), 0.1, 3, {});

  EXPECT_DOUBLE_EQ(slope.stiffness, 805.0);
  EXPECT_TRUE(slope.bounded);
}

TEST(Slope, OfAPullThatLastsIsAlsoAcrossTheLink) {
  // 10 N at 2 cm: across the link that is 500 N/m, while the pull itself does not grow.
  engine::Table law{{-0.08, 0.0, 1.0}, {0.0, 1.0, 1.0}};
  EXPECT_NEAR(largest_slope(state_machine(0.0, law), 0.1, 1, {}).stiffness, 12.5, 1e-12);
  law = {{-0.0801, -0.08, 1.0}, {9.99, 10.0, 10.0}};
  EXPECT_NEAR(largest_slope(state_machine(0.0, law), 0.1, 3, {}).stiffness, 10.0 / 0.02, 5.0);
  EXPECT_LE(largest_slope(state_machine(0.0, law), 0.1, 1, {}).stiffness, 101.0);
}

TEST(Slope, OfAPowerIsThatAtTheReach) {
  const engine::Power law{1e5, 1.5};

  const Slope slope = largest_slope(state_machine(0.0, law), 0.01, 1, Reach{0.01, 1.0, 0.0});

  EXPECT_NEAR(slope.stiffness, 1e5 * 1.5 * 0.1, 1e-9);
  EXPECT_FALSE(slope.bounded);
}

TEST(Slope, OfRingsIsThatOfTheirSteepestSum) {
  // Pushing within 1 cm, pulling between 1 and 2 cm.
  const engine::Rings law{{{300.0, 0.01}, {-100.0, 0.02}}};

  EXPECT_DOUBLE_EQ(largest_slope(state_machine(0.0, law), 0.0, 1, {}).stiffness, 200.0);
  // At 1 cm it pulls with 1 N: 100 N/m across, still less.
  EXPECT_DOUBLE_EQ(largest_slope(state_machine(0.0, law), 0.0, 3, {}).stiffness, 200.0);
}

TEST(Tangent, IsThatOfTheStiffestStateAtTheDistance) {
  engine::StateMachine touch = contact(100.0);
  touch.states.push_back(touch.states[0]);
  touch.states[1].stiffness = 20.0;
  touch.states[1].viscosity = 0.5;
  EXPECT_DOUBLE_EQ(plan::stiffest_tangent(touch, 0.1, 0.09).stiffness, 100.0);
  EXPECT_DOUBLE_EQ(plan::stiffest_tangent(touch, 0.1, 0.09).viscosity, 0.5);
  EXPECT_NEAR(plan::stiffest_tangent(state_machine(100.0), 0.1, 0.09).pull, -1.0, 1e-12);
  // 57.1 in units of depth / diameter^2 at the distance of rest, 2^(1/6) diameters.
  const engine::StateMachine ball = state_machine(0.0, lennard_jones(1.0, 1.0));
  const double rest = std::pow(2.0, 1.0 / 6.0);
  EXPECT_NEAR(plan::stiffest_tangent(ball, 1.0, rest).stiffness, 57.146, 0.01);
  EXPECT_NEAR(plan::stiffest_tangent(ball, 1.0, rest).pull, 0.0, 1e-9);
}

}  // namespace
}  // namespace cordis::test
