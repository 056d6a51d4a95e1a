// tests/plan/drive_test.cpp -- what the plan makes of matter that follows a function of time.
#include <cmath>

#include <gtest/gtest.h>

#include "sim_node/plan/reference/reference.h"
#include "sim_node/plan/stability/drive_extremes.h"
#include "sim_node/plan/stability/liaison_graph.h"
#include "sim_node/plan/stability/step_bound.h"
#include "tests/engine/programs.h"
#include "tests/engine/scenes.h"

namespace cordis::test {
namespace {

/// A row of masses between two ends.
NetworkDescription row_between(bool driven, engine::IntegratorKind integrator) {
  NetworkDescription scene;
  scene.dimension = 2;
  scene.step = 1e-4;
  scene.integrator = integrator;
  for (std::uint32_t i = 0; i < 8; ++i) {
    const Vec3 place(0.1 * i, 0.0, 0.0);
    scene.mats.push_back(i == 0 || i == 7 ? fixed(place) : mass(0.05 + 0.01 * i, place));
  }
  for (std::uint32_t i = 0; i < 7; ++i)
    scene.links.push_back({i, i + 1, 300.0 + 50.0 * i, 0.4, 0.1});
  if (!driven) return scene;
  engine::TimeFunction function;
  function.formula[1] = (Term(0.01) * one(Operation::kSin, Term(20.0) * q(Quantity::kAge))).program;
  scene.time_functions.push_back(function);
  engine::Drive drive;
  drive.origin = scene.mats[0].position;
  scene.drives = {drive};
  scene.mats[0].kind = MatKind::kPort;
  return scene;
}

TEST(DrivenPlan, BoundsTheStepAsThatOfAFixedPoint) {
  for (const auto integrator : {engine::IntegratorKind::kCordis, engine::IntegratorKind::kLeapfrog,
                                engine::IntegratorKind::kImplicit}) {
    const NetworkDescription still = row_between(false, integrator);
    const NetworkDescription driven = row_between(true, integrator);
    const double of_still = plan::certified_bound(still, plan::liaison_graph(still)).step;
    const double of_driven = plan::certified_bound(driven, plan::liaison_graph(driven)).step;
    EXPECT_EQ(of_driven, of_still) << to_string(integrator);
    EXPECT_GT(of_driven, 0.0);
  }
}

TEST(DrivenPlan, StaysBoundedJustBelowTheCertifiedStep) {
  NetworkDescription scene = row_between(true, engine::IntegratorKind::kCordis);
  scene.step = 0.98 * plan::certified_bound(scene, plan::liaison_graph(scene)).step;
  EXPECT_LT(largest_excursion(scene, 20'000), 1.0);
  scene.step *= 3.0;
  EXPECT_GT(largest_excursion(scene, 20'000), 1e6);
}

TEST(DrivenPlan, KnowsHowFastAFunctionIs) {
  NetworkDescription scene = row_between(true, engine::IntegratorKind::kCordis);
  EXPECT_NEAR(plan::largest_drive_speed(scene), 0.2, 1e-3);
  scene.drives.clear();
  EXPECT_EQ(plan::largest_drive_speed(scene), 0.0);
}

/// A blow of 10 ms, whenever it comes, and an oscillation at any frequency.
TEST(DrivenPlan, KnowsShortAndPeriodicFunctions) {
  NetworkDescription scene = row_between(true, engine::IntegratorKind::kCordis);
  for (const double begin : {0.105, 3.3333, 12.0, 1000.0}) {
    engine::TimeFunction blow;
    blow.time = {0.0, begin, begin + 0.01};
    blow.value = {Vec3(0.0, 0.0, 0.0), Vec3(0.0, 0.0, 0.0), Vec3(0.0, 0.5, 0.0)};
    for (const bool smooth : {false, true}) {
      blow.smooth = smooth;
      scene.time_functions = {blow};
      EXPECT_GE(plan::largest_drive_speed(scene), smooth ? 74.0 : 49.999) << begin;
    }
  }
  for (const double frequency : {50.0, 53.0, 100.0, 200.0, 1000.0}) {
    const double w = 2.0 * std::acos(-1.0) * frequency;
    engine::TimeFunction shake;
    shake.formula[1] = (Term(0.05) * one(Operation::kSin, Term(w) * q(Quantity::kAge))).program;
    scene.time_functions = {shake};
    EXPECT_GT(plan::largest_drive_speed(scene), 0.95 * 0.05 * w) << frequency;
  }
}

/// A jump is as fast as a step makes it, and a quick slide as fast as it is, whenever they come.
TEST(DrivenPlan, KnowsJumpsAndQuickSlides) {
  NetworkDescription scene = row_between(true, engine::IntegratorKind::kCordis);
  for (const double step : {5e-5, 1e-3}) {
    scene.step = step;
    for (const double moment : {0.30001, 7.77, 42.0}) {
      const Term since = q(Quantity::kAge) + Term(-moment);
      engine::TimeFunction jump;
      jump.formula[0] = (Term(0.05) * one(Operation::kSign, since)).program;
      scene.time_functions = {jump};
      EXPECT_NEAR(plan::largest_drive_speed(scene), 0.1 / step, 1e-3 / step) << moment;
      // 0.1 m in three steps and in seven
      for (const double steps : {3.0, 7.0}) {
        engine::TimeFunction slide;
        slide.formula[0] =
            (Term(0.05) * two(Operation::kMax, Term(-1.0),
                              two(Operation::kMin, Term(1.0), Term(2.0 / (steps * step)) * since)))
                .program;
        scene.time_functions = {slide};
        EXPECT_NEAR(plan::largest_drive_speed(scene), 0.1 / (steps * step), 1e-3 / step) << moment;
      }
    }
  }
}

TEST(DrivenPlan, AddsTheForcesOfAllMasses) {
  NetworkDescription scene = row_between(true, engine::IntegratorKind::kCordis);
  engine::TimeFunction push;
  push.formula[0] = (Term(20.0) * one(Operation::kSin, Term(3.0) * q(Quantity::kAge))).program;
  scene.time_functions = {push};
  scene.drives.clear();
  for (const std::uint32_t mat : {1U, 2U, 3U}) {
    engine::Drive drive;
    drive.mat = mat;
    drive.is_force = true;
    scene.drives.push_back(drive);
  }
  EXPECT_NEAR(plan::sum_of_drive_forces(scene), 60.0, 0.01);
}

TEST(DrivenPlan, IsComparedWithTheSchemeForWantOfAReferenceIntegrator) {
  plan::ReferenceOptions options;
  options.sampling = plan::even_sampling(0.05, 10);
  options.finest_hz = 2000.0;
  const plan::Reference reference =
      plan::make_reference(row_between(true, engine::IntegratorKind::kCordis), {}, options);
  EXPECT_FALSE(reference.by_reference);
  EXPECT_NE(
      reference.made_by.find("MATs that follow a function of time have no reference integrator"),
      std::string::npos)
      << reference.made_by;
}

}  // namespace
}  // namespace cordis::test
