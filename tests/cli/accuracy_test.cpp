// tests/cli/accuracy_test.cpp -- what the plan promises for `accuracy`, held against the reference
// integrator.
#include <cmath>

#include <gtest/gtest.h>

#include "cli/lab/lab_scene.h"
#include "sim_node/plan/rate_selection.h"
#include "sim_node/plan/reference/reference.h"
#include "sim_node/plan/reference/trial_run.h"

namespace cordis::cli {
namespace {

/// A lab scene beside the reference integrator.
class Accuracy : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    ASSERT_TRUE(scene_.accuracy);
    ASSERT_TRUE(reference_.by_reference);
    ASSERT_EQ(reference_.compared, reference_.sampling.count());
    ASSERT_LT(reference_.uncertainty, 0.02 * scene_.accuracy->tolerance);
  }

  /// The error of a run; more than any tolerance when it blows up.
  double error(const std::string& integrator, double rate_hz) const {
    const plan::TrialResult run =
        plan::try_out(scene_.network, integrator, rate_hz, lab_.trajectory, reference_);
    return run.blown_up ? 1e9 : run.error;
  }

  const LabScene lab_ = load_lab_scene(
      std::string(CORDIS_SOURCE_DIR) + "/launch_configs/lab/" + GetParam() + ".yaml", 0.0);
  const scene::Scene& scene_ = lab_.scene;

 private:
  plan::Reference make_reference() const {
    const double period = 1.0 / scene_.gesture_rate_hz;
    return plan::make_reference(
        scene_.network, lab_.trajectory,
        {plan::even_sampling(period, static_cast<int>(std::lround(lab_.duration_s / period))),
         1e-10,
         60.0,
         0.0,
         {}});
  }

  const plan::Reference reference_ = make_reference();
};

TEST_P(Accuracy, IsKeptByThePlanAndByNothingAtHalfTheCost) {
  const double tolerance = scene_.accuracy->tolerance;

  const std::string chosen = to_string(scene_.network.integrator);
  EXPECT_LE(error(chosen, scene_.step_rate_hz), tolerance) << scene_.step_rate_hz << " Hz";
  const double cost = scene_.step_rate_hz * plan::cost_of_a_step(chosen);
  for (const std::string& integrator : plan::integrators_for(scene_.network)) {
    const double half = 0.499 * cost / plan::cost_of_a_step(integrator);
    const double rate = std::floor(half / scene_.gesture_rate_hz) * scene_.gesture_rate_hz;
    if (rate > 0.0) {
      EXPECT_GT(error(integrator, rate), tolerance) << integrator << " at " << rate << " Hz";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(LabScenes, Accuracy,
                         testing::Values("soft", "stiff", "agglomerate", "bowed", "chain",
                                         "cluster"),
                         [](const auto& name) { return name.param; });

using AccuracyOfWhatConserves = Accuracy;

TEST_P(AccuracyOfWhatConserves, IsAHundredTimesThatOfTheSecondOrderAtTheCostOfSymplectic4) {
  ASSERT_EQ(to_string(scene_.network.integrator), std::string("symplectic4"));
  const double fourth_order = error("symplectic4", scene_.step_rate_hz);
  for (const char* integrator : {"cordis", "leapfrog"}) {
    const double rate = scene_.step_rate_hz * plan::cost_of_a_step("symplectic4") /
                        plan::cost_of_a_step(integrator);
    EXPECT_GT(error(integrator, rate), 100.0 * fourth_order) << integrator << " at " << rate;
  }
}

INSTANTIATE_TEST_SUITE_P(LabScenes, AccuracyOfWhatConserves, testing::Values("chain", "cluster"),
                         [](const auto& name) { return name.param; });

}  // namespace
}  // namespace cordis::cli
