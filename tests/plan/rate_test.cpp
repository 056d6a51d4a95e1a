// tests/plan/rate_test.cpp -- the rate that an accuracy asks for.
#include "sim_node/plan/rate.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>
#include <unsupported/Eigen/MatrixFunctions>

#include "sim_node/plan/rate_selection.h"
#include "sim_node/plan/rate_trial.h"
#include "sim_node/plan/reference/reference.h"
#include "sim_node/plan/reference/trial_run.h"
#include "sim_node/plan/stability/oscillator_error.h"
#include "tests/plan/networks.h"

namespace cordis::test {
namespace {

using plan::AccuracyTarget;
using plan::FormulaRate;
using plan::rate_by_formula;
using plan::RateReason;

TEST(FormulaRate, OneStepPerGestureWhereNothingAsksForMore) {
  const FormulaRate choice = rate_by_formula(oscillator(1.0, 10.0, 0.0, 1.0, 0.0, 1.0),
                                             AccuracyTarget{0.01, 0.5, 0.1}, 1000.0);

  EXPECT_EQ(choice.reason, RateReason::kGesture);
  EXPECT_STREQ(to_string(choice.reason), "the gesture rate, the lowest there is");
  EXPECT_DOUBLE_EQ(choice.rate_hz, 1000.0);
}

TEST(FormulaRate, IsOneCentAtAPhaseOf118Thousandths) {
  const AccuracyTarget target{5.778e-4, 100.0, 0.1};  // one cent
  const FormulaRate choice =
      rate_by_formula(oscillator(1.0, 10.0, 0.0, 1.0, 0.0, 1.0), target, 1000.0);

  EXPECT_EQ(choice.reason, RateReason::kPitch);
  EXPECT_NEAR(choice.needed_hz, 2.0 * M_PI * 100.0 / 0.118, 20.0);
  EXPECT_DOUBLE_EQ(choice.rate_hz, 6000.0);
}

TEST(FormulaRate, ViscosityAsksForMoreThanPitch) {
  // the rate of decay is off by Z'/2
  const FormulaRate choice = rate_by_formula(oscillator(1.0, 4e5, 40.0, 1.0, 0.0, 1.0),
                                             AccuracyTarget{0.001, 100.0, 0.1}, 1000.0);

  EXPECT_EQ(choice.reason, RateReason::kDecay);
  // Z / K = 1e-4 s, so at most (200 pi)^2 1e-4 = 39.5 / s at 100 Hz
  EXPECT_NEAR(choice.needed_hz, 39.48 / (2.0 * 0.001), 50.0);
}

TEST(FormulaRate, ContactsKeepTheirEnergy) {
  NetworkDescription scene = oscillator(0.1, 0.0, 0.0, 1.0, 0.0, 1e-3);
  scene.links.clear();
  scene.state_machines.push_back(contact(1e5));
  scene.state_links = {{0, 1, 0, 0.0}};

  const FormulaRate choice = rate_by_formula(scene, AccuracyTarget{0.1, 1.0, 0.01}, 1000.0);

  EXPECT_EQ(choice.reason, RateReason::kContact);
  // K' = 4 * 0.01 / 1.01 at 1e6 dt^2
  EXPECT_NEAR(choice.needed_hz, 1e3 / std::sqrt(0.04 / 1.01), 1.0);
}

TEST(FormulaRate, WhereNothingSwingsTheCreepAsksForMore) {
  // `implicit` makes e^(-s dt) to 1 / (1 + s dt)
  const double w = 2.0 * M_PI * 20.0;
  const double rate = 0.05 * w * w;  // Z / 2 m
  const double slow = w * w / (rate + std::sqrt(rate * rate - w * w));
  NetworkDescription scene = oscillator(0.1, 0.1 * w * w, 0.1 * 2.0 * rate, 1.0, 0.0, 1.0);
  scene.integrator = engine::IntegratorKind::kImplicit;
  const FormulaRate choice = rate_by_formula(scene, AccuracyTarget{0.01, 20.0, 0.1}, 10.0);

  EXPECT_EQ(choice.reason, RateReason::kCreep);
  EXPECT_STREQ(to_string(choice.reason), "the creep at the end of the band");
  // Lower vibrations creep faster: the fastest is damped by 1.25 times the critical, with its other mode 4 times as fast.
  const double phase = slow / choice.needed_hz;
  EXPECT_LT(1.0 - std::log1p(phase) / phase, 0.01);
  const double fastest = 0.5 * 2.5 / (2.0 * rate / (w * w));  // Z / w^2 stays
  const double error = plan::oscillator_error(2.0 * fastest, 5.0 * fastest, 1.0 / choice.needed_hz,
                                              engine::IntegratorKind::kImplicit)
                           .creep;
  EXPECT_NEAR(std::abs(error), 0.01, 1e-6);
}

TEST(FormulaRate, IsThatOfWhatSwingsThoughADamperElsewhereLetsNothingSwing) {
  // A bob of 200 Hz beside a door whose closer has Z / m = 25,000 1/s.
  NetworkDescription bob = oscillator(0.5, 789'500.0, 0.1, 1.0, 0.0, 1.0);
  NetworkDescription both = bob;
  both.mats.push_back(bob.mats[1]);
  both.mats.back().mass = 0.002;
  both.links.push_back({0, 2, 100.0, 50.0, 0.0});
  for (const auto integrator :
       {engine::IntegratorKind::kLeapfrog, engine::IntegratorKind::kCordis}) {
    bob.integrator = both.integrator = integrator;
    const AccuracyTarget target{0.01, 200.0, 0.1};
    const FormulaRate alone = rate_by_formula(bob, target, 1000.0);
    const FormulaRate beside = rate_by_formula(both, target, 1000.0);
    EXPECT_GE(beside.needed_hz, alone.needed_hz * (1.0 - 1e-9)) << engine::to_string(integrator);
  }
}

TEST(FormulaRate, StaysBelowTheLimit) {
  const FormulaRate choice = rate_by_formula(oscillator(0.1, 1e6, 0.0, 1.0, 0.0, 1e-3),
                                             AccuracyTarget{0.1, 1.0, 0.5}, 1000.0);

  EXPECT_EQ(choice.reason, RateReason::kStability);
  EXPECT_NEAR(choice.needed_hz, 0.5 * std::sqrt(1e7) / 0.9, 1.0);
  EXPECT_DOUBLE_EQ(choice.rate_hz, 2000.0);
}

TEST(FormulaRate, KeepsTheToleranceWhenItRuns) {
  // A chain whose lowest vibration is the whole band: its pitch, by its zero crossings.
  const double w = 2.0 * M_PI * 20.0;
  const AccuracyTarget target{0.002, 20.0, 0.1};
  NetworkDescription scene = oscillator(1.0, w * w, 0.2, 1.0, 0.0, 1.0);
  const FormulaRate choice = rate_by_formula(scene, target, 100.0);
  const auto errors = plan::oscillator_error(w, 0.2, 1.0 / choice.rate_hz);

  EXPECT_LE(std::abs(errors.pitch), target.tolerance);
  EXPECT_LE(std::abs(errors.decay), target.tolerance);
  const auto slower = plan::oscillator_error(w, 0.2, 1.0 / (choice.rate_hz - 100.0));
  EXPECT_GT(std::max(std::abs(slower.pitch), std::abs(slower.decay)), target.tolerance);
}

TEST(FormulaRate, PositionsOverATimeAskForThePhase) {
  // phase w t e <= sqrt(3) tolerance with e = (w dt)^2 / 24, w = 200 pi, t = 2 s
  AccuracyTarget target{0.01, 100.0, 0.1};
  target.over_s = 2.0;
  const FormulaRate choice =
      rate_by_formula(oscillator(1.0, 10.0, 0.0, 1.0, 0.0, 1.0), target, 1000.0);

  const double w = 200.0 * M_PI;
  EXPECT_EQ(choice.reason, RateReason::kPitch);
  EXPECT_NEAR(choice.needed_hz, w / std::sqrt(24.0 * std::sqrt(3.0) * 0.01 / (w * 2.0)), 10.0);
}

TEST(RateTrial, FindsTheRateByTrying) {
  // The position is off by w t (w dt)^2 / 24 / sqrt(3): at w = 100 and over 1 s by 0.01 at 1552 Hz.
  const plan::RateTrial trial = plan::find_rate(oscillator(0.1, 1000.0, 0.0, 1.0, 0.0, 1e-3),
                                                "cordis", {0.01, 1.0, 100.0, 100.0});
  EXPECT_EQ(trial.refusal, "");
  EXPECT_GE(trial.rate_hz, 1552.0);
  EXPECT_LE(trial.rate_hz, 2000.0);
  EXPECT_LE(trial.error, 0.01);
}

TEST(RateTrial, SaysWhyItFindsNone) {
  const NetworkDescription still = oscillator(0.1, 1000.0, 0.0, 0.0, 0.0, 1e-3);
  EXPECT_EQ(plan::find_rate(still, "cordis", {0.01, 1.0, 100.0, 100.0}).refusal,
            "nothing moves within that time");
  const NetworkDescription long_run = oscillator(0.1, 1000.0, 0.0, 1.0, 0.0, 1e-3);
  EXPECT_EQ(plan::find_rate(long_run, "cordis", {1e-6, 1e5, 100.0, 100.0}).refusal,
            "it takes too long to try it out");
  // Twelve masses knock about in a box of springs without friction: chaos within seconds.
  NetworkDescription wild = free_cluster(12, 40, 0.0, 2);
  EXPECT_NE(plan::find_rate(wild, "cordis", {1e-4, 8.0, 50.0, 50.0}).refusal.find("chaotic"),
            std::string::npos);
}

TEST(Reference, EndsWhereAChaoticMotionHasPartedAndThenKnowsTheEnergyAlone) {
  const NetworkDescription wild = free_cluster(12, 40, 0.0, 2);
  const plan::InputTrajectory nothing;
  const plan::Reference reference =
      plan::make_reference(wild, nothing, {plan::even_sampling(0.01, 200), 1e-9, 60.0, 0.0, {}});
  EXPECT_TRUE(reference.by_reference);
  EXPECT_TRUE(reference.diverged);
  EXPECT_GT(reference.compared, 10);
  EXPECT_LT(reference.compared, 150);

  const plan::TrialResult run = plan::try_out(wild, "cordis", 2000.0, nothing, reference);
  EXPECT_FALSE(run.blown_up);
  EXPECT_NE(run.energy_error, 0.0);
  EXPECT_LT(std::abs(run.energy_error), 0.2);
}

TEST(RateSelection, TriesOutWhatMovesByItselfAndNotWhatIsPlayed) {
  const NetworkDescription scene = oscillator(0.1, 1000.0, 0.0, 1.0, 0.0, 1e-3);
  AccuracyTarget target{0.01, 5.0, 0.1};
  target.over_s = 1.0;
  const plan::RateSelection free = plan::select_rate(scene, target, 100.0, {"cordis"}, false);
  EXPECT_GE(free.rate_hz, 1552.0);
  EXPECT_EQ(free.uncertainty, "");
  const plan::RateSelection played = plan::select_rate(scene, target, 100.0, {"cordis"}, true);
  EXPECT_EQ(played.rate_hz, rate_by_formula(scene, target, 100.0).rate_hz);
  EXPECT_NE(played.uncertainty, "");
}

TEST(RateSelection, TriesNothingOutWhoseStabilityIsNotCertain) {
  // a ring that pulls: a mass that orbits it may come as near as it likes
  NetworkDescription scene = oscillator(0.01, 0.0, 0.0, 0.06, 0.0, 1e-3);
  scene.dimension = 2;
  scene.links.clear();
  scene.mats[1].velocity = Vec3(0, 0.1, 0);
  scene.state_machines = {state_machine(0.0, engine::Rings{{{-8.0, 0.12}}})};
  scene.state_links = {{0, 1, 0, 0.0}};
  AccuracyTarget target{0.01, 5.0, 0.1};
  target.over_s = 1.0;
  const plan::RateSelection selection = plan::select_rate(scene, target, 100.0, {"cordis"}, false);

  EXPECT_EQ(selection.rate_hz, rate_by_formula(scene, target, 100.0).rate_hz);
  EXPECT_LT(selection.error, 0.0);
  EXPECT_NE(selection.uncertainty.find("not certain that the scene is stable"), std::string::npos)
      << selection.uncertainty;
}

TEST(RateSelection, TakesARateThatIsCertainOfABend) {
  NetworkDescription scene = oscillator(1.0, 0.0, 0.0, 0.034, 0.0, 1e-3);
  scene.links.clear();
  scene.state_machines = {state_machine(791734.0)};
  scene.state_machines[0].states[0].force_limit = 7917.0;
  scene.state_links = {{0, 1, 0, 0.0}};
  const plan::RateSelection selection =
      plan::select_rate(scene, {0.05, 20.0}, 1000.0, {"cordis", "leapfrog"}, false);
  EXPECT_EQ(selection.rate_hz, 3000.0);
  scene.step = 1.0 / selection.rate_hz;
  EXPECT_TRUE(plan::plan_of(scene, 20.0).stability.holds());
}

/// A network that creeps, and where its last mass is after 0.5 s.
struct Creep {
  NetworkDescription scene;
  double exact;  // [m]
  double start;  // [m]
};

/// A mass on a spring, beside it a spring and a damper in a row, with a light mass between: of these the
/// matrix exponential.
Creep three_mats() {
  NetworkDescription scene = oscillator(0.5, 80.0, 0.0, 0.05, 0.0, 1e-3);
  scene.mats = {fixed(Vec3::Zero()), mass(1e-4, Vec3(0.05, 0, 0)), mass(0.5, Vec3(0.05, 0, 0))};
  scene.links = {{0, 2, 80.0, 0.0, 0.0}, {0, 1, 240.0, 0.0, 0.0}, {1, 2, 0.0, 6.0, 0.0}};
  Eigen::Matrix4d system;                         // of node and mass, then of their velocities
  system << 0, 0, 1, 0,                           //
      0, 0, 0, 1,                                 //
      -240.0 / 1e-4, 0, -6.0 / 1e-4, 6.0 / 1e-4,  //
      0, -80.0 / 0.5, 6.0 / 0.5, -6.0 / 0.5;
  const Eigen::Matrix4d propagator = (0.5 * system).exp();
  return {scene, (propagator * Eigen::Vector4d(0.05, 0.05, 0, 0))[1], 0.05};
}

/// A ball of 1 mg that falls in honey: it has its speed m g / Z after m / Z = 50 us.
Creep honey() {
  NetworkDescription scene = oscillator(1e-6, 0.0, 0.0, 0.0, 0.0, 1e-3);
  scene.links.clear();
  scene.gravity = Vec3(-10, 0, 0);
  scene.medium_viscosity = 0.02;
  const double time = 1e-6 / 0.02;
  return {scene, -10.0 * time * (0.5 - time), 0.0};
}

/// A door of 2 g: x = x0 (b e^(-a t) - a e^(-b t)) / (b - a) with the two rates a and b.
Creep door() {
  const NetworkDescription scene = oscillator(0.002, 100.0, 50.0, 0.1, 0.0, 1e-3);
  const double half = 0.5 * 50.0 / 0.002;
  const double square = 100.0 / 0.002;
  const double fast = half + std::sqrt(half * half - square);
  const double slow = square / fast;
  const double left = (fast * std::exp(-slow * 0.5) - slow * std::exp(-fast * 0.5)) / (fast - slow);
  return {scene, 0.1 * left, 0.1};
}

TEST(RateSelection, KeepsTheToleranceOfWhatCreepsWithEveryIntegrator) {
  for (const Creep& creep : {three_mats(), honey(), door()}) {
    const std::vector<std::string> names = plan::integrators_for(creep.scene);
    std::vector<std::vector<std::string>> choices{names};  // of all, and each by itself
    for (const std::string& name : names) choices.push_back({name});
    for (const std::vector<std::string>& open : choices) {
      const plan::RateSelection selection =
          plan::select_rate(creep.scene, AccuracyTarget{0.01, 20.0, 0.1}, 1000.0, open, false);
      NetworkDescription scene = creep.scene;
      scene.integrator = engine::integrator_named(selection.integrator);
      scene.step = 1.0 / selection.rate_hz;
      World world = make_world(scene);
      const auto last = static_cast<std::uint32_t>(scene.mats.size() - 1);
      for (long n = std::lround(0.5 * selection.rate_hz); n > 0; --n) world.step();
      // `implicit` also damps what swings as it creeps: that is an error of the start, not of what is left.
      const bool damps = selection.integrator == "implicit";
      const double whole = std::max(std::abs(creep.exact), damps ? creep.start : 0.0);
      EXPECT_NEAR(world.position(last).x(), creep.exact, 0.01 * whole)
          << selection.integrator << " at " << selection.rate_hz << " Hz of " << open.size();
    }
  }
}

TEST(RateSelection, TakesAFactorisationOnlyWhereItSavesFiftySteps) {
  const auto chosen = [](double stiffness) {
    const AccuracyTarget target{0.1, 1.0, 0.5};  // stability alone decides
    return plan::select_rate(oscillator(0.1, stiffness, 0.0, 1.0, 0.0, 1e-3), target, 1000.0,
                             {"cordis", "implicit"}, false);
  };
  EXPECT_EQ(chosen(1e7).integrator, "cordis");  // 5,600 Hz, and 1,000 Hz
  EXPECT_EQ(chosen(1e10).integrator, "implicit");
  EXPECT_EQ(chosen(1e10).rate_hz, 1000.0);
}

TEST(RateSelection, DoesNotThinkOfModesThatTakeLongToFind) {
  const auto thinks_of_modes = [](std::size_t masses) {
    NetworkDescription scene = oscillator(0.1, 1000.0, 0.0, 1.0, 0.0, 1e-3);
    scene.mats.resize(masses + 1, scene.mats[1]);
    const std::vector<std::string> names = plan::integrators_for(scene);
    return std::find(names.begin(), names.end(), "modal") != names.end();
  };
  EXPECT_TRUE(thinks_of_modes(400));
  EXPECT_FALSE(thinks_of_modes(401));
}

}  // namespace
}  // namespace cordis::test
