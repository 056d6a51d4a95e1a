// tests/plan/oscillator_error_test.cpp
#include "sim_node/plan/stability/oscillator_error.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/plan/networks.h"

namespace cordis::test {
namespace {

using plan::oscillator_error;

TEST(OscillatorError, HasTheLeadingTermsOfTheScheme) {
  // pitch Z'/4 + (w dt)^2 / 24, decay Z'/2; the next terms are smaller by Z' and (w dt)^2
  EXPECT_NEAR(oscillator_error(100.0, 0.0, 1e-3).pitch, 0.01 / 24.0, 2e-6);
  EXPECT_NEAR(oscillator_error(100.0, 2.0, 1e-4).pitch, 2e-4 / 4.0 + 1e-4 / 24.0, 1e-6);
  EXPECT_NEAR(oscillator_error(100.0, 2.0, 1e-3).decay, 1e-3, 2e-6);
  EXPECT_DOUBLE_EQ(oscillator_error(100.0, 0.0, 1e-3).decay, 0.0);
}

TEST(OscillatorError, IsOneCentAtAPhaseOf118Thousandths) {
  EXPECT_NEAR(plan::cents(oscillator_error(118.0, 0.0, 1e-3).pitch), 1.0, 0.01);
}

TEST(OscillatorError, IsWhatTheEngineDoes) {
  // 2 s of 5 Hz at 100 steps a second: the n-th zero crossing gives the period, interpolated.
  const double w = 10.0 * M_PI;
  const double viscosity = 0.8;
  World world = make_world(oscillator(1.0, w * w, viscosity, 1.0, 0.0, 0.01));
  double first = -1.0;
  double last = -1.0;
  int crossings = 0;
  double before = world.position(1).x();
  for (int n = 1; n <= 800; ++n) {
    world.step();
    const double now = world.position(1).x();
    if (before > 0.0 && now <= 0.0) {
      last = 0.01 * (n - 1 + before / (before - now));
      if (first < 0.0) first = last;
      ++crossings;
    }
    before = now;
  }
  const double true_frequency = std::sqrt(w * w - 0.25 * viscosity * viscosity);
  const double reached = 2.0 * M_PI * (crossings - 1) / (last - first);

  const plan::OscillatorError error = oscillator_error(w, viscosity, 0.01);

  EXPECT_TRUE(error.oscillates);
  // The crossing between two samples is interpolated: 1e-3 of a period, over 39 of them.
  EXPECT_NEAR(reached / true_frequency - 1.0, error.pitch, 1e-4);
}

class CreepError : public testing::TestWithParam<engine::IntegratorKind> {};

TEST_P(CreepError, IsWhatTheEngineDoes) {
  // 10 1/s and viscosities of Z' up to 100 at 1 ms
  for (const double viscosity : {30.0, 200.0, 900.0, 1e4, 1e5}) {
    const bool explicit_limit = GetParam() == engine::IntegratorKind::kCordis;
    if (explicit_limit && viscosity > 1900.0) continue;
    NetworkDescription scene = oscillator(1.0, 100.0, viscosity, 1.0, 0.0, 1e-3);
    scene.integrator = GetParam();
    World world = make_world(scene);
    const double slow = 0.5 * viscosity - std::sqrt(0.25 * viscosity * viscosity - 100.0);
    // some steps until the faster mode is gone, then as many as lose a good part
    run(world, 1500);
    const double before = world.position(1).x();
    const int steps = viscosity > 1e3 ? 50000 : 1000;
    run(world, steps);
    const double rate = std::log(before / world.position(1).x()) / (1e-3 * steps);

    const plan::OscillatorError error = oscillator_error(10.0, viscosity, 1e-3, GetParam());

    ASSERT_TRUE(error.creeps) << viscosity;
    EXPECT_FALSE(error.oscillates);
    EXPECT_NEAR(rate / slow - 1.0, error.creep, 1e-6 + 2e-3 * std::abs(error.creep)) << viscosity;
  }
}

INSTANTIATE_TEST_SUITE_P(Integrators, CreepError,
                         testing::Values(engine::IntegratorKind::kCordis,
                                         engine::IntegratorKind::kLeapfrog,
                                         engine::IntegratorKind::kImplicit));

TEST(OscillatorError, DistinguishesWhatSwingsFromWhatCreepsAndDiverges) {
  EXPECT_FALSE(oscillator_error(10.0, 30.0, 1e-3).oscillates);  // over-damped
  EXPECT_TRUE(oscillator_error(10.0, 30.0, 1e-3).creeps);
  EXPECT_FALSE(oscillator_error(10.0, 3000.0, 1e-3).creeps);  // beyond the limit of `cordis`
  EXPECT_FALSE(oscillator_error(100.0, 2.0, 1e-3).creeps);
  EXPECT_FALSE(oscillator_error(2500.0, 0.0, 1e-3).oscillates);  // beyond the limit
}

}  // namespace
}  // namespace cordis::test
