// tests/plan/convergence_test.cpp -- how fast each method comes near the truth, problem by problem
// of tests/reference. Prints a table:  plan_test --gtest_filter=Convergence.*
#include <cmath>
#include <cstdio>
#include <map>

#include <gtest/gtest.h>

#include "sim_node/engine/integrators/integrator_limits.h"
#include "sim_node/plan/reference/reference_integrator.h"
#include "sim_node/plan/reference/trial_run.h"
#include "tests/plan/reference_problems.h"
#include "tests/support/reference_data.h"

namespace cordis::test::convergence {
namespace {

/// The order that a method is to show at least; none where it is not known, or shows none.
std::map<std::string, std::map<MotionKind, double>> min_orders() {
  // Where a change falls between two steps errors are uneven: that they fall is all there is.
  constexpr double kFalls = 0.0;
  constexpr double kCoarse = 0.75;  // `implicit`, at steps at which it damps most of the motion
  using enum MotionKind;
  return {{"cordis", {{kConservative, 2.0}, {kDamped, 1.0}, {kSwitching, kFalls}}},
          {"leapfrog", {{kConservative, 2.0}, {kDamped, 2.0}, {kSwitching, kFalls}}},
          {"symplectic4", {{kConservative, 4.0}, {kDamped, 4.0}, {kSwitching, kFalls}}},
          {"implicit", {{kConservative, kCoarse}, {kDamped, kCoarse}, {kSwitching, kFalls}}}};
}

bool damps_implicitly(NetworkDescription network, const std::string& method, double rate) {
  if (method != "leapfrog") return false;
  network.integrator = engine::IntegratorKind::kLeapfrog;
  network.step = 1.0 / rate;
  return engine::damps_implicitly(network);
}

/// From an error to that at four times the rate.
double order_of(double error, double finer) {
  return 0.5 * std::log2(error / finer);
}

TEST(Convergence, OfEveryMethodOnEveryProblem) {
  const std::map<std::string, std::map<MotionKind, double>> least = min_orders();
  const std::vector<std::string> methods = plan::integrator_names();
  std::printf("%-28s %9s", "order, error at", "rate_hz");
  for (const std::string& method : methods) std::printf(" %20s", method.c_str());
  std::printf("\n");
  for (const ReferenceProblem& problem : reference_problems()) {
    constexpr int kSamples = 25;
    constexpr double kFloor = 3e-10;  // below it the reference itself is uncertain
    const double steps = 4.0 * std::ceil(0.25 * problem.rate_hz * problem.duration / kSamples);
    const plan::Sampling sampling = plan::even_sampling(problem.duration / kSamples, kSamples);
    const double rate = steps * kSamples / problem.duration;
    const plan::InputTrajectory nothing;
    const plan::Reference reference =
        plan::make_reference(problem.network, nothing, {sampling, 1e-11, 60.0, 0.0, {}});
    ASSERT_TRUE(reference.by_reference) << problem.name;
    ASSERT_EQ(reference.compared, kSamples) << problem.name;

    std::printf("%-28s %9.4g", problem.name.c_str(), rate);
    for (const std::string& method : methods) {
      if (!plan::refusal_of(problem.network, method).empty()) {
        std::printf(" %20s", "-");
        continue;
      }
      const auto error_at = [&](double rate_hz) {
        const plan::TrialResult run =
            plan::try_out(problem.network, method, rate_hz, nothing, reference);
        EXPECT_FALSE(run.blown_up) << problem.name << " with " << method;
        return run.error;
      };
      // A method of high order is at the floor of the reference at four times the rate.
      const bool high = method == "symplectic4";
      const double error = error_at(rate);
      const double other = error_at(high ? 0.25 * rate : 4.0 * rate);
      const double order = high ? order_of(other, error) : order_of(error, other);
      std::printf("      %5.2f  %8.2e", order, error);
      const auto known = least.find(method);
      if (known == least.end() || error < kFloor) continue;
      // Between two treatments of dampers there is no order.
      if (damps_implicitly(problem.network, method, rate) !=
          damps_implicitly(problem.network, method, 4.0 * rate)) {
        EXPECT_LT(error, 1e-4) << problem.name << " with " << method;
        continue;
      }
      EXPECT_GT(order, known->second.at(problem.kind) - 0.15) << problem.name << " with " << method;
    }
    std::printf("\n");
  }
}

TEST(Convergence, GoesToWhatTheReferencesSay) {
  for (const ReferenceProblem& problem : reference_problems()) {
    plan::ReferenceIntegrator reference_integrator(problem.network, 1e-12);
    for (const auto& [time, mat, x] : problem.expected) {
      reference_integrator.advance_to(time);
      EXPECT_NEAR(reference_integrator.position(static_cast<std::uint32_t>(mat)).x(), x,
                  problem.within)
          << problem.name << " at " << time;
    }
  }
}

TEST(Convergence, OfABounceGoesToItsRestitution) {
  plan::ReferenceIntegrator wall(bounce().network, 1e-12);
  wall.advance_to(6.0);
  EXPECT_NEAR(wall.velocity(1).x(), number(reference("R12_bounce_restitution")["rows"][3][3]),
              1e-9);
  plan::ReferenceIntegrator balls(collision().network, 1e-12);
  balls.advance_to(0.05);
  const nlohmann::json params = reference("R19_collisions")["case"];
  EXPECT_NEAR(balls.velocity(0).x(), number(params["v1p"]), 1e-9);
  EXPECT_NEAR(balls.velocity(1).x(), number(params["v2p"]), 1e-9);
}

}  // namespace
}  // namespace cordis::test::convergence
