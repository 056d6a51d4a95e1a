// tests/engine/recurrence_test.cpp -- the scheme against the closed form of its own recurrence.
#include <cmath>

#include <gtest/gtest.h>

#include "tests/engine/scenes.h"
#include "tests/support/reference_data.h"

namespace cordis::test {
namespace {

// The start x(-1) of the reference is reached by the speed v0 whose second-order start gives it:
// x(-1) = x0 - v0 dt + a0 dt^2 / 2 with a0 dt^2 = -K' x0 - Z' v0 dt, here with dt = 1 and m = 1.
double starting_speed(double stiffness, double viscosity, double x0, double x_before) {
  return (x0 - x_before - 0.5 * stiffness * x0) / (1.0 + 0.5 * viscosity);
}

class Recurrence : public testing::TestWithParam<VectorWidth> {};

TEST_P(Recurrence, IsFollowedToRoundingInOneDimension) {
  const nlohmann::json problem = reference("R02_cordis_discrete_exact");
  for (const auto& entry : problem["cases"]) {
    const double stiffness = number(entry["Kp"]);
    const double viscosity = number(entry["Zp"]);
    const double x0 = number(entry["x0"]);
    const double v0 = starting_speed(stiffness, viscosity, x0, number(entry["xm1"]));
    World world = make_world(oscillator(1.0, stiffness, viscosity, x0, v0, 1.0), GetParam());

    for (const auto& row : entry["n_x"]) {
      const int n = row[0].get<int>();
      run(world, n - static_cast<int>(world.step_count()));
      // rounding: half an ulp a step, carried on undamped
      EXPECT_NEAR(world.position(1).x(), number(row[1]), 2e-15 * (n + 10))
          << "K' = " << stiffness << ", Z' = " << viscosity << ", step " << n;
    }
  }
}

TEST_P(Recurrence, IsFollowedToRoundingAlongADirectionInSpace) {
  const Vec3 direction(1.0 / 3.0, 2.0 / 3.0, -2.0 / 3.0);
  const double rest = 8.0;  // longer than any swing, so that the link never turns round
  const nlohmann::json problem = reference("R02_cordis_discrete_exact");
  for (const auto& entry : problem["cases"]) {
    const double stiffness = number(entry["Kp"]);
    const double viscosity = number(entry["Zp"]);
    const double x0 = number(entry["x0"]);
    const double v0 = starting_speed(stiffness, viscosity, x0, number(entry["xm1"]));
    NetworkDescription scene;
    scene.step = 1.0;
    scene.mats = {fixed(Vec3::Zero()), mass(1.0, (rest + x0) * direction, v0 * direction)};
    scene.links = {{0, 1, stiffness, viscosity, rest}};
    World world = make_world(scene, GetParam());

    for (const auto& row : entry["n_x"]) {
      const int n = row[0].get<int>();
      run(world, n - static_cast<int>(world.step_count()));
      const double elongation = world.position(1).dot(direction) - rest;
      // rounding as above, of positions eight times as large
      EXPECT_NEAR(elongation, number(row[1]), 2e-14 * (n + 10))
          << "K' = " << stiffness << ", Z' = " << viscosity << ", step " << n;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Widths, Recurrence, testing::ValuesIn(engine::supported_vector_widths()),
                         [](const auto& width) { return engine::to_string(width.param); });

}  // namespace
}  // namespace cordis::test
